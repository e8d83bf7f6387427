#include "viewer/drape_io.h"

#include <algorithm>
#include <cmath>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <memory>

namespace {

constexpr int MOST_PIXELS = 4096;

struct DatasetCloser {
    void operator()(GDALDataset *dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

bool has_place(GDALDataset &image) {
    double transform[6];
    bool has_crs = image.GetSpatialRef() != nullptr;
    return (has_crs && image.GetGeoTransform(transform) == CE_None) || image.GetGCPCount() > 0;
}

// As many pixels as the image has there, within limits.
void size_of(const GDALDataset &image, const Manifest &manifest, int *width, int *height) {
    GDALDataset &source = const_cast<GDALDataset &>(image);
    double x = manifest.bounds[2] - manifest.bounds[0], y = manifest.bounds[3] - manifest.bounds[1];
    if (manifest.terrain.profile == SCREE_GEODETIC)
        x *= std::cos((manifest.bounds[1] + manifest.bounds[3]) / 2 * 0.017453292519943295);
    double longest = std::min(MOST_PIXELS, std::max(source.GetRasterXSize(), source.GetRasterYSize()));
    *width = std::max(1, (int)std::lround(x >= y ? longest : longest * x / y));
    *height = std::max(1, (int)std::lround(y >= x ? longest : longest * y / x));
}

Dataset warp(GDALDataset &image, const Manifest &manifest) {
    int width, height;
    size_of(image, manifest, &width, &height);
    std::string crs = manifest.terrain.profile == SCREE_GEODETIC ? "EPSG:4326" : manifest.crs_wkt;
    CPLStringList arguments;
    for (const char *word : {"-of", "MEM", "-dstalpha", "-r", "bilinear", "-t_srs", crs.c_str(), "-te"})
        arguments.AddString(word);
    for (double bound : manifest.bounds) arguments.AddString(CPLSPrintf("%.17g", bound));
    arguments.AddString("-ts");
    arguments.AddString(CPLSPrintf("%d", width));
    arguments.AddString(CPLSPrintf("%d", height));
    GDALWarpAppOptions *options = GDALWarpAppOptionsNew(arguments.List(), nullptr);
    GDALDatasetH source = GDALDataset::ToHandle(&image);
    Dataset warped(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &source, options, nullptr)));
    GDALWarpAppOptionsFree(options);
    return warped;
}

// Palettes become colours first; one or two bands are grey.
Dataset colours_of(Dataset image) {
    if (image->GetRasterBand(1)->GetColorTable() == nullptr) return image;
    CPLStringList arguments;
    for (const char *word : {"-of", "MEM", "-expand", "rgba"}) arguments.AddString(word);
    GDALTranslateOptions *options = GDALTranslateOptionsNew(arguments.List(), nullptr);
    Dataset expanded(GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(image.get()), options, nullptr)));
    GDALTranslateOptionsFree(options);
    return expanded;
}

bool copy_pixels(GDALDataset &warped, osg::Image *image) {
    int bands = warped.GetRasterCount(), colours = bands - 1, width = image->s(), height = image->t();
    int from[4] = {1, colours >= 3 ? 2 : 1, colours >= 3 ? 3 : 1, bands};
    for (int channel = 0; channel < 4; channel++) {
        unsigned char *top = image->data(0, (unsigned)height - 1) + channel; // rows upwards
        if (warped.GetRasterBand(from[channel])
                ->RasterIO(GF_Read, 0, 0, width, height, top, width, height, GDT_Byte, 4, -4 * (GSpacing)width,
                           nullptr) != CE_None)
            return false;
    }
    return true;
}

} // namespace

osg::ref_ptr<osg::Image> drape_image(const std::string &path, const Manifest &manifest, std::string *error) {
    GDALAllRegister();
    CPLPushErrorHandler(CPLQuietErrorHandler);
    Dataset source(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    osg::ref_ptr<osg::Image> image;
    bool is_local_unknown = manifest.terrain.profile == SCREE_LOCAL && manifest.crs_wkt.empty();
    if (source == nullptr || source->GetRasterCount() < 1)
        *error = path + ": is no image that GDAL reads";
    else if (!has_place(*source))
        *error = path + ": has no georeference (CRS and place); gdal_translate -a_srs -a_ullr gives it one";
    else if (is_local_unknown)
        *error = path + ": cannot be draped: the terrain's CRS is not known";
    else {
        Dataset coloured = colours_of(std::move(source));
        Dataset warped = coloured == nullptr ? nullptr : warp(*coloured, manifest);
        image = new osg::Image;
        if (warped != nullptr)
            image->allocateImage(warped->GetRasterXSize(), warped->GetRasterYSize(), 1, GL_RGBA, GL_UNSIGNED_BYTE);
        if (warped == nullptr || !copy_pixels(*warped, image)) {
            *error = path + ": cannot be warped onto the terrain: " + CPLGetLastErrorMsg();
            image = nullptr;
        }
    }
    CPLPopErrorHandler();
    return image;
}
