/* The tiles that scree_select chooses from (include/scree/select.h): their order, their links and their heights. */
#include "stream/cut.h"
#include "stream/ellipsoid.h"
#include <scree/select.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static int compare_tiles(const void *left, const void *right) {
    const struct scree_tile_id *a = &((const struct scree_select_tile *)left)->id;
    const struct scree_tile_id *b = &((const struct scree_select_tile *)right)->id;
    if (a->zoom != b->zoom) return a->zoom < b->zoom ? -1 : 1;
    uint64_t place = cut_place(a), other = cut_place(b);
    return (place > other) - (place < other);
}

static bool is_of_profile(const struct scree_tile_id *id, enum scree_profile profile) {
    if (id->zoom < 0 || id->zoom > SCREE_MAX_ZOOM) return false;
    uint64_t rows = (uint64_t)1 << id->zoom, columns = profile == SCREE_GEODETIC ? 2 * rows : rows;
    return id->x < columns && id->y < rows;
}

static enum scree_status fail(const struct scree_tile_id *id, const char *what, struct scree_error *error) {
    return scree_fail(error, SCREE_E_ARGUMENT, "tile %d/%u/%u %s", (int)id->zoom, id->x, id->y, what);
}

enum scree_status scree_select_link(const struct scree_terrain *terrain, struct scree_select_tile *tiles,
                                    uint32_t tile_count, struct scree_error *error) {
    uint32_t parent = 0;
    for (uint32_t i = 0; i < tile_count; i++)
        if (!is_of_profile(&tiles[i].id, terrain->profile))
            return fail(&tiles[i].id, "lies outside of the tiles of its zoom", error);
    if (tile_count > 0) qsort(tiles, tile_count, sizeof *tiles, compare_tiles);
    for (uint32_t i = 0; i < tile_count; i++) {
        struct scree_select_tile *tile = &tiles[i];
        tile->first_child = tile->child_count = 0;
        if (i > 0 && compare_tiles(&tiles[i - 1], tile) == 0) return fail(&tile->id, "is listed twice", error);
        if (tile->id.zoom == tiles[0].id.zoom) continue;
        struct scree_select_tile above = {.id = {tile->id.zoom - 1, tile->id.x / 2, tile->id.y / 2}};
        while (compare_tiles(&tiles[parent], &above) < 0) parent++; /* the tile itself comes after it */
        if (compare_tiles(&tiles[parent], &above) != 0) return fail(&tile->id, "is listed without its parent", error);
        if (tiles[parent].child_count == 0) tiles[parent].first_child = i;
        tiles[parent].child_count++;
    }
    return SCREE_OK;
}

void scree_select_heights(const struct scree_terrain *terrain, const struct scree_stream_header *header, uint32_t rung,
                          const struct scree_vertex *vertices, float *lowest_m, float *highest_m) {
    const struct scree_rung *mesh = &header->rungs[rung];
    int32_t lowest = INT32_MAX, highest = INT32_MIN;
    double sagitta_m = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (vertices[v].height < lowest) lowest = vertices[v].height;
        if (vertices[v].height > highest) highest = vertices[v].height;
    }
    if (header->profile == SCREE_GEODETIC) { /* of a chord as long as the tile's diagonal, R the least radius */
        double radians =
            hypot(header->columns * header->spacing_x, header->rows * header->spacing_y) * acos(-1.0) / 180;
        sagitta_m = WGS84_MAJOR_M * fmin(radians * radians / 8, 1);
    }
    double low_m = ldexp(lowest, header->height_exponent) - mesh->max_error_m - sagitta_m;
    double high_m = ldexp(highest, header->height_exponent) + mesh->max_error_m;
    /* rounded outwards */
    *lowest_m = nextafterf((float)fmax(low_m, terrain->lowest_m), -INFINITY);
    *highest_m = nextafterf((float)fmin(high_m, terrain->highest_m), INFINITY);
}
