/* layer.json, explicit and complete: what clients need, and a "scree" member with what verify and info need. Pure.
 *
 * Its version ("1.0.0-" and eight hexadecimal digits) depends on the tiles' figures alone: the same build has the same
 * one, a build with other tiles another one, and caches do not mix them. */
#ifndef SCREE_LAYER_JSON_H
#define SCREE_LAYER_JSON_H

#include "src/lattice.h"
#include "src/terrain_tile.h"
#include <scree/error.h>

/* One zoom: its tiles as a sorted list of rows-of-x runs is worked out by the writer from `tiles`. */
struct layer_zoom {
    double tolerance_m;
    double height_step_m; /* of border vertices */
    double max_error_m;   /* largest of its tiles, as simplified */
    double svo_m;         /* of the zoom: monotone, coarser zooms have larger ones */
    uint64_t vertices, triangles, bytes;
    uint32_t tile_count;
    const struct tile_id *tiles; /* sorted by y, then x */
};

struct layer {
    const struct lattice *lattice;
    int min_zoom, max_zoom;
    double bounds[4]; /* of the data: degrees or CRS units */
    const char *crs_wkt, *datum, *attribution;
    bool has_normals, is_gzipped;
    double nodata_height_m;
    const char *method;             /* of the literature; NULL: Scree's own way */
    const struct layer_zoom *zooms; /* indexed by zoom, 0 .. max_zoom */
};

/* The text in a new malloc'd string, the caller frees; NULL on SCREE_E_MEMORY. */
char *layer_json_new(const struct layer *layer, struct scree_error *error);

#endif
