/* What all methods of the literature have in common: see the header. */
#include "lod/method.h"

#include <math.h>
#include <stdbool.h>

#define LARGEST_SPAN (1 << 30) /* lattice steps a side */

void method_mesh_release(struct scree_memory *memory, struct method_mesh *mesh) {
    scree_release(memory, mesh->corners);
    scree_release(memory, mesh->vertices);
    *mesh = (struct method_mesh){0};
}

/* ---- what comes in ---- */

static bool ends_agree(const struct border_line *one, bool one_last, const struct border_line *other, bool other_last) {
    float a = one->vertices[one_last ? one->vertex_count - 1 : 0].height_m;
    float b = other->vertices[other_last ? other->vertex_count - 1 : 0].height_m;
    return a == b;
}

static enum scree_status check_line(const struct border_line *line, int32_t length, struct scree_error *error) {
    if (line == NULL || line->vertex_count < 2 || line->vertex_count > BORDER_MAX_VERTICES)
        return scree_fail(error, SCREE_E_ARGUMENT, "a tile's border line has no vertices");
    if (line->vertices[0].position != 0 || line->vertices[line->vertex_count - 1].position != length)
        return scree_fail(error, SCREE_E_ARGUMENT, "a tile's border line does not lead from corner to corner");
    for (int32_t v = 0; v < line->vertex_count; v++) {
        if (!isfinite(line->vertices[v].height_m))
            return scree_fail(error, SCREE_E_ARGUMENT, "a height on a tile's border line is not finite");
        if (v > 0 && line->vertices[v].position <= line->vertices[v - 1].position)
            return scree_fail(error, SCREE_E_ARGUMENT, "positions on a tile's border line do not grow");
    }
    return SCREE_OK;
}

enum scree_status method_tile_check(const struct method_tile *tile, struct scree_error *error) {
    if (tile->columns < 1 || tile->rows < 1 || tile->cell_span < 1 || tile->stride < tile->columns + 1 ||
        (int64_t)tile->columns * tile->cell_span > LARGEST_SPAN || (int64_t)tile->rows * tile->cell_span > LARGEST_SPAN)
        return scree_fail(error, SCREE_E_ARGUMENT, "a tile of %d x %d cells of %d steps with a stride of %d",
                          (int)tile->columns, (int)tile->rows, (int)tile->cell_span, (int)tile->stride);
    for (int32_t row = 0; row <= tile->rows; row++)
        for (int32_t column = 0; column <= tile->columns; column++)
            if (!isfinite(method_post_m(tile, column, row)))
                return scree_fail(error, SCREE_E_ARGUMENT, "the height of post %d, %d is not finite", (int)column,
                                  (int)row);
    for (int side = 0; side < SIDE_COUNT; side++) {
        bool horizontal = side == SIDE_SOUTH || side == SIDE_NORTH;
        enum scree_status status =
            check_line(tile->lines[side], horizontal ? method_width(tile) : method_height(tile), error);
        if (status != SCREE_OK) return status;
    }
    const struct border_line *south = tile->lines[SIDE_SOUTH], *east = tile->lines[SIDE_EAST];
    const struct border_line *north = tile->lines[SIDE_NORTH], *west = tile->lines[SIDE_WEST];
    if (!ends_agree(south, false, west, false) || !ends_agree(south, true, east, false) ||
        !ends_agree(north, true, east, true) || !ends_agree(north, false, west, true))
        return scree_fail(error, SCREE_E_ARGUMENT, "border lines disagree about the height of a tile's corner");
    return SCREE_OK;
}

enum scree_status method_ring_new(struct scree_memory *memory, const struct method_tile *tile,
                                  struct method_vertex **ring, uint32_t *count, uint32_t corners[4],
                                  struct scree_error *error) {
    uint32_t room = 0, at = 0;
    for (int side = 0; side < SIDE_COUNT; side++) room += (uint32_t)tile->lines[side]->vertex_count - 1;
    struct method_vertex *vertices = scree_allocate(memory, room, sizeof *vertices, "a tile's border", error);
    if (vertices == NULL) return SCREE_E_MEMORY;
    for (int side = 0; side < SIDE_COUNT; side++) { /* south, east, north, west: the way round, each without its end */
        const struct border_line *line = tile->lines[side];
        bool back = side == SIDE_NORTH || side == SIDE_WEST;
        if (corners != NULL) corners[side] = at;
        for (int32_t i = 0; i < line->vertex_count - 1; i++) {
            const struct border_sample *vertex = &line->vertices[back ? line->vertex_count - 1 - i : i];
            double along = vertex->position, x = along, y = along;
            if (side == SIDE_SOUTH) y = 0;
            if (side == SIDE_NORTH) y = method_height(tile);
            if (side == SIDE_EAST) x = method_width(tile);
            if (side == SIDE_WEST) x = 0;
            vertices[at++] = (struct method_vertex){x, y, (double)vertex->height_m};
        }
    }
    *ring = vertices;
    *count = room;
    return SCREE_OK;
}
