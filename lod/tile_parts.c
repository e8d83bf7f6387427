#include "lod/tile_parts.h"

#include "lod/extremes.h"
#include "lod/tile_lines.h"

#include <math.h>
#include <string.h>

/* ---- heights ---- */

int32_t tile_height_units(const struct tile *tile, double height_m) {
    return (int32_t)lround(height_m / tile->geometry.height_unit_m);
}

void tile_place_vertices(struct tile *tile) {
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++)
        tile->mesh.vertices[v].at.height_m = (float)(tile->mesh.heights[v] * tile->geometry.height_unit_m);
}

enum scree_status tile_begin(struct scree_memory *memory, const struct tile_geometry *geometry, struct tile *tile,
                             struct scree_error *error) {
    memset(tile, 0, sizeof *tile);
    tile->memory = memory;
    tile->geometry = *geometry;
    if (geometry->east_drop_m == NULL) return SCREE_OK;
    size_t rows = (size_t)extremes_cells(geometry->rows, geometry->cell_span) + 1;
    tile->east_drop_m = scree_allocate(memory, rows, sizeof *tile->east_drop_m, "a tile's rows", error);
    if (tile->east_drop_m == NULL) return SCREE_E_MEMORY;
    memcpy(tile->east_drop_m, geometry->east_drop_m, rows * sizeof *tile->east_drop_m);
    return SCREE_OK;
}

struct samples tile_own_samples(const struct tile *tile) {
    const struct tile_geometry *geometry = &tile->geometry;
    return (struct samples){.columns = extremes_cells(geometry->columns, geometry->cell_span),
                            .rows = extremes_cells(geometry->rows, geometry->cell_span),
                            .cell_span = geometry->cell_span,
                            .east_drop_m = tile->east_drop_m,
                            .north_drop_m = geometry->north_drop_m};
}

/* ---- grids ---- */

/* The two triangles of cell (x, y), with its diagonal rising from the south-west or falling from the north-west:
 *
 *     c---d   rising: (a, b, d), (d, c, a); falling: (a, b, c), (d, c, b). Half-edge 0 of the first lies in the south,
 *     | / |   of the second in the north; the vertical ones are 1 in triangles with the diagonal at 2 (rising) and
 *     a---b   2 in those with the diagonal at 1 (falling). */
static void make_cell(struct mesh *mesh, int32_t columns, int32_t rows, int32_t x, int32_t y) {
    int32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
    int32_t first = 2 * (y * columns + x), second = first + 1;
    bool rising = ((x + y) & 1) == 0;
    struct mesh_triangle *low = &mesh->triangles[first], *high = &mesh->triangles[second];
    memcpy(low->vertex, (int32_t[3]){a, b, rising ? d : c}, sizeof low->vertex);
    memcpy(high->vertex, (int32_t[3]){d, c, rising ? a : b}, sizeof high->vertex);
    int diagonal = rising ? 2 : 1, upright = rising ? 1 : 2;
    low->twin[0] = y > 0 ? 4 * (second - 2 * columns) : MESH_NONE;
    high->twin[0] = y < rows - 1 ? 4 * (first + 2 * columns) : MESH_NONE;
    low->twin[diagonal] = 4 * second + diagonal;
    high->twin[diagonal] = 4 * first + diagonal;
    /* a rising cell has its low triangle in the east, a falling one in the west; neighbours are the other kind */
    int32_t east = rising ? first : second, west = rising ? second : first;
    mesh->triangles[east].twin[upright] = x < columns - 1 ? 4 * (east + 2) + 3 - upright : MESH_NONE;
    mesh->triangles[west].twin[upright] = x > 0 ? 4 * (west - 2) + 3 - upright : MESH_NONE;
}

/* Gives every vertex its outgoing edge; on the border the border edge, which has the last word. */
static void give_edges(struct mesh *mesh) {
    for (int pass = 0; pass < 2; pass++)
        for (int32_t t = 0; t < mesh->triangle_count; t++)
            for (int i = 0; i < 3; i++)
                if (pass == 0 || mesh->triangles[t].twin[i] == MESH_NONE)
                    mesh->vertices[mesh->triangles[t].vertex[i]].edge = 4 * t + i;
}

enum scree_status tile_make_grid(struct tile *tile, int32_t step, struct scree_error *error) {
    int32_t columns = tile->geometry.columns / step, rows = tile->geometry.rows / step;
    enum scree_status status =
        mesh_allocate(tile->memory, (columns + 1) * (rows + 1), 2 * columns * rows, &tile->mesh, error);
    if (status != SCREE_OK) return status;
    struct mesh *mesh = &tile->mesh;
    for (int32_t y = 0; y <= rows; y++)
        for (int32_t x = 0; x <= columns; x++)
            mesh->vertices[mesh->vertex_count++].at = (struct sample){x * step, y * step, 0};
    mesh->live_vertices = mesh->vertex_count;
    mesh->live_triangles = mesh->triangle_count = mesh->triangle_capacity;
    for (int32_t y = 0; y < rows; y++)
        for (int32_t x = 0; x < columns; x++) make_cell(mesh, columns, rows, x, y);
    give_edges(mesh);
    return SCREE_OK;
}

void tile_start_line(struct tile *tile, enum tile_side side, int32_t step, const float *heights_m, int32_t stride) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t length = side == SIDE_SOUTH || side == SIDE_NORTH ? geometry->columns : geometry->rows;
    tile_line_start(&tile->lines[side], length, step, geometry->side_drop_m[side], geometry->height_unit_m, heights_m,
                    stride);
}

/* ---- what comes next ---- */

enum scree_status tile_begin_rest(struct tile *tile, struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    struct coarse_tile *rest = scree_allocate(tile->memory, 1, sizeof *rest, "a tile's remains", error);
    if (rest == NULL) return SCREE_E_MEMORY;
    tile->rest = rest;
    rest->columns = geometry->columns;
    rest->rows = geometry->rows;
    rest->cell_span = (geometry->keeps_cells ? 1 : 2) * geometry->cell_span;
    rest->cell_columns = extremes_cells(geometry->columns, rest->cell_span);
    rest->cell_rows = extremes_cells(geometry->rows, rest->cell_span);
    bool leaves_pairs = tile->cell_first == NULL || !geometry->keeps_cells;
    if (leaves_pairs)
        rest->extremes = scree_allocate(tile->memory, 2 * (size_t)rest->cell_columns * (size_t)rest->cell_rows,
                                        sizeof *rest->extremes, "a tile's extremes", error);
    if (leaves_pairs && rest->extremes == NULL) return SCREE_E_MEMORY;
    int32_t across = geometry->keeps_cells ? 1 : 2;
    return slope_grid_allocate(tile->memory, (tile->slopes.columns - 1) / across + 1,
                               (tile->slopes.rows - 1) / across + 1, rest->cell_span, &rest->slopes, error);
}

enum scree_status tile_begin_simplifier(struct tile *tile, struct scree_error *error) {
    struct simplify_options options = {.locked_step = tile->geometry.locked_step};
    return simplifier_start(tile->memory, &tile->mesh, &tile->samples, &options, &tile->simplifier, error);
}

void tile_hand_up_slopes(struct tile *tile) {
    struct slope_grid *handed = &tile->rest->slopes;
    if (tile->geometry.keeps_cells)
        slope_grid_place(&tile->slopes, 0, 0, handed);
    else
        slope_grid_reduce(&tile->slopes, handed);
}
