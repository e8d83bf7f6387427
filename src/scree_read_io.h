/* scree.json, parsed into what the commands need. Nothing in it is believed: numbers are in range, ranges lie on the
 * lattice, the ladder has at least a rung and does not grow, and what it says of the lattice makes one. */
#ifndef SCREE_SCREE_READ_IO_H
#define SCREE_SCREE_READ_IO_H

#include "src/lattice.h"
#include "src/manifest_read_io.h"
#include "src/scree_json.h"
#include "stream/memory.h"
#include <scree/error.h>

#define MANIFEST_MAX_RUNGS 1024 /* of the ladder over all zooms */

struct scree_zoom_info {
    bool is_told;
    uint64_t tiles, bytes;
    struct stream_scale coarsest, finest; /* zeros where it has no tiles */
};

struct scree_info {
    struct lattice lattice;
    int min_zoom, max_zoom;
    double bounds[4];                    /* of the data; in the geodetic profile the east may be beyond 180 degrees */
    char *crs_wkt, *datum, *attribution; /* "" when not told */
    double nodata_height_m;
    int32_t height_exponent;
    int finest_octaves;
    bool is_lossless;
    uint32_t rungs_per_increment;
    int32_t first_rung;
    uint32_t rung_count;
    double *tolerance_m; /* of the rungs from first_rung on */
    struct manifest_ranges available;
    struct scree_zoom_info zooms[MAX_ZOOM + 1];
};

/* Reads `path`. SCREE_E_CORRUPT when it is not such a file, SCREE_E_UNSUPPORTED for another format, scheme or a newer
 * version; the line names the file and the first defect. On failure *info holds nothing. */
enum scree_status scree_read(struct scree_memory *memory, const char *path, struct scree_info *info,
                             struct scree_error *error);

/* Safe on a zeroed one and twice. */
void scree_info_free(struct scree_memory *memory, struct scree_info *info);

#endif
