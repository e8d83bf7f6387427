#include "src/verify_stream_tile.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#define TILE        "%d/%" PRIu32 "/%" PRIu32
#define TILE_OF(i)  (i).zoom, (i).x, (i).y
#define STEP_SLACK  1e-6       /* of a lattice step: for the rounding of coordinates */
#define FLOAT_SLACK (1 + 1e-6) /* for what headers round to floats */

/* ---- header ---- */

static bool is_near(double a, double b, double step) {
    return fabs(a - b) <= STEP_SLACK * fabs(step);
}

static bool is_placed(const struct scree_stream_header *header, const struct lattice *lattice,
                      const struct lattice_window *window) {
    return header->columns == window->columns && header->rows == window->rows &&
           is_near(header->west, lattice_x(lattice, (double)window->x), lattice->spacing_x) &&
           is_near(header->south, lattice_y(lattice, (double)window->y), lattice->spacing_y) &&
           is_near(header->spacing_x * header->columns, lattice->spacing_x * window->columns, lattice->spacing_x) &&
           is_near(header->spacing_y * header->rows, lattice->spacing_y * window->rows, lattice->spacing_y);
}

static bool verify_place(const struct scree_stream_header *header, const struct scree_info *info, struct tile_id id,
                         struct verify_report *report) {
    struct lattice_window window = lattice_tile_window(&info->lattice, id);
    bool is_geodetic = header->profile == SCREE_GEODETIC;
    if (header->zoom != id.zoom || header->tile_x != id.x || header->tile_y != id.y) {
        report_broken(report, PROMISE_STREAM_PLACE, "tile " TILE ": its header says that it is " TILE, TILE_OF(id),
                      header->zoom, header->tile_x, header->tile_y);
    } else if (is_geodetic != (info->lattice.profile == PROFILE_GEODETIC) ||
               !is_placed(header, &info->lattice, &window)) {
        report_broken(report, PROMISE_STREAM_PLACE,
                      "tile " TILE ": its header says %d x %d steps from %.9g, %.9g; by scree.json it has %d x %d from "
                      "%.9g, %.9g",
                      TILE_OF(id), header->columns, header->rows, header->west, header->south, window.columns,
                      window.rows, lattice_x(&info->lattice, (double)window.x),
                      lattice_y(&info->lattice, (double)window.y));
    } else if (header->height_exponent != info->height_exponent) {
        report_broken(report, PROMISE_STREAM_PLACE,
                      "tile " TILE ": heights are multiples of 2^%d m, in scree.json 2^%d", TILE_OF(id),
                      header->height_exponent, info->height_exponent);
    } else {
        report_held(report, PROMISE_STREAM_PLACE);
        return true;
    }
    return false;
}

static void verify_scales(const struct scree_stream_header *header, const struct scree_info *info, struct tile_id id,
                          struct verify_report *report) {
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rung = &header->rungs[i];
        int64_t step = (int64_t)rung->rung - info->first_rung;
        if (step < 0 || step >= info->rung_count) {
            report_broken(report, PROMISE_STREAM_SCALES, "tile " TILE ": rung %d is not on the ladder", TILE_OF(id),
                          rung->rung);
        } else if (i > 0 && rung->svo_m > rung[-1].svo_m) {
            report_broken(report, PROMISE_STREAM_SCALES, "tile " TILE ": SVO grows from rung %d to rung %d",
                          TILE_OF(id), rung[-1].rung, rung->rung);
        } else if (rung->svo_m * FLOAT_SLACK < sqrt(rung->mmqe_m2)) {
            report_broken(report, PROMISE_STREAM_SCALES,
                          "tile " TILE ": SVO of rung %d is %g m, its MMQE makes it %g m", TILE_OF(id), rung->rung,
                          rung->svo_m, sqrt(rung->mmqe_m2));
        } else {
            report_held(report, PROMISE_STREAM_SCALES);
        }
    }
}

bool verify_stream_header(const struct scree_stream_header *header, const struct scree_info *info, struct tile_id id,
                          struct verify_report *report) {
    verify_scales(header, info, id, report);
    return verify_place(header, info, id, report);
}

/* ---- triangles ---- */

static int64_t double_area(const struct scree_arrays *arrays, uint32_t triangle) {
    const uint32_t *corners = arrays->indices + 3 * (size_t)triangle;
    const struct scree_vertex *a = &arrays->vertices[corners[0]], *b = &arrays->vertices[corners[1]];
    const struct scree_vertex *c = &arrays->vertices[corners[2]];
    return ((int64_t)b->x - a->x) * ((int64_t)c->y - a->y) - ((int64_t)c->x - a->x) * ((int64_t)b->y - a->y);
}

static void verify_areas(const struct scree_stream_header *header, const struct scree_arrays *arrays, int32_t rung,
                         struct tile_id id, struct verify_report *report) {
    int64_t sum = 0;
    uint32_t bad = 0;
    for (uint32_t t = 0; t < arrays->triangle_count; t++) {
        int64_t area = double_area(arrays, t);
        bad += area <= 0;
        sum += area;
    }
    if (bad == 0) {
        report_held(report, PROMISE_ORIENTATION);
    } else {
        report_broken(report, PROMISE_ORIENTATION,
                      "tile " TILE ", rung %d: %" PRIu32 " triangles without a positive area", TILE_OF(id), rung, bad);
    }
    if (sum == 2 * (int64_t)header->columns * header->rows) {
        report_held(report, PROMISE_COVER);
    } else {
        report_broken(report, PROMISE_COVER, "tile " TILE ", rung %d: the areas of its triangles add up to %.6g tiles",
                      TILE_OF(id), rung, (double)sum / (2.0 * header->columns * header->rows));
    }
}

struct edge {
    uint32_t low, high; /* vertices */
    bool is_rising;     /* from low to high */
};

static int by_vertices(const void *left, const void *right) {
    const struct edge *a = left, *b = right;
    if (a->low != b->low) return a->low < b->low ? -1 : 1;
    if (a->high != b->high) return a->high < b->high ? -1 : 1;
    return (int)a->is_rising - (int)b->is_rising; /* equal ones are breaches, whichever comes first */
}

static bool is_on_border(const struct scree_stream_header *header, const struct scree_vertex *a,
                         const struct scree_vertex *b) {
    return (a->x == b->x && (a->x == 0 || a->x == header->columns)) ||
           (a->y == b->y && (a->y == 0 || a->y == header->rows));
}

/* Edges that are neither paired with one opposite nor single along the border. */
static uint32_t count_bad_edges(const struct scree_stream_header *header, const struct scree_arrays *arrays,
                                const struct edge *edges, size_t count) {
    uint32_t bad = 0;
    for (size_t i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count && edges[next].low == edges[i].low && edges[next].high == edges[i].high;)
            next++;
        bool on_border = is_on_border(header, &arrays->vertices[edges[i].low], &arrays->vertices[edges[i].high]);
        bool is_pair = next == i + 2 && edges[i].is_rising != edges[i + 1].is_rising;
        bad += !(on_border ? next == i + 1 : is_pair);
    }
    return bad;
}

static enum scree_status verify_edges(struct scree_memory *memory, const struct scree_stream_header *header,
                                      const struct scree_arrays *arrays, int32_t rung, struct tile_id id,
                                      struct verify_report *report, struct scree_error *error) {
    size_t count = 3 * (size_t)arrays->triangle_count;
    struct edge *edges = scree_allocate(memory, count, sizeof *edges, "a tile's edges", error);
    if (edges == NULL) return SCREE_E_MEMORY;
    for (size_t i = 0; i < count; i++) {
        uint32_t from = arrays->indices[i], to = arrays->indices[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = (struct edge){from < to ? from : to, from < to ? to : from, from < to};
    }
    qsort(edges, count, sizeof *edges, by_vertices);
    uint32_t bad = count_bad_edges(header, arrays, edges, count);
    if (bad == 0) {
        report_held(report, PROMISE_COVER);
    } else {
        report_broken(report, PROMISE_COVER, "tile " TILE ", rung %d: %" PRIu32 " edges are open or used twice",
                      TILE_OF(id), rung, bad);
    }
    scree_release(memory, edges);
    return SCREE_OK;
}

enum scree_status verify_stream_rungs(struct scree_memory *memory, struct scree_player *player, struct tile_id id,
                                      struct verify_report *report, struct scree_error *error) {
    const struct scree_stream_header *header = scree_player_header(player);
    for (uint32_t i = 0; i < header->rung_count; i++) {
        const struct scree_rung *rung = &header->rungs[i];
        struct scree_arrays arrays;
        scree_player_seek_rung(player, i);
        scree_player_look(player, &arrays);
        if (arrays.vertex_count != rung->vertex_count || arrays.triangle_count != rung->triangle_count) {
            report_broken(report, PROMISE_STREAM_FORMAT,
                          "tile " TILE ", rung %d: %" PRIu32 " vertices and %" PRIu32
                          " triangles, by its header %" PRIu32 " and %" PRIu32,
                          TILE_OF(id), rung->rung, arrays.vertex_count, arrays.triangle_count, rung->vertex_count,
                          rung->triangle_count);
            continue;
        }
        report_held(report, PROMISE_STREAM_FORMAT);
        verify_areas(header, &arrays, rung->rung, id, report);
        if (i != 0 && i + 1 != header->rung_count) continue;
        enum scree_status status = verify_edges(memory, header, &arrays, rung->rung, id, report, error);
        if (status != SCREE_OK) return status;
    }
    return SCREE_OK;
}
