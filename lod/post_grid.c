#include "lod/post_grid.h"

#include <math.h>
#include <string.h>

#define GUARD 1e-7 /* cells: rows are cut a little too wide rather than too narrow */

static double drop_m(const struct post_grid *grid, double x, double y) {
    return method_drop_m(grid->tile, x * grid->unit_steps, y * grid->unit_steps);
}

static int32_t add_vertex(struct post_grid *grid, int32_t x, int32_t y, double height_m) {
    struct mesh *mesh = &grid->mesh;
    float drawn_m = (float)(height_m - drop_m(grid, x, y));
    mesh->vertices[mesh->vertex_count].at = (struct sample){x, y, drawn_m};
    return mesh->vertex_count++;
}

static void add_triangle(struct mesh *mesh, int32_t a, int32_t b, int32_t c) {
    struct mesh_triangle *triangle = &mesh->triangles[mesh->triangle_count++];
    triangle->vertex[0] = a;
    triangle->vertex[1] = b;
    triangle->vertex[2] = c;
}

/* Posts inside, row by row, and the cells between them, with alternating diagonals. */
static void add_inside(struct post_grid *grid) {
    const struct method_tile *tile = grid->tile;
    int32_t across = tile->columns - 1;
    for (int32_t y = 1; y < tile->rows; y++)
        for (int32_t x = 1; x < tile->columns; x++)
            add_vertex(grid, x * grid->unit, y * grid->unit, tile->heights_m[(int64_t)y * tile->stride + x]);
    for (int32_t y = 0; y < tile->rows - 2; y++)
        for (int32_t x = 0; x < tile->columns - 2; x++) {
            int32_t a = y * across + x, b = a + 1, c = a + across, d = c + 1;
            bool rising = ((x + y) & 1) == 0;
            add_triangle(&grid->mesh, a, b, rising ? d : c);
            add_triangle(&grid->mesh, d, c, rising ? a : b);
        }
}

static void add_ring(struct post_grid *grid) {
    for (uint32_t i = 0; i < grid->ring_count; i++) {
        const struct method_vertex *vertex = &grid->ring[i];
        add_vertex(grid, (int32_t)(vertex->x / grid->unit_steps), (int32_t)(vertex->y / grid->unit_steps),
                   vertex->height_m);
    }
}

/* A row of vertices seen from the side: number `i` of it. */
struct row {
    int32_t first, step, count; /* vertex numbers; those of the border wrap around at `wrap` to `wrap_to` */
    int32_t wrap, wrap_to;
};

static int32_t row_vertex(const struct row *row, int32_t i) {
    int32_t vertex = row->first + i * row->step;
    return vertex == row->wrap ? row->wrap_to : vertex;
}

/* How far along a side running counter-clockwise a vertex lies. */
static int32_t along(const struct mesh *mesh, enum tile_side side, int32_t vertex) {
    const struct sample *at = &mesh->vertices[vertex].at;
    switch (side) {
    case SIDE_SOUTH: return at->x;
    case SIDE_EAST: return at->y;
    case SIDE_NORTH: return -at->x;
    default: return -at->y;
    }
}

/* The strip between a side of the border and the outermost row of posts inside, which lies on its left. */
static void add_strip(struct mesh *mesh, enum tile_side side, const struct row *outer, const struct row *inner) {
    int32_t i = 0, j = 0;
    while (i < outer->count - 1 || j < inner->count - 1) {
        int32_t o = row_vertex(outer, i), n = row_vertex(inner, j);
        bool outward = j == inner->count - 1 ||
                       (i < outer->count - 1 &&
                        along(mesh, side, row_vertex(outer, i + 1)) <= along(mesh, side, row_vertex(inner, j + 1)));
        add_triangle(mesh, o, outward ? row_vertex(outer, i + 1) : row_vertex(inner, j + 1), n);
        if (outward)
            i++;
        else
            j++;
    }
}

static void add_strips(struct post_grid *grid) {
    static const enum tile_side around[SIDE_COUNT] = {SIDE_SOUTH, SIDE_EAST, SIDE_NORTH, SIDE_WEST};
    struct mesh *mesh = &grid->mesh;
    int32_t columns = grid->tile->columns - 1, rows = grid->tile->rows - 1;
    const struct row inner[SIDE_COUNT] = {{0, 1, columns, -1, 0},
                                          {columns - 1, columns, rows, -1, 0},
                                          {columns * rows - 1, -1, columns, -1, 0},
                                          {columns * (rows - 1), -columns, rows, -1, 0}};
    for (int k = 0; k < SIDE_COUNT; k++) {
        const struct row outer = {grid->inner_count + (int32_t)grid->corners[k], 1,
                                  grid->tile->lines[around[k]]->vertex_count, mesh->vertex_count, grid->inner_count};
        add_strip(mesh, around[k], &outer, &inner[k]);
    }
}

static void add_fan(struct post_grid *grid, int32_t middle) {
    int32_t first = grid->inner_count, count = grid->mesh.vertex_count;
    for (int32_t v = first; v < count; v++) add_triangle(&grid->mesh, v, v + 1 < count ? v + 1 : first, middle);
}

static enum scree_status draw_posts(struct scree_memory *memory, struct post_grid *grid, struct scree_error *error) {
    const struct method_tile *tile = grid->tile;
    size_t across = (size_t)tile->columns + 1;
    grid->posts_m = scree_allocate(memory, across * ((size_t)tile->rows + 1), sizeof *grid->posts_m, "posts", error);
    if (grid->posts_m == NULL) return SCREE_E_MEMORY;
    for (int32_t y = 0; y <= tile->rows; y++)
        for (int32_t x = 0; x <= tile->columns; x++)
            grid->posts_m[(size_t)y * across + (size_t)x] =
                tile->heights_m[(int64_t)y * tile->stride + x] -
                drop_m(grid, (double)x * grid->unit, (double)y * grid->unit);
    return SCREE_OK;
}

static enum scree_status allocate(struct scree_memory *memory, struct post_grid *grid, struct scree_error *error) {
    const struct method_tile *tile = grid->tile;
    int64_t inner = (int64_t)(tile->columns - 1) * (tile->rows - 1);
    int64_t longest = tile->columns > tile->rows ? tile->columns : tile->rows;
    if (inner == 0) inner = 1; /* the fan's */
    if (longest * grid->unit > INT32_MAX / 2 || inner > INT32_MAX / 16)
        return scree_fail(error, SCREE_E_LIMIT, "a tile of %d x %d cells is too large for an edge collapse",
                          (int)tile->columns, (int)tile->rows);
    grid->inner_count = (int32_t)inner;
    enum scree_status status = method_ring_new(memory, tile, &grid->ring, &grid->ring_count, grid->corners, error);
    if (status != SCREE_OK) return status;
    /* a triangulation of a disc with n vertices, b of them on the border, has 2 n - b - 2 triangles */
    int32_t border = (int32_t)grid->ring_count;
    return mesh_allocate(memory, grid->inner_count + border, 2 * grid->inner_count + border - 2, &grid->mesh, error);
}

enum scree_status post_grid_make(struct scree_memory *memory, const struct method_tile *tile, struct post_grid *grid,
                                 struct scree_error *error) {
    memset(grid, 0, sizeof *grid);
    grid->tile = tile;
    grid->unit = tile->cell_span > POST_GRID_UNITS ? tile->cell_span : POST_GRID_UNITS;
    grid->unit_steps = (double)tile->cell_span / grid->unit;
    enum scree_status status = allocate(memory, grid, error);
    if (status != SCREE_OK) goto failed;
    bool fan = tile->columns < 2 || tile->rows < 2;
    if (fan) {
        int64_t last = (int64_t)tile->rows * tile->stride;
        const float *h = tile->heights_m;
        double middle_m = ((double)h[0] + h[tile->columns] + h[last] + h[last + tile->columns]) / 4;
        add_vertex(grid, tile->columns * grid->unit / 2, tile->rows * grid->unit / 2, middle_m);
    } else {
        add_inside(grid);
    }
    add_ring(grid);
    if (fan)
        add_fan(grid, 0);
    else
        add_strips(grid);
    if ((status = draw_posts(memory, grid, error)) != SCREE_OK) goto failed;
    if ((status = mesh_connect(memory, &grid->mesh, error)) != SCREE_OK) goto failed;
    return SCREE_OK;
failed:
    post_grid_release(memory, grid);
    return status;
}

void post_grid_release(struct scree_memory *memory, struct post_grid *grid) {
    mesh_release(memory, &grid->mesh);
    scree_release(memory, grid->posts_m);
    scree_release(memory, grid->ring);
    memset(grid, 0, sizeof *grid);
}

/* ---- errors ---- */

/* Posts of the rows first_row .. last_row between two edges, given at row 0 and by their step a row. */
struct rows {
    int32_t first, last;
    double left, left_step, right, right_step;
};

static double scan(const struct post_grid *grid, const struct rows *rows, const double plane[3], double largest_m,
                   double limit_m) {
    for (int32_t y = rows->first; y <= rows->last && largest_m <= limit_m; y++) {
        int32_t first = (int32_t)(rows->left + rows->left_step * y + (1 - GUARD));
        int32_t last = (int32_t)(rows->right + rows->right_step * y + GUARD);
        if (last > grid->tile->columns) last = grid->tile->columns;
        const double *posts_m = grid->posts_m + (int64_t)y * (grid->tile->columns + 1);
        double base = plane[2] + plane[1] * y;
        for (int32_t x = first; x <= last; x++) {
            double distance_m = fabs(posts_m[x] - (base + plane[0] * x));
            if (distance_m > largest_m) largest_m = distance_m;
        }
    }
    return largest_m;
}

struct point {
    double x, y, z;
};

static void edge_of_rows(const struct point *p, const struct point *q, double *at_row_0, double *step) {
    *step = (q->x - p->x) / (q->y - p->y);
    *at_row_0 = p->x - *step * p->y;
}

/* The rows from p's to q's that lie between the edge p-q and the long edge a-c. */
static double scan_half(const struct post_grid *grid, const struct point *p, const struct point *q,
                        const struct point *a, const struct point *c, bool long_on_left, const double plane[3],
                        double largest_m, double limit_m) {
    if (!(q->y > p->y)) return largest_m;
    struct rows rows = {(int32_t)ceil(p->y - GUARD), (int32_t)(q->y + GUARD), 0, 0, 0, 0};
    if (rows.last > grid->tile->rows) rows.last = grid->tile->rows;
    edge_of_rows(a, c, long_on_left ? &rows.left : &rows.right, long_on_left ? &rows.left_step : &rows.right_step);
    edge_of_rows(p, q, long_on_left ? &rows.right : &rows.left, long_on_left ? &rows.right_step : &rows.left_step);
    return scan(grid, &rows, plane, largest_m, limit_m);
}

double post_grid_error_m(const struct post_grid *grid, const struct sample *a, const struct sample *b,
                         const struct sample *c, double limit_m) {
    double scale = 1.0 / grid->unit;
    struct point corner[3] = {{a->x * scale, a->y * scale, a->height_m},
                              {b->x * scale, b->y * scale, b->height_m},
                              {c->x * scale, c->y * scale, c->height_m}};
    double bx = corner[1].x - corner[0].x, by = corner[1].y - corner[0].y, bz = corner[1].z - corner[0].z;
    double cx = corner[2].x - corner[0].x, cy = corner[2].y - corner[0].y, cz = corner[2].z - corner[0].z;
    double area2 = bx * cy - cx * by, plane[3] = {(bz * cy - cz * by) / area2, (cz * bx - bz * cx) / area2, 0};
    plane[2] = corner[0].z - plane[0] * corner[0].x - plane[1] * corner[0].y;
    const struct point *low = &corner[0], *middle = &corner[1], *high = &corner[2], *other;
    if (middle->y < low->y) other = low, low = middle, middle = other;
    if (high->y < low->y) other = low, low = high, high = other;
    if (high->y < middle->y) other = middle, middle = high, high = other;
    double side = (high->x - low->x) * (middle->y - low->y) - (middle->x - low->x) * (high->y - low->y);
    double largest_m = scan_half(grid, low, middle, low, high, side < 0, plane, 0, limit_m);
    return scan_half(grid, middle, high, low, high, side < 0, plane, largest_m, limit_m);
}

/* ---- the result ---- */

enum scree_status post_grid_export(struct scree_memory *memory, const struct post_grid *grid, struct method_mesh *mesh,
                                   struct scree_error *error) {
    const struct mesh *from = &grid->mesh;
    enum scree_status status = SCREE_E_MEMORY;
    memset(mesh, 0, sizeof *mesh);
    uint32_t *rank = scree_allocate(memory, (size_t)from->vertex_count, sizeof *rank, "vertex numbers", error);
    mesh->vertices = scree_allocate(memory, (size_t)from->live_vertices, sizeof *mesh->vertices, "vertices", error);
    mesh->corners = scree_allocate(memory, 3 * (size_t)from->live_triangles, sizeof *mesh->corners, "triangles", error);
    if (rank == NULL || mesh->vertices == NULL || mesh->corners == NULL) goto cleanup;
    for (int32_t v = 0; v < from->vertex_count; v++) {
        const struct sample *at = &from->vertices[v].at;
        if (from->vertices[v].edge == MESH_NONE) continue;
        rank[v] = mesh->vertex_count;
        struct method_vertex *vertex = &mesh->vertices[mesh->vertex_count++];
        vertex->x = at->x * grid->unit_steps;
        vertex->y = at->y * grid->unit_steps;
        vertex->height_m = v >= grid->inner_count ? grid->ring[v - grid->inner_count].height_m
                                                  : at->height_m + drop_m(grid, at->x, at->y);
    }
    for (int32_t t = 0; t < from->triangle_count; t++) {
        if (from->triangles[t].vertex[0] == MESH_NONE) continue;
        uint32_t *corner = mesh->corners + 3 * (size_t)mesh->triangle_count++;
        for (int k = 0; k < 3; k++) corner[k] = rank[from->triangles[t].vertex[k]];
    }
    status = SCREE_OK;
cleanup:
    if (status != SCREE_OK) method_mesh_release(memory, mesh);
    scree_release(memory, rank);
    return status;
}
