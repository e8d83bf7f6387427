#include "src/verify_tile.h"

#include "src/decoded_place.h"
#include "src/verify_cover.h"

#include <inttypes.h>
#include <math.h>

#define REFUSED_VERTICES 65536 /* clients disagree about the width of indices here */
#define SPHERE_SLACK_M   1e-3  /* for rounding in coordinates of millions of metres */
#define CENTRE_SLACK_M   1.0
#define OCCLUSION_SLACK  1e-9 /* in radii of the earth: 6 mm */
#define FAR_AWAY         1e5  /* stands for a point at infinity, where a tile reaches 90 degrees away */

#define TILE           "tile %d/%" PRIu32 "/%" PRIu32
#define TILE_ID(frame) (frame)->id.zoom, (frame)->id.x, (frame)->id.y

struct tile_frame tile_frame_of(const struct lattice *lattice, struct tile_id id, bool is_ours) {
    struct tile_frame frame = {.id = id, .profile = lattice->profile, .is_ours = is_ours};
    struct lattice_window window = lattice_tile_window(lattice, id);
    int64_t span = lattice_tile_span(lattice, id.zoom);
    lattice_tile_bounds(lattice, id, frame.bounds);
    frame.right = (uint16_t)((2 * (int64_t)window.columns * DECODED_TOP + span) / (2 * span)); /* to nearest */
    frame.top = (uint16_t)((2 * (int64_t)window.rows * DECODED_TOP + span) / (2 * span));
    return frame;
}

static bool is_finite_point(const double point[3]) {
    return isfinite(point[0]) && isfinite(point[1]) && isfinite(point[2]);
}

static void check_vertices(const struct decoded_tile *tile, const struct tile_frame *frame,
                           struct verify_report *report) {
    if (tile->vertex_count == REFUSED_VERTICES) {
        report_broken(report, PROMISE_VERTICES, TILE ": exactly 65,536 vertices, which clients draw wrongly",
                      TILE_ID(frame));
    } else if (tile->used_vertex_count != tile->vertex_count) {
        report_broken(report, PROMISE_VERTICES, TILE ": %" PRIu32 " of %" PRIu32 " vertices belong to no triangle",
                      TILE_ID(frame), tile->vertex_count - tile->used_vertex_count, tile->vertex_count);
    } else {
        report_held(report, PROMISE_VERTICES);
    }
}

/* The header's centre: on the vertical of the tile's middle, at a height that the tile knows. */
static bool centre_fits(const struct decoded_tile *tile, const struct tile_frame *frame) {
    const double *b = frame->bounds;
    struct vec3 centre = {tile->center_m[0], tile->center_m[1], tile->center_m[2]};
    double low = fmin(0, tile->height_min_m) - CENTRE_SLACK_M, high = fmax(0, tile->height_max_m) + CENTRE_SLACK_M;
    if (!frame->is_ours) return true;
    if (frame->profile == PROFILE_LOCAL)
        return centre.x >= b[0] && centre.x <= b[2] && centre.y >= b[1] && centre.y <= b[3] && centre.z >= low &&
               centre.z <= high;
    struct horizon_frame horizon = place_horizon((b[0] + b[2]) / 2, (b[1] + b[3]) / 2);
    struct vec3 offset = place_in_horizon_m(&horizon, centre);
    return hypot(offset.x, offset.y) <= CENTRE_SLACK_M && offset.z >= low && offset.z <= high;
}

static void check_header(const struct decoded_tile *tile, const struct tile_frame *frame,
                         struct verify_report *report) {
    double outside_m = 0;
    struct vec3 middle = {tile->sphere_center_m[0], tile->sphere_center_m[1], tile->sphere_center_m[2]};
    if (!isfinite(tile->height_min_m) || !isfinite(tile->height_max_m) || tile->height_min_m > tile->height_max_m) {
        report_broken(report, PROMISE_HEADER, TILE ": heights from %g to %g m make no range", TILE_ID(frame),
                      tile->height_min_m, tile->height_max_m);
        return;
    }
    if (!is_finite_point(tile->center_m) || !is_finite_point(tile->sphere_center_m) ||
        !isfinite(tile->sphere_radius_m) || !centre_fits(tile, frame)) {
        report_broken(report, PROMISE_HEADER, TILE ": the centre is not the tile's", TILE_ID(frame));
        return;
    }
    for (uint32_t i = 0; i < tile->vertex_count; i++) {
        struct vec3 offset = vec3_minus(place_vertex(frame->profile, frame->bounds, tile, i), middle);
        outside_m = fmax(outside_m, sqrt(vec3_dot(offset, offset)) - tile->sphere_radius_m);
    }
    if (outside_m > SPHERE_SLACK_M) {
        report_broken(report, PROMISE_HEADER, TILE ": a vertex lies %.3f m outside of the bounding sphere",
                      TILE_ID(frame), outside_m);
    } else {
        report_held(report, PROMISE_HEADER);
    }
}

/* In the space where the ellipsoid is the unit sphere: a viewer who just loses sight of `point` looks along a tangent
 * of the sphere, and touches it at an angle of acos(1 / |point|) from the point's direction. On the side of the vertex
 * that tangent plane has to have the vertex below it, and the vertex has to be nearer than the tangent's foot. */
static bool is_hidden_with(struct vec3 vertex, struct vec3 point) {
    double distance = sqrt(vec3_dot(point, point)), size = sqrt(vec3_dot(vertex, vertex));
    if (size < 1) { /* below the ellipsoid: as if on it, since the sea hides less than the ellipsoid */
        vertex = (struct vec3){vertex.x / size, vertex.y / size, vertex.z / size};
        size = 1;
    }
    struct vec3 direction = {point.x / distance, point.y / distance, point.z / distance};
    double along = vec3_dot(vertex, direction);
    struct vec3 beside = {vertex.x - along * direction.x, vertex.y - along * direction.y,
                          vertex.z - along * direction.z};
    double cosine = 1 / distance, sine = sqrt(1 - cosine * cosine);
    double over_tangent = along * cosine + sqrt(vec3_dot(beside, beside)) * sine;
    return over_tangent <= 1 + OCCLUSION_SLACK && along >= size * cosine - OCCLUSION_SLACK;
}

static void check_occlusion(const struct decoded_tile *tile, const struct tile_frame *frame,
                            struct verify_report *report) {
    struct vec3 point = {tile->occlusion[0], tile->occlusion[1], tile->occlusion[2]};
    double distance = sqrt(vec3_dot(point, point));
    uint32_t seen = 0;
    if (frame->profile != PROFILE_GEODETIC) return;
    if (!is_finite_point(tile->occlusion) || distance < 1 - OCCLUSION_SLACK) {
        report_broken(report, PROMISE_OCCLUSION, TILE ": the horizon occlusion point is inside the ellipsoid",
                      TILE_ID(frame));
        return;
    }
    if (distance < 1) distance = 1;
    for (uint32_t i = 0; i < tile->vertex_count && distance < FAR_AWAY; i++) {
        struct vec3 vertex = place_vertex(frame->profile, frame->bounds, tile, i);
        vertex = (struct vec3){vertex.x / WGS84_EQUATOR_M, vertex.y / WGS84_EQUATOR_M, vertex.z / WGS84_POLE_M};
        seen += !is_hidden_with(vertex, point);
    }
    if (seen != 0) {
        report_broken(report, PROMISE_OCCLUSION,
                      TILE ": %" PRIu32 " vertices may be in sight while the horizon occlusion point is not",
                      TILE_ID(frame), seen);
    } else {
        report_held(report, PROMISE_OCCLUSION);
    }
}

/* Is the vertex on this side of the window? */
static bool is_on_side(const struct decoded_tile *tile, const struct tile_frame *frame, uint32_t vertex, int side) {
    switch (side) {
    case EDGE_WEST: return tile->u[vertex] == 0;
    case EDGE_SOUTH: return tile->v[vertex] == 0;
    case EDGE_EAST: return tile->u[vertex] == frame->right;
    default: return tile->v[vertex] == frame->top;
    }
}

static enum scree_status check_edge_lists(struct scree_memory *memory, const struct decoded_tile *tile,
                                          const struct tile_frame *frame, struct verify_report *report,
                                          struct scree_error *error) {
    static const char *const names[EDGE_COUNT] = {"western", "southern", "eastern", "northern"};
    uint8_t *listed = scree_allocate(memory, tile->vertex_count, 1, "marks of border vertices", error);
    if (listed == NULL) return error->status;
    for (int side = 0; side < EDGE_COUNT; side++) {
        uint8_t bit = (uint8_t)(1 << side);
        uint32_t twice = 0, foreign = 0, missing = 0;
        for (uint32_t i = 0; i < tile->edge_count[side]; i++) {
            uint32_t vertex = tile->edges[side][i];
            twice += (listed[vertex] & bit) != 0;
            foreign += !is_on_side(tile, frame, vertex, side);
            listed[vertex] |= bit;
        }
        for (uint32_t i = 0; i < tile->vertex_count; i++)
            missing += is_on_side(tile, frame, i, side) && (listed[i] & bit) == 0;
        if (twice + foreign + missing != 0) {
            report_broken(report, PROMISE_EDGE_LISTS,
                          TILE ": the %s edge list lacks %" PRIu32 " vertices, has %" PRIu32
                               " that are not there and %" PRIu32 " twice",
                          TILE_ID(frame), names[side], missing, foreign, twice);
        } else {
            report_held(report, PROMISE_EDGE_LISTS);
        }
    }
    scree_release(memory, listed);
    return SCREE_OK;
}

static enum scree_status check_plane(struct scree_memory *memory, const struct decoded_tile *tile,
                                     const struct tile_frame *frame, struct verify_report *report,
                                     struct scree_error *error) {
    struct cover_result cover;
    enum scree_status status = cover_check(memory, tile, frame->right, frame->top, &cover, error);
    if (status != SCREE_OK) return status;
    if (cover.flat_triangles != 0 || cover.flipped_triangles != 0) {
        report_broken(report, PROMISE_ORIENTATION, TILE ": %" PRIu32 " triangles of no area, %" PRIu32 " upside down",
                      TILE_ID(frame), cover.flat_triangles, cover.flipped_triangles);
    } else {
        report_held(report, PROMISE_ORIENTATION);
    }
    if (cover.is_exact) {
        report_held(report, PROMISE_COVER);
    } else {
        report_broken(report, PROMISE_COVER,
                      TILE ": %" PRIu32 " open edges inside, %" PRIu32 " edges used twice, %" PRIu32 " walls, %" PRIu32
                           " vertices outside; area %.6f of the tile's",
                      TILE_ID(frame), cover.open_edges, cover.repeated_edges, cover.walls, cover.outside_vertices,
                      (double)cover.double_area / (2.0 * frame->right * frame->top));
    }
    return SCREE_OK;
}

enum scree_status verify_tile(struct scree_memory *memory, const struct decoded_tile *tile,
                              const struct tile_frame *frame, struct verify_report *report, struct scree_error *error) {
    check_vertices(tile, frame, report);
    check_header(tile, frame, report);
    check_occlusion(tile, frame, report);
    enum scree_status status = check_edge_lists(memory, tile, frame, report, error);
    if (status != SCREE_OK) return status;
    return check_plane(memory, tile, frame, report, error);
}
