#include "lod/method_codes.h"

#include "lod/delaunay.h"
#include "lod/position_code.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NONE        UINT32_MAX
#define MOST_PASSES 64

struct coding {
    struct scree_memory *memory;
    struct scree_error *error;
    const struct method_tile *tile;
    const struct method_frame *frame;
    int32_t right, top; /* codes of the eastern and the northern border */
    struct scree_mesh mesh;
    uint32_t *twins; /* of half-edges 3 * t + k, from corner k to k + 1; NONE on the border */
};

static struct coding coding_of(struct scree_memory *memory, const struct method_tile *tile,
                               const struct method_frame *frame, struct scree_error *error) {
    return (struct coding){.memory = memory,
                           .error = error,
                           .tile = tile,
                           .frame = frame,
                           .right = position_code(frame->width, frame->span),
                           .top = position_code(frame->height, frame->span)};
}

/* ---- codes of vertices ---- */

/* The code of a border vertex along its side, from its place among the vertices of the line. */
static int32_t code_along(const struct coding *coding, enum tile_side side, double position) {
    const struct border_line *line = coding->frame->lines[side];
    int32_t vertex = border_before(coding->tile->lines[side], (int32_t)position);
    return position_code(line->vertices[vertex].position, coding->frame->span);
}

static int32_t code_inside(double position, double whole, int32_t steps, int64_t span, int32_t end) {
    double code = floor(position / whole * steps * POSITION_TOP / (double)span + 0.5);
    return (int32_t)fmin(fmax(code, 1), end - 1);
}

static void code_vertex(const struct coding *coding, const struct method_vertex *vertex, struct scree_vertex *coded) {
    const struct method_tile *tile = coding->tile;
    const struct method_frame *frame = coding->frame;
    double width = method_width(tile), height = method_height(tile);
    bool on_column = vertex->x == 0 || vertex->x == width, on_row = vertex->y == 0 || vertex->y == height;
    coded->height = (int32_t)lround(vertex->height_m / frame->height_unit_m);
    coded->x = vertex->x == 0 ? 0 : coding->right;
    coded->y = vertex->y == 0 ? 0 : coding->top;
    if (!on_column)
        coded->x = on_row ? code_along(coding, vertex->y == 0 ? SIDE_SOUTH : SIDE_NORTH, vertex->x)
                          : code_inside(vertex->x, width, frame->width, frame->span, coding->right);
    if (!on_row)
        coded->y = on_column ? code_along(coding, vertex->x == 0 ? SIDE_WEST : SIDE_EAST, vertex->y)
                             : code_inside(vertex->y, height, frame->height, frame->span, coding->top);
}

static enum scree_status allocate(struct coding *coding, uint32_t vertex_count, uint32_t triangle_count) {
    coding->mesh.vertices =
        scree_allocate(coding->memory, vertex_count, sizeof *coding->mesh.vertices, "a tile's vertices", coding->error);
    if (coding->mesh.vertices == NULL) return SCREE_E_MEMORY;
    coding->mesh.corners = scree_allocate(coding->memory, 3 * (size_t)triangle_count, sizeof *coding->mesh.corners,
                                          "a tile's triangles", coding->error);
    if (coding->mesh.corners == NULL) return SCREE_E_MEMORY;
    coding->mesh.vertex_count = vertex_count;
    coding->mesh.triangle_count = triangle_count;
    return SCREE_OK;
}

/* ---- mending ---- */

static int64_t area2(const struct coding *coding, uint32_t a, uint32_t b, uint32_t c) {
    const struct scree_vertex *v = coding->mesh.vertices;
    return (int64_t)(v[b].x - v[a].x) * (v[c].y - v[a].y) - (int64_t)(v[b].y - v[a].y) * (v[c].x - v[a].x);
}

static int64_t area2_of(const struct coding *coding, uint32_t t) {
    const uint32_t *corner = coding->mesh.corners + 3 * (size_t)t;
    return area2(coding, corner[0], corner[1], corner[2]);
}

static uint32_t turned_triangles(const struct coding *coding) {
    uint32_t count = 0;
    for (uint32_t t = 0; t < coding->mesh.triangle_count; t++) count += area2_of(coding, t) <= 0;
    return count;
}

struct keyed_edge {
    uint64_t key; /* of the undirected edge */
    uint32_t edge;
};

static int by_key(const void *left, const void *right) {
    const struct keyed_edge *a = left, *b = right;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->edge < b->edge ? -1 : 1; /* edges differ */
}

static enum scree_status find_twins(struct coding *coding) {
    size_t count = 3 * (size_t)coding->mesh.triangle_count;
    struct keyed_edge *keyed =
        scree_allocate(coding->memory, count, sizeof *keyed, "the edges of a tile", coding->error);
    coding->twins = scree_allocate(coding->memory, count, sizeof *coding->twins, "the edges of a tile", coding->error);
    if (keyed == NULL || coding->twins == NULL) {
        scree_release(coding->memory, keyed);
        return SCREE_E_MEMORY;
    }
    for (size_t edge = 0; edge < count; edge++) {
        uint64_t from = coding->mesh.corners[edge], to = coding->mesh.corners[edge % 3 == 2 ? edge - 2 : edge + 1];
        keyed[edge] = (struct keyed_edge){from < to ? from << 32 | to : to << 32 | from, (uint32_t)edge};
        coding->twins[edge] = NONE;
    }
    qsort(keyed, count, sizeof *keyed, by_key);
    for (size_t i = 0; i + 1 < count; i++)
        if (keyed[i].key == keyed[i + 1].key) {
            coding->twins[keyed[i].edge] = keyed[i + 1].edge;
            coding->twins[keyed[i + 1].edge] = keyed[i].edge;
        }
    scree_release(coding->memory, keyed);
    return SCREE_OK;
}

static void join(struct coding *coding, uint32_t edge, uint32_t twin) {
    coding->twins[edge] = twin;
    if (twin != NONE) coding->twins[twin] = edge;
}

static uint32_t next_edge(uint32_t edge) {
    return edge % 3 == 2 ? edge - 2 : edge + 1;
}

/* Turns an edge into the other diagonal of its quadrilateral, if both triangles are the right way up then. */
static bool flip(struct coding *coding, uint32_t edge) {
    uint32_t across = coding->twins[edge], *corners = coding->mesh.corners;
    if (across == NONE) return false;
    uint32_t after = next_edge(edge), before = next_edge(after);
    uint32_t across_after = next_edge(across), across_before = next_edge(across_after);
    uint32_t a = corners[edge], b = corners[after], c = corners[before], d = corners[across_before];
    if (area2(coding, a, d, c) <= 0 || area2(coding, d, b, c) <= 0) return false;
    /* (a, b, c) and (b, a, d) become (a, d, c) and (b, c, d): corner 1 of each goes */
    uint32_t bc = coding->twins[after], ad = coding->twins[across_after];
    corners[after] = d;
    corners[across_after] = c;
    join(coding, edge, ad);
    join(coding, across, bc);
    join(coding, after, across_after);
    return true;
}

/* The longest edge first: a vertex that came to lie beyond an edge lies beyond the longest one, as a rule. */
static bool mend(struct coding *coding, uint32_t t) {
    uint32_t order[3] = {3 * t, 3 * t + 1, 3 * t + 2};
    int64_t length2[3];
    for (int k = 0; k < 3; k++) {
        const struct scree_vertex *from = &coding->mesh.vertices[coding->mesh.corners[order[k]]];
        const struct scree_vertex *to = &coding->mesh.vertices[coding->mesh.corners[next_edge(order[k])]];
        int64_t dx = to->x - from->x, dy = to->y - from->y;
        length2[k] = dx * dx + dy * dy;
    }
    for (int k = 0; k < 3; k++) {
        int longest = 0;
        for (int i = 1; i < 3; i++)
            if (length2[i] > length2[longest]) longest = i;
        if (flip(coding, order[longest])) return true;
        length2[longest] = -1;
    }
    return false;
}

/* How many triangles are left that no flip mends. */
static uint32_t mend_all(struct coding *coding) {
    uint32_t turned = NONE;
    for (int pass = 0; pass < MOST_PASSES && turned > 0; pass++) {
        uint32_t mended = 0;
        turned = 0;
        for (uint32_t t = 0; t < coding->mesh.triangle_count; t++) {
            if (area2_of(coding, t) > 0) continue;
            turned++;
            mended += mend(coding, t);
        }
        if (mended == 0) break;
    }
    return turned;
}

/* ---- anew ---- */

/* Puts a vertex into the triangulation; of several at a place the first stays. */
static enum scree_status insert(struct coding *coding, struct delaunay *anew, uint32_t vertex,
                                const struct scree_vertex *at, struct scree_vertex *kept) {
    struct delaunay_point point = {at[vertex].x, at[vertex].y};
    enum scree_status status = SCREE_OK;
    if (anew->point_count == anew->capacity) status = delaunay_reserve(anew, 2 * anew->capacity, coding->error);
    if (status != SCREE_OK) return status;
    uint32_t triangle = delaunay_find(anew, anew->triangle_count - 1, point);
    if (delaunay_is_corner(anew, triangle, point)) {
        for (uint32_t corner = 0; corner < 4; corner++) /* those that were there from the beginning */
            if (kept[corner].x == point.x && kept[corner].y == point.y) kept[corner] = at[vertex];
        return SCREE_OK;
    }
    kept[anew->point_count] = at[vertex];
    delaunay_insert(anew, triangle, point);
    return SCREE_OK;
}

static bool is_on_border(const struct coding *coding, const struct scree_vertex *at) {
    return at->x == 0 || at->y == 0 || at->x == coding->right || at->y == coding->top;
}

/* Drops the triangles and makes the Delaunay triangulation of the codes: first the border, then the inside. */
static enum scree_status triangulate_anew(struct coding *coding) {
    struct scree_mesh old = coding->mesh;
    struct delaunay anew;
    enum scree_status status = delaunay_start(coding->memory, coding->right, coding->top, &anew, coding->error);
    struct scree_vertex *kept =
        scree_allocate(coding->memory, (size_t)old.vertex_count + 4, sizeof *kept, "a tile's vertices", coding->error);
    if (status == SCREE_OK && kept == NULL) status = SCREE_E_MEMORY;
    for (uint32_t i = 0; i < 4 && status == SCREE_OK; i++)
        kept[i] = (struct scree_vertex){anew.points[i].x, anew.points[i].y, 0};
    for (int inside = 0; inside < 2; inside++)
        for (uint32_t v = 0; v < old.vertex_count && status == SCREE_OK; v++)
            if (is_on_border(coding, &old.vertices[v]) == (inside == 0))
                status = insert(coding, &anew, v, old.vertices, kept);
    coding->mesh = (struct scree_mesh){0};
    if (status == SCREE_OK) status = allocate(coding, anew.point_count, anew.triangle_count);
    if (status == SCREE_OK) {
        memcpy(coding->mesh.vertices, kept, anew.point_count * sizeof *kept);
        for (uint32_t t = 0; t < anew.triangle_count; t++)
            memcpy(coding->mesh.corners + 3 * (size_t)t, anew.triangles[t].corner, sizeof anew.triangles[t].corner);
    }
    scree_release(coding->memory, kept);
    delaunay_release(&anew);
    scree_release(coding->memory, old.corners);
    scree_release(coding->memory, old.vertices);
    return status;
}

/* ---- the whole ---- */

enum scree_status method_to_codes_new(struct scree_memory *memory, const struct method_tile *tile,
                                      const struct method_frame *frame, const struct method_mesh *mesh,
                                      struct scree_mesh *coded, struct scree_error *error) {
    struct scree_error own_error = {0};
    struct coding coding = coding_of(memory, tile, frame, error != NULL ? error : &own_error);
    *coded = (struct scree_mesh){0};
    if (coding.right < 2 || coding.top < 2)
        return scree_fail(error, SCREE_E_LIMIT, "a tile at the end of the lattice is too narrow to be written");
    enum scree_status status = allocate(&coding, mesh->vertex_count, mesh->triangle_count);
    if (status != SCREE_OK) goto cleanup;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        code_vertex(&coding, &mesh->vertices[v], &coding.mesh.vertices[v]);
    memcpy(coding.mesh.corners, mesh->corners, 3 * sizeof *mesh->corners * mesh->triangle_count);
    if (turned_triangles(&coding) > 0) {
        status = find_twins(&coding);
        if (status == SCREE_OK && mend_all(&coding) > 0) status = triangulate_anew(&coding);
    }
cleanup:
    scree_release(memory, coding.twins);
    if (status != SCREE_OK) {
        scree_release(memory, coding.mesh.corners);
        scree_release(memory, coding.mesh.vertices);
        return status;
    }
    *coded = coding.mesh;
    return SCREE_OK;
}

/* A code as a place along a side of the method's tile; the ends are where they are, whatever their codes. Where there
 * are no more lattice steps than codes, the code of one means that step. */
static double place_of(int32_t code, int32_t end, int64_t span, int32_t steps, double whole) {
    if (code == 0 || code == end) return code == 0 ? 0 : whole;
    double place = (double)code * (double)span / POSITION_TOP, step = floor(place + 0.5);
    if (span <= POSITION_TOP && position_code((int64_t)step, span) == code) place = step;
    return fmin(place * (whole / steps), nextafter(whole, 0));
}

enum scree_status method_from_codes_new(struct scree_memory *memory, const struct method_tile *tile,
                                        const struct method_frame *frame, const struct scree_mesh *coded,
                                        struct method_mesh *mesh, struct scree_error *error) {
    const struct coding coding = coding_of(memory, tile, frame, error);
    *mesh = (struct method_mesh){.vertex_count = coded->vertex_count, .triangle_count = coded->triangle_count};
    mesh->vertices = scree_allocate(memory, coded->vertex_count, sizeof *mesh->vertices, "a method's vertices", error);
    mesh->corners =
        scree_allocate(memory, 3 * (size_t)coded->triangle_count, sizeof *mesh->corners, "a method's triangles", error);
    if (mesh->vertices == NULL || mesh->corners == NULL) {
        method_mesh_release(memory, mesh);
        return SCREE_E_MEMORY;
    }
    for (uint32_t v = 0; v < coded->vertex_count; v++) {
        const struct scree_vertex *at = &coded->vertices[v];
        mesh->vertices[v].x = place_of(at->x, coding.right, frame->span, frame->width, method_width(tile));
        mesh->vertices[v].y = place_of(at->y, coding.top, frame->span, frame->height, method_height(tile));
        mesh->vertices[v].height_m = at->height * frame->height_unit_m;
    }
    memcpy(mesh->corners, coded->corners, 3 * sizeof *coded->corners * coded->triangle_count);
    return SCREE_OK;
}
