/* city_dem: writes the city of tests/city_maker.h as a GeoTIFF, and its land use as GeoJSON with tags like those of
 * OpenStreetMap. `city_dem --help` lists the options. */
#include "tests/city_maker.h"

#include "lod/context_filter.h"

#include <gdal.h>
#include <ogr_srs_api.h>

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EPSG      25832
#define WEST      356000.0 /* of the south-western post */
#define SOUTH     5699000.0
#define SPACING_M 2.0

static const char help[] = "Usage: city_dem -o FILE.tif --landuse FILE.geojson [--seed N]\n"
                           "Writes a city's ground, 641 x 641 posts 2 m apart, and polygons of its land use.\n";

static bool write_raster(const char *path, uint64_t seed) {
    static float heights_m[CITY_POSTS];
    static uint8_t uses[CITY_POSTS];
    static const char *const options[] = {"COMPRESS=DEFLATE", "PREDICTOR=3", NULL};
    GDALDatasetH raster =
        GDALCreate(GDALGetDriverByName("GTiff"), path, CITY_SIDE, CITY_SIDE, 1, GDT_Float32, (CSLConstList)options);
    if (raster == NULL) return false;
    double transform[6] = {WEST - SPACING_M / 2, SPACING_M, 0, SOUTH + (CITY_SIDE - 0.5) * SPACING_M, 0, -SPACING_M};
    OGRSpatialReferenceH srs = OSRNewSpatialReference(NULL);
    bool fine = OSRImportFromEPSG(srs, EPSG) == OGRERR_NONE && GDALSetSpatialRef(raster, srs) == CE_None &&
                GDALSetGeoTransform(raster, transform) == CE_None;
    OSRDestroySpatialReference(srs);
    city_make(seed, heights_m, uses);
    /* Raster rows run from the north, the city's from the south. */
    float *northern = heights_m + (size_t)CITY_SIDE * (CITY_SIDE - 1);
    fine = fine && GDALRasterIO(GDALGetRasterBand(raster, 1), GF_Write, 0, 0, CITY_SIDE, CITY_SIDE, northern, CITY_SIDE,
                                CITY_SIDE, GDT_Float32, 0, -CITY_SIDE * (int)sizeof *heights_m) == CE_None;
    GDALFlushCache(raster);
    GDALClose(raster);
    return fine && CPLGetLastErrorType() < CE_Failure;
}

static const char *tag_of(uint8_t use) {
    switch (use) {
    case GROUND_WATER: return "\"natural\": \"water\"";
    case GROUND_RAILWAY: return "\"railway\": \"rail\"";
    case GROUND_BRIDGE: return "\"highway\": \"primary\", \"bridge\": \"yes\"";
    case GROUND_RAMP: return "\"highway\": \"primary\"";
    default: return "\"landuse\": \"forest\"";
    }
}

static bool write_landuse(const char *path) {
    static struct city_outline outline;
    FILE *file = fopen(path, "w");
    if (file == NULL) return false;
    fprintf(
        file,
        "{\"type\": \"FeatureCollection\", \"crs\": {\"type\": \"name\", \"properties\": {\"name\": \"EPSG:%d\"}},\n"
        "\"features\": [",
        EPSG);
    for (int i = 0; i < CITY_OUTLINES; i++) {
        city_outline(i, &outline);
        fprintf(file,
                "%s\n{\"type\": \"Feature\", \"properties\": {%s}, \"geometry\": {\"type\": \"Polygon\", "
                "\"coordinates\": [[",
                i > 0 ? "," : "", tag_of(outline.use));
        for (size_t k = 0; k <= outline.count; k++) {
            const double *corner = outline.corners[k % outline.count];
            fprintf(file, "%s[%.3f, %.3f]", k > 0 ? ", " : "", WEST + SPACING_M * corner[0],
                    SOUTH + SPACING_M * corner[1]);
        }
        fprintf(file, "]]}}");
    }
    fprintf(file, "\n]}\n");
    const bool fine = ferror(file) == 0;
    return fclose(file) == 0 && fine;
}

static int fail(const char *path) {
    fprintf(stderr, "city_dem: %s: cannot be written\n", path);
    return 1;
}

int main(int argc, char **argv) {
    const char *raster = NULL, *landuse = NULL;
    unsigned long long seed = 1;
    for (int i = 1; i < argc; i += 2) {
        const char *value = argv[i + 1]; /* NULL behind the last */
        char *end = NULL;
        bool fine = value != NULL;
        if (strcmp(argv[i], "--help") == 0) return fputs(help, stdout) < 0;
        if (fine && strcmp(argv[i], "-o") == 0)
            raster = value;
        else if (fine && strcmp(argv[i], "--landuse") == 0)
            landuse = value;
        else if (fine && strcmp(argv[i], "--seed") == 0)
            fine = value[0] >= '0' && value[0] <= '9' && (seed = strtoull(value, &end, 10), *end == '\0');
        else
            fine = false;
        if (!fine) {
            fprintf(stderr, "city_dem: %s: no such option or value; see --help\n", argv[i]);
            return 2;
        }
    }
    if (raster == NULL || landuse == NULL) {
        fputs("city_dem: -o FILE.tif and --landuse FILE.geojson are to be given; see --help\n", stderr);
        return 2;
    }
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    if (!write_raster(raster, seed)) return fail(raster);
    return write_landuse(landuse) ? 0 : fail(landuse);
}
