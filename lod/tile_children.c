/* A tile out of its four children. */
#include "lod/extremes.h"
#include "lod/merge.h"
#include "lod/tile_lines.h"
#include "lod/tile_parts.h"
#include "lod/tile_samples.h"

#include <string.h>

static enum scree_status use_extremes(struct tile *tile, const struct coarse_tile *const children[4],
                                      int32_t child_span, struct scree_error *error) {
    tile->samples = tile_own_samples(tile);
    tile->extremes = scree_allocate(tile->memory, 2 * (size_t)tile->samples.columns * (size_t)tile->samples.rows,
                                    sizeof *tile->extremes, "extremes", error);
    if (tile->extremes == NULL) return SCREE_E_MEMORY;
    tile->samples.extremes = tile->extremes;
    for (int i = 0; i < 4; i++) {
        if (children[i] == NULL) continue;
        int32_t x = i % 2 * child_span, y = i / 2 * child_span, span = tile->geometry.cell_span;
        extremes_place(children[i]->extremes, children[i]->cell_columns, children[i]->cell_rows, x / span, y / span, x,
                       y, tile->extremes, tile->samples.columns);
    }
    return SCREE_OK;
}

static enum scree_status use_slopes(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                                    struct scree_error *error) {
    const struct tile_geometry *geometry = &tile->geometry;
    int32_t span = geometry->cell_span;
    enum scree_status status = slope_grid_allocate(tile->memory, geometry->columns / span + 1,
                                                   geometry->rows / span + 1, span, &tile->slopes, error);
    for (int i = 0; i < 4 && status == SCREE_OK; i++)
        if (children[i] != NULL)
            slope_grid_place(&children[i]->slopes, i % 2 * child_span / span, i / 2 * child_span / span, &tile->slopes);
    return status;
}

static enum scree_status finish_extremes(struct tile *tile, struct scree_error *error) {
    enum scree_status status = tile_begin_rest(tile, error);
    if (status != SCREE_OK) return status;
    if (tile->cell_first != NULL && !tile->geometry.keeps_cells)
        tile_samples_leave_pairs(tile);
    else if (tile->cell_first == NULL && tile->geometry.keeps_cells)
        memcpy(tile->rest->extremes, tile->extremes,
               2 * (size_t)tile->samples.columns * (size_t)tile->samples.rows * sizeof *tile->extremes);
    else if (tile->cell_first == NULL)
        extremes_reduce(tile->extremes, tile->samples.columns, tile->samples.rows, tile->rest->extremes);
    tile_hand_up_slopes(tile);
    return SCREE_OK;
}

static enum scree_status border_is_closed(const struct tile *tile, struct scree_error *error) {
    for (int32_t v = 0; v < tile->mesh.vertex_count; v++) {
        const struct mesh_vertex *vertex = &tile->mesh.vertices[v];
        const struct sample *at = &vertex->at;
        bool on_border = at->x == 0 || at->y == 0 || at->x == tile->geometry.columns || at->y == tile->geometry.rows;
        if (!on_border && mesh_twin(&tile->mesh, vertex->edge) == MESH_NONE)
            return scree_fail(error, SCREE_E_CORRUPT, "tiles disagree about the vertices of a common border");
    }
    return SCREE_OK;
}

static enum scree_status join_lines(struct tile *tile, const struct coarse_tile *const children[4], int32_t child_span,
                                    struct scree_error *error) {
    const struct border_line *lines[4];
    for (int i = 0; i < 4; i++) lines[i] = children[i] != NULL ? children[i]->lines : NULL;
    return tile_lines_join(lines, child_span, tile->geometry.cell_span, tile->cell_first != NULL,
                           tile->geometry.side_drop_m, tile->lines, error);
}

int32_t tile_child_span(const struct coarse_tile *const children[4]) {
    if (children[2] != NULL) return children[0]->rows;
    if (children[1] != NULL) return children[0]->columns;
    return children[0]->columns > children[0]->rows ? children[0]->columns : children[0]->rows;
}

enum scree_status tile_from_children(struct scree_memory *memory, const struct tile_geometry *geometry,
                                     const struct coarse_tile *const children[4], struct tile *tile,
                                     struct scree_error *error) {
    enum scree_status status;
    const struct scree_mesh *meshes[4];
    int32_t child_span = tile_child_span(children);
    if ((status = tile_begin(memory, geometry, tile, error)) != SCREE_OK) return status;
    for (int i = 0; i < 4; i++) meshes[i] = children[i] != NULL ? &children[i]->mesh : NULL;
    if ((status = mesh_merge(memory, meshes, child_span, &tile->mesh, error)) != SCREE_OK) goto failed;
    if ((status = border_is_closed(tile, error)) != SCREE_OK) goto failed;
    status = tile_samples_are_whole(children) ? tile_samples_join(tile, children, child_span, error)
                                              : use_extremes(tile, children, child_span, error);
    if (status != SCREE_OK) goto failed;
    if ((status = use_slopes(tile, children, child_span, error)) != SCREE_OK) goto failed;
    if ((status = join_lines(tile, children, child_span, error)) != SCREE_OK) goto failed;
    tile_place_vertices(tile);
    if ((status = finish_extremes(tile, error)) != SCREE_OK) goto failed;
    mesh_measure(&tile->mesh, &tile->samples);
    if ((status = tile_begin_simplifier(tile, error)) != SCREE_OK) goto failed;
    return SCREE_OK;
failed:
    tile_release(tile);
    return status;
}
