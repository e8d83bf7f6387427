/* scree.json, the manifest of a set of streams: where and how large everything is, so that a client that has read it
 * can choose tiles and rungs without asking for any. Pure.
 *
 * A build fills a stream_manifest: one stream_tile_figures a tile while it writes them, added up with stream_zoom_add
 * in the order of the tiles, so that no thread's timing shows. */
#ifndef SCREE_SCREE_JSON_H
#define SCREE_SCREE_JSON_H

#include "src/lattice.h"
#include <scree/error.h>
#include <scree/stream.h>
#include <stdbool.h>

/* A tile's meshes at both ends, from its header; all that has to be kept of a tile. */
struct stream_tile_figures {
    struct scree_rung coarsest, finest;
    uint64_t bytes; /* of the file */
};

struct stream_tile_figures stream_tile_figures_of(const struct scree_stream_header *header, uint64_t file_bytes);

/* All tiles of a zoom at one end of their rungs. */
struct stream_scale {
    int32_t rung; /* the coarsest of the coarsest rungs; the finest of the finest */
    uint64_t vertices, triangles;
    double svo_min_m, svo_max_m;     /* smallest and largest of the tiles' */
    double error_min_m, error_max_m; /* of their max errors */
};

struct stream_zoom {
    uint32_t tile_count;
    const struct tile_id *tiles; /* sorted by y, then x; set by the caller */
    uint64_t bytes;
    struct stream_scale coarsest, finest; /* zeros without tiles */
};

/* Counts a tile in; `zoom` is zeroed before the first. */
void stream_zoom_add(struct stream_zoom *zoom, const struct stream_tile_figures *tile);

struct stream_manifest {
    const struct lattice *lattice;
    int min_zoom, max_zoom;
    double bounds[4];                          /* of the data: degrees or CRS units */
    const char *crs_wkt, *datum, *attribution; /* NULL: not known */
    double nodata_height_m;
    int32_t height_exponent;         /* heights are multiples of 2^height_exponent metres */
    int finest_octaves;              /* how far the finest zoom goes on below its static tile */
    bool is_lossless;                /* the finest rung of the finest zoom is the full grid */
    uint32_t rungs_per_increment;    /* at least 1 */
    int32_t first_rung;              /* the ladder: tolerances of the rungs from this one on, */
    uint32_t rung_count;             /* so many, */
    const double *tolerance_m;       /* not growing */
    const struct stream_zoom *zooms; /* indexed by zoom, 0 .. max_zoom */
};

/* The text in a new malloc'd string, the caller frees; NULL on SCREE_E_MEMORY. */
char *scree_json_new(const struct stream_manifest *manifest, struct scree_error *error);

#endif
