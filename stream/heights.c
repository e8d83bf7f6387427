#include "stream/heights.h"

#include <math.h>

#define MEMORY      4 /* residuals of earlier increments count as so many */
#define MOST_HEIGHT (1 << 30)

void height_models_start(struct height_models *models) {
    for (int border = 0; border < 2; border++)
        for (int bits = 0; bits <= HEIGHT_BITS; bits++) {
            models->length[border][bits] = bit_model(70);
            for (int node = 0; node < 3; node++) models->mantissa[border][bits][node] = bit_model(50);
        }
    for (int above = 0; above < 4; above++) models->sign[above] = bit_model(50);
}

void height_models_hurry(struct height_models *models) {
    for (int border = 0; border < 2; border++)
        for (int bits = 0; bits <= HEIGHT_BITS; bits++) {
            bit_hurry(&models->length[border][bits], MEMORY);
            for (int node = 0; node < 3; node++) bit_hurry(&models->mantissa[border][bits][node], MEMORY);
        }
}

/* The triangle's plane at a place, less the height there of a first vertex. */
static double plane_at(const struct surface *surface, uint32_t triangle, const struct scree_vertex *at) {
    const uint32_t *vertex = surface->triangles[triangle].vertex;
    const struct scree_vertex *a = &surface->vertices[vertex[0]], *b = &surface->vertices[vertex[1]];
    const struct scree_vertex *c = &surface->vertices[vertex[2]];
    double area2 = (double)surface_area2(a, b, c);
    double of_b = (double)surface_area2(a, at, c) / area2, of_c = (double)surface_area2(a, b, at) / area2;
    return a->height + of_b * ((double)b->height - a->height) + of_c * ((double)c->height - a->height);
}

/* How many of the neighbouring triangles' far corners lie above the triangle's plane. */
static int corners_above(const struct surface *surface, uint32_t triangle) {
    int above = 0;
    for (uint32_t edge = 4 * triangle; edge < 4 * triangle + 3; edge++) {
        uint32_t beyond = surface_twin(surface, edge);
        if (beyond == SURFACE_NONE) continue;
        const struct scree_vertex *far = &surface->vertices[surface_origin(surface, surface_previous(beyond))];
        above += far->height > plane_at(surface, triangle, far);
    }
    return above;
}

/* A number without sign: its length in bits, then the bits behind the first one, the upper two of them learned. */
static uint32_t code_size(struct range_coder *coder, struct height_models *models, bool on_border, uint32_t size) {
    uint32_t bits = 0, value = 1, node = 0;
    while (bits < HEIGHT_BITS && code_bit(coder, &models->length[on_border][bits], size >> bits != 0)) bits++;
    if (bits == 0) return 0;
    for (uint32_t below = bits - 1; below > 0; below--) {
        bool bit = (size >> (below - 1) & 1) != 0;
        if (bits - below <= 2) {
            bit = code_bit(coder, &models->mantissa[on_border][bits][node], bit);
            node = 1 + bit;
        } else {
            bit = code_uniform(coder, 2, bit) != 0;
        }
        value = 2 * value + bit;
    }
    return value;
}

bool height_code(struct range_coder *coder, struct height_models *models, const struct surface *surface,
                 uint32_t triangle, bool on_border, int32_t step, struct scree_vertex *at) {
    int64_t expected = (int64_t)floor(plane_at(surface, triangle, at) / step + 0.5), off = 0;
    if (coder->writing) off = at->height / step - expected;
    uint32_t size = code_size(coder, models, on_border, (uint32_t)(off < 0 ? -off : off));
    if (size != 0) {
        struct bit_model *model = &models->sign[corners_above(surface, triangle)];
        off = code_bit(coder, model, off < 0) ? -(int64_t)size : (int64_t)size;
    } else {
        off = 0;
    }
    int64_t height = (expected + off) * step;
    if (height < -MOST_HEIGHT || height > MOST_HEIGHT) return false;
    at->height = (int32_t)height;
    return true;
}
