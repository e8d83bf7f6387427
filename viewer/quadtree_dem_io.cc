#include "viewer/quadtree_dem_io.h"

#include "stream/curvature.h"

#include <algorithm>
#include <cmath>
#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <memory>
#include <ogr_spatialref.h>

namespace {

constexpr double FILL_POSTS = 100, EQUATOR_M = 6378137, FOOT_M = 0.3048, HIGHEST_M = 20000;

struct DatasetCloser {
    void operator()(GDALDataset *dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetCloser>;

// In memory, as floats that the band's scale and offset have been applied to.
Dataset unpacked(GDALDataset &raster) {
    CPLStringList arguments;
    for (const char *word : {"-of", "MEM", "-ot", "Float32", "-unscale", "-b", "1"}) arguments.AddString(word);
    GDALTranslateOptions *options = GDALTranslateOptionsNew(arguments.List(), nullptr);
    Dataset copy(GDALDataset::FromHandle(GDALTranslate("", GDALDataset::ToHandle(&raster), options, nullptr)));
    GDALTranslateOptionsFree(options);
    return copy;
}

double metres_of_heights(GDALRasterBand &band) {
    const std::string unit = band.GetUnitType();
    const bool is_foot = unit.find("ft") != std::string::npos || unit.find("foot") != std::string::npos ||
                         unit.find("feet") != std::string::npos;
    return is_foot ? FOOT_M : 1;
}

bool lay_out(GDALDataset &raster, QuadtreeDem *dem) {
    double g[6];
    if (raster.GetGeoTransform(g) != CE_None || g[2] != 0 || g[4] != 0 || !(g[1] > 0) || g[5] == 0) return false;
    dem->columns = raster.GetRasterXSize();
    dem->rows = raster.GetRasterYSize();
    dem->spacing_x = g[1];
    dem->spacing_y = std::fabs(g[5]);
    dem->west = g[0] + g[1] / 2;
    dem->south = g[5] < 0 ? g[3] + (dem->rows - 0.5) * g[5] : g[3] + 0.5 * g[5];
    double metres_x = 1, metres_y = 1;
    const OGRSpatialReference *crs = raster.GetSpatialRef();
    if (crs != nullptr && crs->IsGeographic()) {
        const double middle_rad = (dem->south + dem->spacing_y * (dem->rows - 1) / 2) * crs->GetAngularUnits();
        metres_y = EQUATOR_M * crs->GetAngularUnits();
        metres_x = metres_y * std::max(std::cos(middle_rad), 1e-3);
    } else if (crs != nullptr) {
        metres_x = metres_y = crs->GetLinearUnits();
    }
    dem->metres_x = dem->spacing_x * metres_x;
    dem->metres_y = dem->spacing_y * metres_y;
    char *wkt = nullptr;
    if (crs != nullptr && crs->exportToWkt(&wkt) == OGRERR_NONE) dem->crs_wkt = wkt;
    CPLFree(wkt);
    return std::isfinite(dem->west) && std::isfinite(dem->south) && std::isfinite(dem->metres_x) &&
           std::isfinite(dem->metres_y);
}

// Heights from the south, in metres; what stays void, as low as the lowest.
bool read_heights(GDALDataset &raster, QuadtreeDem *dem) {
    GDALRasterBand &band = *raster.GetRasterBand(1);
    int has_nodata = FALSE;
    const double nodata = band.GetNoDataValue(&has_nodata), metres = metres_of_heights(band);
    double g[6];
    raster.GetGeoTransform(g);
    if (has_nodata)
        GDALFillNodata(GDALRasterBand::ToHandle(&band), nullptr, FILL_POSTS, 0, 0, nullptr, nullptr, nullptr);
    dem->heights_m.resize((size_t)dem->columns * (size_t)dem->rows);
    const GSpacing row_bytes = (GSpacing)dem->columns * (GSpacing)sizeof(float);
    float *northern = dem->heights_m.data() + (size_t)dem->columns * (size_t)(dem->rows - 1);
    const bool is_read =
        band.RasterIO(GF_Read, 0, 0, dem->columns, dem->rows, g[5] < 0 ? northern : dem->heights_m.data(), dem->columns,
                      dem->rows, GDT_Float32, 0, g[5] < 0 ? -row_bytes : row_bytes, nullptr) == CE_None;
    const auto is_void = [&](float height) {
        return !std::isfinite(height) || (has_nodata && height == (float)nodata);
    };
    dem->lowest_m = HIGHEST_M;
    dem->highest_m = -HIGHEST_M;
    for (float &height : dem->heights_m) {
        if (is_void(height)) {
            height = NAN;
            continue;
        }
        height = (float)(height * metres);
        dem->lowest_m = std::min<double>(dem->lowest_m, height);
        dem->highest_m = std::max<double>(dem->highest_m, height);
    }
    for (float &height : dem->heights_m)
        if (std::isnan(height)) height = (float)dem->lowest_m;
    return is_read;
}

} // namespace

bool quadtree_dem_read(const std::string &path, QuadtreeDem *dem, std::string *error) {
    GDALAllRegister();
    CPLPushErrorHandler(CPLQuietErrorHandler);
    *dem = QuadtreeDem();
    error->clear();
    Dataset raster(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (raster == nullptr || raster->GetRasterCount() < 1)
        *error = path + ": is no raster that GDAL reads";
    else if (!lay_out(*raster, dem))
        *error = path + ": has no georeference with rows from west to east; gdalwarp it first";
    else if (std::min(dem->columns, dem->rows) < 2 || std::max(dem->columns, dem->rows) > CURVATURE_MAX_POSTS)
        *error = path + ": a quadtree takes 2 to " + std::to_string(CURVATURE_MAX_POSTS) + " posts a side, not " +
                 std::to_string(dem->columns) + " x " + std::to_string(dem->rows) + "; gdal_translate -srcwin crops it";
    else if ((raster = unpacked(*raster)) == nullptr || !read_heights(*raster, dem))
        *error = path + ": cannot be read: " + CPLGetLastErrorMsg();
    else if (!(dem->lowest_m <= dem->highest_m) || dem->lowest_m < -HIGHEST_M || dem->highest_m > HIGHEST_M)
        *error = path + ": holds no heights on Earth; declare its nodata value with gdal_translate -a_nodata";
    CPLPopErrorHandler();
    return error->empty();
}
