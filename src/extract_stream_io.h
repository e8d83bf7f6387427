/* The mesh of streams at a scale: of one tile, or of the whole set, every place once and all tiles joined.
 *
 * Memory grows with what comes out, and with the one tile that is being read: about 200 bytes a triangle, the writing
 * of the mesh file included. */
#ifndef SCREE_EXTRACT_STREAM_IO_H
#define SCREE_EXTRACT_STREAM_IO_H

#include "src/extract_mesh.h"
#include "src/stream_set_io.h"
#include "stream/memory.h"
#include <scree/error.h>

/* Which scale is wanted. */
struct scale_wish {
    enum { SCALE_FINEST, SCALE_RUNG, SCALE_SVO, SCALE_ERROR } kind;
    int32_t rung;   /* SCALE_RUNG: the coarsest that is at least as fine */
    double bound_m; /* SCALE_SVO, SCALE_ERROR: the coarsest at which no tile says more */
};

/* What came out; zero it first and free it in any case. */
struct stream_extract {
    struct lattice lattice;
    struct extract_mesh mesh;  /* in posts of the lattice */
    int zoom;                  /* of the finest tiles in it */
    int32_t rung;              /* the finest one in it */
    uint32_t tiles;            /* that are in it, as a whole or in part */
    double svo_m, max_error_m; /* the largest that its whole tiles say */
    uint32_t stitched;         /* edges where a coarser tile was made to meet a finer one */
    double middle[2];          /* of its rectangle: degrees or CRS units */
};

/* The index of the rung in a stream, or -1: no rung is that fine. */
int stream_rung_index(const struct scree_stream_header *header, const struct scale_wish *wish);

/* A whole set, or one tile of it (`only`; NULL: all). SCREE_E_ARGUMENT when nothing is that fine. */
enum scree_status extract_stream_set(struct scree_memory *memory, const struct stream_set *set,
                                     const struct scale_wish *wish, const struct tile_id *only,
                                     struct stream_extract *extract, struct scree_error *error);

/* A single file, wherever it is. */
enum scree_status extract_stream_file(struct scree_memory *memory, const char *path, const struct scale_wish *wish,
                                      struct stream_extract *extract, struct scree_error *error);

void stream_extract_free(struct scree_memory *memory, struct stream_extract *extract);

#endif
