/* Pictures of meshes: see the header. A depth buffer with a few samples a pixel; an edge is what lies within half its
 * width of a triangle's border. */
#include "src/mesh_picture.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define SAMPLES_A_PX  3 /* each way */
#define MARGIN        0.03
#define EDGE_PX       0.9
#define LEAST_EDGE_PX 5.0  /* shorter ones on average, and no edges are drawn */
#define LEAST_RELIEF  0.18 /* of the width */
#define EYE_WIDTHS    2.2  /* how far away the eye is */
#define EYE_TURN      0.42 /* radians to the west of south */
#define EYE_RISE      0.61 /* radians above the horizon */
#define EDGE_DARKNESS 0.55
#define LEAST_LIGHT   0.25

/* A point on the canvas: samples to the right and down, and how far it is from the eye. */
struct spot {
    double x, y, depth;
};

struct canvas {
    int32_t side; /* samples a view */
    float *depth; /* side rows of 2 * side */
    uint8_t *light, *edge;
    struct spot *spots; /* the vertices in the view that is drawn */
    struct vector3 low, high;
    double exaggeration;
    const struct space_mesh *mesh;
};

/* ---- the views ---- */

static void find_extent(struct canvas *canvas) {
    const struct space_mesh *mesh = canvas->mesh;
    struct vector3 low = mesh->vertices_m[mesh->corners[0]], high = low;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) {
        struct vector3 v = mesh->vertices_m[mesh->corners[i]];
        low = (struct vector3){fmin(low.x, v.x), fmin(low.y, v.y), fmin(low.z, v.z)};
        high = (struct vector3){fmax(high.x, v.x), fmax(high.y, v.y), fmax(high.z, v.z)};
    }
    double width_m = fmax(high.x - low.x, high.y - low.y), relief_m = high.z - low.z;
    canvas->low = low;
    canvas->high = high;
    canvas->exaggeration = relief_m > 0 ? fmax(1, LEAST_RELIEF * width_m / relief_m) : 1;
}

static void look_from_above(struct canvas *canvas) {
    for (uint32_t i = 0; i < canvas->mesh->vertex_count; i++) {
        struct vector3 v = canvas->mesh->vertices_m[i];
        canvas->spots[i] = (struct spot){v.x, -v.y, -v.z};
    }
}

static void look_from_the_south(struct canvas *canvas) {
    struct vector3 low = canvas->low, high = canvas->high;
    double away_m = EYE_WIDTHS * fmax(high.x - low.x, high.y - low.y);
    for (uint32_t i = 0; i < canvas->mesh->vertex_count; i++) {
        struct vector3 v = canvas->mesh->vertices_m[i];
        double x = v.x - (low.x + high.x) / 2, y = v.y - (low.y + high.y) / 2;
        double z = (v.z - (low.z + high.z) / 2) * canvas->exaggeration;
        double right = x * cos(EYE_TURN) - y * sin(EYE_TURN), back = x * sin(EYE_TURN) + y * cos(EYE_TURN);
        double up = z * cos(EYE_RISE) + back * sin(EYE_RISE), depth = back * cos(EYE_RISE) - z * sin(EYE_RISE);
        double scale = away_m > 0 ? away_m / fmax(away_m + depth, 0.01 * away_m) : 1;
        canvas->spots[i] = (struct spot){right * scale, -up * scale, depth};
    }
}

/* Moves the view into its square. */
static void fit(struct canvas *canvas, int32_t left) {
    const struct space_mesh *mesh = canvas->mesh;
    struct spot low = canvas->spots[mesh->corners[0]], high = low;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) {
        struct spot s = canvas->spots[mesh->corners[i]];
        low = (struct spot){fmin(low.x, s.x), fmin(low.y, s.y), 0};
        high = (struct spot){fmax(high.x, s.x), fmax(high.y, s.y), 0};
    }
    double extent = fmax(high.x - low.x, high.y - low.y);
    double scale = extent > 0 ? canvas->side * (1 - 2 * MARGIN) / extent : 1;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct spot *s = &canvas->spots[i];
        s->x = left + canvas->side / 2.0 + (s->x - (low.x + high.x) / 2) * scale;
        s->y = canvas->side / 2.0 + (s->y - (low.y + high.y) / 2) * scale;
    }
}

/* ---- triangles ---- */

/* Lambert's law with light from the north-west, 45 degrees high. */
static double light_of(const struct canvas *canvas, const struct vector3 v[3]) {
    struct vector3 ab = vector3_minus(v[1], v[0]), ac = vector3_minus(v[2], v[0]);
    ab.z *= canvas->exaggeration;
    ac.z *= canvas->exaggeration;
    struct vector3 normal = {ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x};
    double length = sqrt(vector3_dot(normal, normal));
    double towards = length > 0 ? (-0.5 * normal.x + 0.5 * normal.y + sqrt(0.5) * normal.z) / length : 0;
    return LEAST_LIGHT + (1 - LEAST_LIGHT) * fmax(0, towards);
}

static double edge_length(struct spot a, struct spot b) {
    return hypot(b.x - a.x, b.y - a.y);
}

static void draw_triangle(struct canvas *canvas, const struct spot s[3], double light, double edge_width) {
    double area2 = (s[1].x - s[0].x) * (s[2].y - s[0].y) - (s[1].y - s[0].y) * (s[2].x - s[0].x);
    if (area2 == 0) return;
    int32_t last = canvas->side - 1, across = 2 * canvas->side;
    int32_t top = (int32_t)fmax(0, ceil(fmin(s[0].y, fmin(s[1].y, s[2].y))));
    int32_t bottom = (int32_t)fmin(last, floor(fmax(s[0].y, fmax(s[1].y, s[2].y))));
    int32_t left = (int32_t)fmax(0, ceil(fmin(s[0].x, fmin(s[1].x, s[2].x))));
    int32_t right = (int32_t)fmin(across - 1, floor(fmax(s[0].x, fmax(s[1].x, s[2].x))));
    for (int32_t y = top; y <= bottom; y++)
        for (int32_t x = left; x <= right; x++) {
            double weight[3], depth = 0;
            bool is_edge = false, is_in = true;
            for (int k = 0; k < 3; k++) {
                const struct spot *a = &s[(k + 1) % 3], *b = &s[(k + 2) % 3];
                weight[k] = ((b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x)) / area2;
                if (weight[k] < 0) is_in = false;
                if (weight[k] * fabs(area2) < edge_width * edge_length(*a, *b)) is_edge = true;
                depth += weight[k] * s[k].depth;
            }
            size_t at = (size_t)y * (size_t)across + (size_t)x;
            if (!is_in || (float)depth >= canvas->depth[at]) continue;
            canvas->depth[at] = (float)depth;
            canvas->light[at] = (uint8_t)(255 * light);
            canvas->edge[at] = is_edge;
        }
}

/* Half the width of edges in samples; 0 where triangles are too small for them. */
static double edge_width_of(const struct canvas *canvas) {
    const struct space_mesh *mesh = canvas->mesh;
    double pixels = (double)canvas->side / SAMPLES_A_PX;
    bool is_crowded = mesh->triangle_count > 2 * (pixels / LEAST_EDGE_PX) * (pixels / LEAST_EDGE_PX);
    return is_crowded ? 0 : EDGE_PX * SAMPLES_A_PX / 2;
}

static void draw_view(struct canvas *canvas, int32_t left) {
    const struct space_mesh *mesh = canvas->mesh;
    double edge_width = edge_width_of(canvas);
    fit(canvas, left);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        struct vector3 v[3];
        struct spot s[3];
        for (int k = 0; k < 3; k++) {
            uint32_t corner = mesh->corners[3 * (size_t)t + (size_t)k];
            v[k] = mesh->vertices_m[corner];
            s[k] = canvas->spots[corner];
        }
        draw_triangle(canvas, s, light_of(canvas, v), edge_width);
    }
}

/* ---- the picture ---- */

/* The mean of a pixel's samples: rock where a triangle is, white elsewhere. */
static void develop(const struct canvas *canvas, struct mesh_picture *picture) {
    static const double rock[3] = {238, 226, 200};
    size_t across = 2 * (size_t)canvas->side;
    for (uint32_t y = 0; y < picture->height_px; y++)
        for (uint32_t x = 0; x < picture->width_px; x++) {
            double sum[3] = {0, 0, 0};
            for (size_t i = 0; i < SAMPLES_A_PX * SAMPLES_A_PX; i++) {
                size_t at = (y * SAMPLES_A_PX + i / SAMPLES_A_PX) * across + x * SAMPLES_A_PX + i % SAMPLES_A_PX;
                double light = canvas->light[at] / 255.0 * (canvas->edge[at] ? 1 - EDGE_DARKNESS : 1);
                for (int k = 0; k < 3; k++) sum[k] += canvas->depth[at] == HUGE_VALF ? 255 : light * rock[k];
            }
            uint8_t *to = picture->rgb + 3 * ((size_t)y * picture->width_px + x);
            for (int k = 0; k < 3; k++) to[k] = (uint8_t)(sum[k] / (SAMPLES_A_PX * SAMPLES_A_PX) + 0.5);
        }
}

enum scree_status mesh_picture_new(struct scree_memory *memory, const struct space_mesh *mesh, uint32_t side_px,
                                   struct mesh_picture *picture, struct scree_error *error) {
    struct canvas canvas = {.mesh = mesh, .side = (int32_t)(side_px * SAMPLES_A_PX)};
    size_t samples = 2 * (size_t)canvas.side * (size_t)canvas.side;
    memset(picture, 0, sizeof *picture);
    if (side_px < 16 || side_px > 4096)
        return scree_fail(error, SCREE_E_ARGUMENT, "a picture of %u pixels a side cannot be drawn", (unsigned)side_px);
    enum scree_status status = space_mesh_check(mesh, error);
    if (status != SCREE_OK) return status;
    status = SCREE_E_MEMORY;
    canvas.depth = scree_allocate(memory, samples, sizeof *canvas.depth, "a picture", error);
    canvas.light = scree_allocate(memory, samples, 1, "a picture", error);
    canvas.edge = scree_allocate(memory, samples, 1, "a picture", error);
    canvas.spots = scree_allocate(memory, mesh->vertex_count, sizeof *canvas.spots, "a picture", error);
    picture->rgb = scree_allocate(memory, 6 * (size_t)side_px * side_px, 1, "a picture", error);
    if (canvas.depth == NULL || canvas.light == NULL || canvas.edge == NULL || canvas.spots == NULL ||
        picture->rgb == NULL)
        goto cleanup;
    picture->width_px = 2 * side_px;
    picture->height_px = side_px;
    for (size_t i = 0; i < samples; i++) canvas.depth[i] = HUGE_VALF;
    find_extent(&canvas);
    look_from_above(&canvas);
    draw_view(&canvas, 0);
    look_from_the_south(&canvas);
    draw_view(&canvas, canvas.side);
    develop(&canvas, picture);
    status = SCREE_OK;
cleanup:
    scree_release(memory, canvas.spots);
    scree_release(memory, canvas.edge);
    scree_release(memory, canvas.light);
    scree_release(memory, canvas.depth);
    if (status != SCREE_OK) mesh_picture_release(memory, picture);
    return status;
}

void mesh_picture_release(struct scree_memory *memory, struct mesh_picture *picture) {
    scree_release(memory, picture->rgb);
    memset(picture, 0, sizeof *picture);
}
