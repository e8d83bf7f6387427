/* Recordings and streams made by code: a tile of posts taken down a ladder, four rungs an octave, as a build does. */
#ifndef SCREE_TESTS_STREAM_MAKER_H
#define SCREE_TESTS_STREAM_MAKER_H

#include "lod/recorder.h"
#include "lod/tile.h"
#include "stream/encode.h"
#include <scree/stream.h>

struct stream_wish {
    /* Heights of post (0, 0), rows from the south; posts -1 .. columns + 1, -1 .. rows + 1 exist. NULL: a fractal in
     * whole metres. */
    const float *heights_m;
    int32_t stride;        /* floats from row to row */
    uint64_t seed;         /* of the fractal */
    int32_t columns, rows; /* lattice steps, at most 1024 each way */
    double spacing_m;      /* 0: 30 */
    int32_t height_exponent;
    enum scree_profile profile; /* what the header says; geodetic ones lie near 45 degrees north */
    double finest_m;            /* tolerance of the finest rung */
    uint32_t rungs;             /* the base included; 0: down to `base_vertices` */
    uint32_t base_vertices;
};

/* What the encoder wants, and the finest mesh to compare with. */
struct made_recording {
    struct scree_memory *memory;
    struct tile tile;
    struct recorder recorder; /* recorder.recording */
    struct scree_mesh finest;
    struct scree_stream_header place; /* all but the rungs */
};

/* `wish->heights_m` is given. `made` is to be released in any case, and must not move until then. */
enum scree_status stream_make_recording(struct scree_memory *memory, const struct stream_wish *wish,
                                        struct made_recording *made, struct scree_error *error);
void stream_release_recording(struct made_recording *made);

/* The stream of it, to be released with scree_release; `options` are the encoder's and may be NULL. */
enum scree_status stream_make(struct scree_memory *memory, const struct stream_wish *wish,
                              const struct encode_options *options, unsigned char **bytes, size_t *size_bytes,
                              struct scree_error *error);

#endif
