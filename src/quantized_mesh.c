/* Encoding of quantized-mesh-1.0 tiles (src/quantized_mesh.h). */
#include "src/quantized_mesh.h"

#include "lod/position_code.h"
#include "src/occlusion.h"
#include "src/octahedral.h"
#include "src/quantized_mesh_order.h"
#include "stream/ellipsoid.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define HEADER_BYTES      88
#define NARROW_TOP        65535 /* most vertices with 16-bit indices; 65,536 are never written */
#define EXTENSION_NORMALS 1     /* octvertexnormals */
#define FINEST_STEP_SHIFT (-12) /* heights are never written finer than this power of two of the height unit */
#define LOOSE_SHARE       0.125 /* see choose_step */

enum side { WEST, SOUTH, EAST, NORTH, SIDES };

struct code { /* of a vertex, 0..32767 each */
    int32_t u, v, height;
};

struct encoding {
    struct scree_memory *memory;
    const struct terrain_tile *tile;
    struct scree_error *error;
    struct lattice_window window;
    int64_t span;
    int32_t east, north;         /* positions of the borders, as the mesh counts them */
    double bounds[4];            /* of the whole tile: west, south, east, north */
    const uint32_t *old_corners; /* the mesh's, or `patched` */
    uint32_t *patched;
    uint32_t extra_vertex; /* the vertex that is written twice where there would be 65,536; else NO_VERTEX */
    uint32_t vertex_count, triangle_count;
    uint32_t *corners;      /* in writing order and numbering */
    uint32_t *vertex_order; /* new number -> the mesh's */
    struct code *codes;     /* in the new numbering */
    struct vector3 *points; /* ECEF, or the CRS of the local profile: what a client decodes */
    unsigned char *normals;
    uint32_t *edge; /* vertices of the four edges, one after the other */
    uint32_t edge_counts[SIDES];
    int64_t minimum; /* height units, a multiple of the border step */
    int step_shift;  /* heights are written in steps of 2^step_shift height units */
    double minimum_m, step_m;
    unsigned char *bytes;
    size_t size_bytes;
};

#define NO_VERTEX UINT32_MAX

static const struct scree_vertex *old_vertex(const struct encoding *e, uint32_t number) {
    uint32_t old = e->vertex_order[number];
    return &e->tile->mesh->vertices[old == e->tile->mesh->vertex_count ? e->extra_vertex : old];
}

static bool is_on_border(const struct encoding *e, const struct scree_vertex *vertex) {
    return vertex->x == 0 || vertex->y == 0 || vertex->x == e->east || vertex->y == e->north;
}

static enum scree_status refuse(const struct encoding *e, enum scree_status status, const char *why) {
    struct tile_id id = e->tile->id;
    return scree_fail(e->error, status, "tile %d/%u/%u: %s", id.zoom, id.x, id.y, why);
}

/* ---- what may come in ---- */

static enum scree_status check_mesh(const struct encoding *e) {
    const struct scree_mesh *mesh = e->tile->mesh;
    if (e->window.columns == 0 || e->window.rows == 0)
        return refuse(e, SCREE_E_ARGUMENT, "lies outside of the terrain");
    if (mesh->vertex_count < 3 || mesh->triangle_count == 0) return refuse(e, SCREE_E_ARGUMENT, "has no triangles");
    if (mesh->vertex_count > INT32_MAX / 4 || mesh->triangle_count > INT32_MAX / 4)
        return refuse(e, SCREE_E_LIMIT, "has more vertices or triangles than can be written");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct scree_vertex *vertex = &mesh->vertices[i];
        if (vertex->x < 0 || vertex->y < 0 || vertex->x > e->east || vertex->y > e->north)
            return refuse(e, SCREE_E_ARGUMENT, "has a vertex outside of its window");
    }
    for (size_t c = 0; c < 3 * (size_t)mesh->triangle_count; c++)
        if (mesh->corners[c] >= mesh->vertex_count)
            return refuse(e, SCREE_E_ARGUMENT, "has a triangle with a vertex that does not exist");
    int32_t step = e->tile->border_step;
    int exponent;
    if (step < 1 || (step & (step - 1)) != 0 || !(e->tile->height_unit_m > 0) || !isfinite(e->tile->height_unit_m) ||
        frexp(e->tile->height_unit_m, &exponent) != 0.5)
        return refuse(e, SCREE_E_ARGUMENT, "wants heights in steps that are not powers of two");
    for (size_t i = 0; e->tile->slopes != NULL && i < 2 * (size_t)mesh->vertex_count; i++)
        if (!isfinite(e->tile->slopes[i])) return refuse(e, SCREE_E_ARGUMENT, "has a slope that is not finite");
    return SCREE_OK;
}

/* ---- order ---- */

static enum scree_status order_once(struct encoding *e, uint32_t vertex_count) {
    return quantized_mesh_order(e->memory, e->old_corners, e->triangle_count, vertex_count, e->corners, e->vertex_order,
                                &e->vertex_count, e->error);
}

/* Gives one of the triangles of an inner vertex a vertex of its own at the same place: clients disagree about the
 * width of indices when there are 65,536 vertices, and 65,537 look the same. */
static enum scree_status order_again_with_twin(struct encoding *e) {
    const struct scree_mesh *mesh = e->tile->mesh;
    size_t corner_count = 3 * (size_t)e->triangle_count, c = 0;
    while (c < corner_count && is_on_border(e, &mesh->vertices[mesh->corners[c]])) c++;
    if (c == corner_count) return refuse(e, SCREE_E_LIMIT, "has exactly 65,536 vertices, all of them on its border");
    e->patched = scree_allocate(e->memory, corner_count, sizeof *e->patched, "a tile's triangles", e->error);
    if (e->patched == NULL) return e->error->status;
    memcpy(e->patched, mesh->corners, corner_count * sizeof *e->patched);
    e->extra_vertex = mesh->corners[c];
    e->patched[c] = mesh->vertex_count;
    e->old_corners = e->patched;
    return order_once(e, mesh->vertex_count + 1);
}

static enum scree_status order_mesh(struct encoding *e) {
    const struct scree_mesh *mesh = e->tile->mesh;
    e->old_corners = mesh->corners;
    e->triangle_count = mesh->triangle_count;
    e->extra_vertex = NO_VERTEX;
    e->corners =
        scree_allocate(e->memory, mesh->triangle_count, 3 * sizeof *e->corners, "a tile's triangles", e->error);
    if (e->corners == NULL) return e->error->status;
    e->vertex_order = scree_allocate(e->memory, (size_t)mesh->vertex_count + 1, sizeof *e->vertex_order,
                                     "a tile's vertices", e->error);
    if (e->vertex_order == NULL) return e->error->status;
    enum scree_status status = order_once(e, mesh->vertex_count);
    if (status == SCREE_OK && e->vertex_count == NARROW_TOP + 1) status = order_again_with_twin(e);
    return status;
}

/* ---- codes ---- */

/* To a multiple of 2^shift, halves up: a rule on the height alone, so that both sides of a border agree. */
static int64_t round_height(int64_t height, int shift) {
    if (shift <= 0) return height;
    int64_t step = (int64_t)1 << shift;
    return (height + step / 2) & ~(step - 1);
}

static int border_shift(const struct encoding *e) {
    int shift = 0;
    while (e->tile->border_step >> shift > 1) shift++;
    return shift;
}

static bool is_float_exact(double value) {
    return fabs(value) <= FLT_MAX && (double)(float)value == value;
}

/* Do heights up to `highest` (inner vertices) and `highest_border` fit 32767 steps of 2^shift units above the minimum,
 * and can the header's two floats say so exactly? */
static bool step_fits(const struct encoding *e, int64_t highest, int64_t highest_border, int shift) {
    double step = ldexp(1, shift);
    int64_t top = round_height(highest, shift);
    if (highest_border > top) top = highest_border;
    double unit_m = e->tile->height_unit_m;
    return (double)(top - e->minimum) <= QUANTIZED_MESH_TOP * step && is_float_exact((double)e->minimum * unit_m) &&
           is_float_exact(((double)e->minimum + QUANTIZED_MESH_TOP * step) * unit_m);
}

/* The finest step that holds the tile's relief. Nothing is gained below one height unit but a header whose maximum
 * lies closer to the mesh, since it has to be 32767 steps above the minimum; that is worth it while those are more
 * than a share of the tile's width, or clients would take low tiles for tall ones. */
static enum scree_status choose_step(struct encoding *e) {
    int coarsest = border_shift(e);
    int64_t lowest = INT64_MAX, highest = INT64_MIN, highest_border = INT64_MIN;
    for (uint32_t i = 0; i < e->vertex_count; i++) {
        const struct scree_vertex *vertex = old_vertex(e, i);
        bool border = is_on_border(e, vertex);
        int64_t height = border ? round_height(vertex->height, coarsest) : vertex->height;
        if (height < lowest) lowest = height;
        if (border && height > highest_border) highest_border = height;
        if (!border && height > highest) highest = height;
    }
    if (highest == INT64_MIN) highest = highest_border;
    e->minimum = lowest & ~((int64_t)e->tile->border_step - 1);
    int shift = 0;
    while (shift <= coarsest && !step_fits(e, highest, highest_border, shift)) shift++;
    if (shift > coarsest) {
        int64_t top = highest > highest_border ? highest : highest_border;
        struct tile_id id = e->tile->id;
        return scree_fail(
            e->error, SCREE_E_LIMIT,
            "tile %d/%u/%u: heights from %g m to %g m do not fit %d steps of %g m; a coarser step is needed", id.zoom,
            id.x, id.y, (double)lowest * e->tile->height_unit_m, (double)top * e->tile->height_unit_m,
            QUANTIZED_MESH_TOP, e->tile->border_step * e->tile->height_unit_m);
    }
    double east_m, north_m;
    lattice_steps_m(e->tile->lattice, (double)e->window.y + e->window.rows / 2.0, &east_m, &north_m);
    double enough_m = LOOSE_SHARE * north_m * (double)e->span;
    while (shift > FINEST_STEP_SHIFT && ldexp(QUANTIZED_MESH_TOP * e->tile->height_unit_m, shift) > enough_m &&
           step_fits(e, highest, highest_border, shift - 1))
        shift--;
    e->step_shift = shift;
    e->minimum_m = (double)e->minimum * e->tile->height_unit_m;
    e->step_m = ldexp(e->tile->height_unit_m, shift);
    return SCREE_OK;
}

static enum scree_status make_codes(struct encoding *e) {
    e->codes = scree_allocate(e->memory, e->vertex_count, sizeof *e->codes, "a tile's vertex codes", e->error);
    if (e->codes == NULL) return e->error->status;
    int coarsest = border_shift(e);
    for (uint32_t i = 0; i < e->vertex_count; i++) {
        const struct scree_vertex *vertex = old_vertex(e, i);
        int64_t rise = round_height(vertex->height, is_on_border(e, vertex) ? coarsest : e->step_shift) - e->minimum;
        e->codes[i] = (struct code){
            .u = e->tile->is_coded ? vertex->x : position_code(vertex->x, e->span),
            .v = e->tile->is_coded ? vertex->y : position_code(vertex->y, e->span),
            .height = (int32_t)(e->step_shift >= 0 ? rise >> e->step_shift : rise << -e->step_shift),
        };
    }
    return SCREE_OK;
}

/* Rounding positions must not have turned a triangle over or made it vanish. */
static enum scree_status check_areas(const struct encoding *e) {
    for (uint32_t t = 0; t < e->triangle_count; t++) {
        const struct code *a = &e->codes[e->corners[3 * t]], *b = &e->codes[e->corners[3 * t + 1]],
                          *c = &e->codes[e->corners[3 * t + 2]];
        int64_t area = (int64_t)(b->u - a->u) * (c->v - a->v) - (int64_t)(c->u - a->u) * (b->v - a->v);
        if (area <= 0) return refuse(e, SCREE_E_ARGUMENT, "has a triangle that is not counter-clockwise as written");
    }
    return SCREE_OK;
}

/* ---- where clients will see the vertices ---- */

#define MEMO_SLOTS 512

/* Many vertices share a meridian or a parallel: a small direct-mapped memory of their sines and cosines. */
struct angle_memo {
    struct {
        int32_t code;
        double sine, cosine;
    } slots[MEMO_SLOTS];
};

static void memo_look_up(struct angle_memo *memo, int32_t code, double first_deg, double last_deg, double *sine,
                         double *cosine) {
    uint32_t slot = ((uint32_t)code * 2654435761u) >> 23; /* Knuth's multiplicative hash to 9 bits */
    if (memo->slots[slot].code != code + 1) {             /* 0: empty */
        double angle_deg = (first_deg * (QUANTIZED_MESH_TOP - code) + last_deg * code) * (1.0 / QUANTIZED_MESH_TOP);
        memo->slots[slot].code = code + 1;
        sine_cosine_deg(angle_deg, &memo->slots[slot].sine, &memo->slots[slot].cosine);
    }
    *sine = memo->slots[slot].sine;
    *cosine = memo->slots[slot].cosine;
}

static void place_vertex_geodetic(struct encoding *e, struct angle_memo *meridians, struct angle_memo *parallels,
                                  uint32_t i) {
    double sin_lon, cos_lon, sin_lat, cos_lat;
    memo_look_up(meridians, e->codes[i].u, e->bounds[0], e->bounds[2], &sin_lon, &cos_lon);
    memo_look_up(parallels, e->codes[i].v, e->bounds[1], e->bounds[3], &sin_lat, &cos_lat);
    struct east_north_up frame = ellipsoid_frame_of(sin_lon, cos_lon, sin_lat, cos_lat);
    e->points[i] = ellipsoid_point(frame.up, e->minimum_m + e->codes[i].height * e->step_m);
    if (e->normals == NULL) return;
    const float *slope = &e->tile->slopes[2 * (size_t)(old_vertex(e, i) - e->tile->mesh->vertices)];
    octahedral_encode(ellipsoid_normal(&frame, slope[0], slope[1]), &e->normals[2 * (size_t)i]);
}

static const struct east_north_up plain_frame = {.east = {1, 0, 0}, .north = {0, 1, 0}, .up = {0, 0, 1}};

static void place_vertex_local(struct encoding *e, uint32_t i) {
    const struct code *code = &e->codes[i];
    e->points[i] = (struct vector3){
        e->bounds[0] + code->u * (e->bounds[2] - e->bounds[0]) / QUANTIZED_MESH_TOP,
        e->bounds[1] + code->v * (e->bounds[3] - e->bounds[1]) / QUANTIZED_MESH_TOP,
        e->minimum_m + code->height * e->step_m,
    };
    if (e->normals == NULL) return;
    const float *slope = &e->tile->slopes[2 * (size_t)(old_vertex(e, i) - e->tile->mesh->vertices)];
    octahedral_encode(ellipsoid_normal(&plain_frame, slope[0], slope[1]), &e->normals[2 * (size_t)i]);
}

static enum scree_status place_vertices(struct encoding *e) {
    e->points = scree_allocate(e->memory, e->vertex_count, sizeof *e->points, "a tile's points", e->error);
    if (e->points == NULL) return e->error->status;
    if (e->tile->slopes != NULL) {
        e->normals = scree_allocate(e->memory, e->vertex_count, 2, "a tile's normals", e->error);
        if (e->normals == NULL) return e->error->status;
    }
    if (e->tile->lattice->profile == PROFILE_LOCAL) {
        for (uint32_t i = 0; i < e->vertex_count; i++) place_vertex_local(e, i);
        return SCREE_OK;
    }
    struct angle_memo *memos = scree_allocate(e->memory, 2, sizeof *memos, "a tile's meridians", e->error);
    if (memos == NULL) return e->error->status;
    for (uint32_t i = 0; i < e->vertex_count; i++) place_vertex_geodetic(e, &memos[0], &memos[1], i);
    scree_release(e->memory, memos);
    return SCREE_OK;
}

/* ---- edges ---- */

/* West and east by latitude, south and north by longitude; a corner belongs to two edges. */
static bool is_on_side(const struct encoding *e, const struct scree_vertex *vertex, enum side side) {
    switch (side) {
    case WEST: return vertex->x == 0;
    case SOUTH: return vertex->y == 0;
    case EAST: return vertex->x == e->east;
    default: return vertex->y == e->north;
    }
}

static int compare_keys(const void *a, const void *b) {
    uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return left < right ? -1 : left > right; /* equal only for the same vertex: its number is part of the key */
}

static enum scree_status collect_edges(struct encoding *e) {
    uint32_t border_count = 0;
    for (uint32_t i = 0; i < e->vertex_count; i++) border_count += is_on_border(e, old_vertex(e, i));
    size_t room = 2 * (size_t)border_count + 1;
    e->edge = scree_allocate(e->memory, room, sizeof *e->edge, "a tile's edges", e->error);
    if (e->edge == NULL) return e->error->status;
    uint64_t *keys = scree_allocate(e->memory, room, sizeof *keys, "a tile's edges", e->error);
    if (keys == NULL) return e->error->status;
    uint32_t *out = e->edge;
    for (enum side side = WEST; side < SIDES; side++) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < e->vertex_count; i++) {
            const struct scree_vertex *vertex = old_vertex(e, i);
            if (!is_on_side(e, vertex, side)) continue;
            uint32_t along = (uint32_t)(side == WEST || side == EAST ? vertex->y : vertex->x);
            keys[count++] = (uint64_t)along << 32 | i;
        }
        qsort(keys, count, sizeof *keys, compare_keys);
        for (uint32_t i = 0; i < count; i++) *out++ = (uint32_t)keys[i];
        e->edge_counts[side] = count;
    }
    scree_release(e->memory, keys);
    return SCREE_OK;
}

/* ---- bytes ---- */

static unsigned char *put_u16(unsigned char *out, uint32_t value) {
    out[0] = (unsigned char)value;
    out[1] = (unsigned char)(value >> 8);
    return out + 2;
}

static unsigned char *put_u32(unsigned char *out, uint32_t value) {
    return put_u16(put_u16(out, value & 0xffff), value >> 16);
}

static unsigned char *put_float(unsigned char *out, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return put_u32(out, bits);
}

static unsigned char *put_double(unsigned char *out, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return put_u32(put_u32(out, (uint32_t)bits), (uint32_t)(bits >> 32));
}

static unsigned char *put_vector(unsigned char *out, struct vector3 value) {
    return put_double(put_double(put_double(out, value.x), value.y), value.z);
}

static unsigned char *put_header(const struct encoding *e, unsigned char *out) {
    bool local = e->tile->lattice->profile == PROFILE_LOCAL;
    double middle_x = lattice_x(e->tile->lattice, (double)e->window.x + e->window.columns / 2.0);
    double middle_y = lattice_y(e->tile->lattice, (double)e->window.y + e->window.rows / 2.0);
    int32_t highest_code = 0;
    for (uint32_t i = 0; i < e->vertex_count; i++)
        if (e->codes[i].height > highest_code) highest_code = e->codes[i].height;
    double middle_m = e->minimum_m + highest_code / 2.0 * e->step_m;
    struct east_north_up frame = local ? plain_frame : ellipsoid_frame(middle_x, middle_y);
    struct vector3 centre = {middle_x, middle_y, middle_m};
    struct vector3 occlusion = {0, 0, 0};
    if (!local) {
        centre = ellipsoid_point(frame.up, middle_m);
        occlusion = horizon_occlusion_point(e->points, e->vertex_count, ellipsoid_point(frame.up, 0));
    }
    struct sphere sphere = bounding_sphere(e->points, e->vertex_count, &frame);
    out = put_vector(out, centre);
    out = put_float(out, (float)e->minimum_m);
    out = put_float(out, (float)(e->minimum_m + QUANTIZED_MESH_TOP * e->step_m));
    out = put_vector(out, sphere.centre);
    out = put_double(out, sphere.radius_m);
    return put_vector(out, occlusion);
}

static uint32_t zigzag(int32_t value) {
    return (uint32_t)value << 1 ^ (uint32_t)(value < 0 ? -1 : 0);
}

static unsigned char *put_vertices(const struct encoding *e, unsigned char *out) {
    out = put_u32(out, e->vertex_count);
    unsigned char *u = out, *v = u + 2 * (size_t)e->vertex_count, *height = v + 2 * (size_t)e->vertex_count;
    struct code last = {0, 0, 0};
    for (uint32_t i = 0; i < e->vertex_count; i++) {
        struct code code = e->codes[i];
        u = put_u16(u, zigzag(code.u - last.u));
        v = put_u16(v, zigzag(code.v - last.v));
        height = put_u16(height, zigzag(code.height - last.height));
        last = code;
    }
    return height;
}

static bool is_wide(const struct encoding *e) {
    return e->vertex_count > NARROW_TOP;
}

static unsigned char *put_index(const struct encoding *e, unsigned char *out, uint32_t index) {
    return is_wide(e) ? put_u32(out, index) : put_u16(out, index);
}

/* Each index as its distance from the next number that no triangle has used yet. */
static unsigned char *put_triangles(const struct encoding *e, unsigned char *out) {
    out = put_u32(out, e->triangle_count);
    uint32_t next = 0;
    for (size_t c = 0; c < 3 * (size_t)e->triangle_count; c++) {
        uint32_t code = next - e->corners[c];
        if (code == 0) next++;
        out = put_index(e, out, code);
    }
    return out;
}

static unsigned char *put_edges(const struct encoding *e, unsigned char *out) {
    const uint32_t *vertex = e->edge;
    for (enum side side = WEST; side < SIDES; side++) {
        out = put_u32(out, e->edge_counts[side]);
        for (uint32_t i = 0; i < e->edge_counts[side]; i++) out = put_index(e, out, *vertex++);
    }
    return out;
}

static unsigned char *put_normals(const struct encoding *e, unsigned char *out) {
    *out++ = EXTENSION_NORMALS;
    out = put_u32(out, 2 * e->vertex_count);
    memcpy(out, e->normals, 2 * (size_t)e->vertex_count);
    return out + 2 * (size_t)e->vertex_count;
}

/* Zero bytes between vertices and 32-bit indices, which start at a multiple of four. */
static size_t padding_bytes(const struct encoding *e) {
    return is_wide(e) ? (2 * (size_t)e->vertex_count) % 4 : 0;
}

static enum scree_status write_bytes(struct encoding *e) {
    size_t index_bytes = is_wide(e) ? 4 : 2, edges = 0;
    for (enum side side = WEST; side < SIDES; side++) edges += e->edge_counts[side];
    e->size_bytes = HEADER_BYTES + 4 + 6 * (size_t)e->vertex_count + padding_bytes(e) + 4 +
                    3 * index_bytes * e->triangle_count + 4 * SIDES + index_bytes * edges +
                    (e->normals != NULL ? 5 + 2 * (size_t)e->vertex_count : 0);
    e->bytes = scree_allocate(e->memory, e->size_bytes, 1, "a tile's bytes", e->error);
    if (e->bytes == NULL) return e->error->status;
    unsigned char *out = put_header(e, e->bytes);
    out = put_vertices(e, out);
    out += padding_bytes(e);
    out = put_triangles(e, out);
    out = put_edges(e, out);
    if (e->normals != NULL) put_normals(e, out);
    return SCREE_OK;
}

enum scree_status quantized_mesh_encode_new(struct scree_memory *memory, const struct terrain_tile *tile,
                                            unsigned char **bytes, size_t *size_bytes, struct scree_error *error) {
    struct scree_error own = {0};
    struct encoding e = {.memory = memory, .tile = tile, .error = error != NULL ? error : &own};
    e.window = lattice_tile_window(tile->lattice, tile->id);
    e.span = lattice_tile_span(tile->lattice, tile->id.zoom);
    e.east = tile->is_coded ? position_code(e.window.columns, e.span) : e.window.columns;
    e.north = tile->is_coded ? position_code(e.window.rows, e.span) : e.window.rows;
    lattice_tile_bounds(tile->lattice, tile->id, e.bounds);
    enum scree_status status = check_mesh(&e);
    if (status == SCREE_OK) status = order_mesh(&e);
    if (status == SCREE_OK) status = choose_step(&e);
    if (status == SCREE_OK) status = make_codes(&e);
    if (status == SCREE_OK) status = check_areas(&e);
    if (status == SCREE_OK) status = place_vertices(&e);
    if (status == SCREE_OK) status = collect_edges(&e);
    if (status == SCREE_OK) status = write_bytes(&e);
    *bytes = e.bytes;
    *size_bytes = e.size_bytes;
    scree_release(memory, e.edge);
    scree_release(memory, e.normals);
    scree_release(memory, e.points);
    scree_release(memory, e.codes);
    scree_release(memory, e.vertex_order);
    scree_release(memory, e.corners);
    scree_release(memory, e.patched);
    return status;
}
