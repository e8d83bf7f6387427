/* layer.json of any producer, parsed into what the commands need. Nothing in it is believed: numbers are in range,
 * ranges lie on the lattice, and what the "scree" member says of the lattice makes one. */
#ifndef SCREE_LAYER_READ_IO_H
#define SCREE_LAYER_READ_IO_H

#include "src/lattice.h"
#include "src/manifest_read_io.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <stdbool.h>

struct layer_zoom_info { /* of the "scree" member; zeros where there is none */
    bool is_told;
    double tolerance_m, height_step_m, max_error_m, svo_m;
    uint64_t tiles, vertices, triangles, bytes;
};

struct layer_info {
    bool is_ours;           /* it has a "scree" member */
    struct lattice lattice; /* finest_zoom: the deepest zoom that is listed */
    int min_zoom, max_zoom; /* as clients read them */
    double bounds[4];
    bool has_normals, is_gzipped;
    double nodata_height_m;
    char *crs_wkt, *datum, *attribution; /* "" when not told */
    bool has_available;                  /* else: metadata in the tiles, or nothing */
    struct manifest_ranges available;
    struct layer_zoom_info zooms[MAX_ZOOM + 1];
    char complaint[240]; /* what clients would miss in it; "" when nothing */
};

/* Reads `path`. SCREE_E_CORRUPT when it is not such a file, SCREE_E_UNSUPPORTED for another format, scheme or
 * projection. On failure *layer holds nothing. */
enum scree_status layer_read(struct scree_memory *memory, const char *path, struct layer_info *layer,
                             struct scree_error *error);

/* Safe on a zeroed layer and twice. */
void layer_info_free(struct scree_memory *memory, struct layer_info *layer);

#endif
