/* Does one decoded tile keep the promises that a tile can keep alone? Pure, and exact: the plane is judged in the
 * integer codes of the file. */
#ifndef SCREE_VERIFY_TILE_H
#define SCREE_VERIFY_TILE_H

#include "src/lattice.h"
#include "src/quantized_mesh_decode.h"
#include "src/verify_report.h"
#include "stream/memory.h"
#include <scree/error.h>

/* What the tile has to cover. */
struct tile_frame {
    struct tile_id id;
    enum profile profile;
    double bounds[4];    /* of the whole square: west, south, east, north */
    uint16_t right, top; /* codes of the window's eastern and northern border; the others are 0 */
    bool is_ours;        /* held to what this program's writer promises beyond the format */
};

/* The frame of a tile that lies at least partly on the lattice. */
struct tile_frame tile_frame_of(const struct lattice *lattice, struct tile_id id, bool is_ours);

/* Checks the tile and books the result; fails only for want of memory. */
enum scree_status verify_tile(struct scree_memory *memory, const struct decoded_tile *tile,
                              const struct tile_frame *frame, struct verify_report *report, struct scree_error *error);

#endif
