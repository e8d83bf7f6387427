/* The recursive subdivision of squares: see the header. */
#include "lod/square_subdivision.h"

#include "lod/square.h"

#include <stddef.h>

struct subdivision {
    const float *heights_m;
    int32_t columns, rows;
    float epsilon_m;
};

static bool is_flat(const struct subdivision *all, int32_t west, int32_t south, int32_t side) {
    const size_t columns = (size_t)all->columns;
    const float *first_m = all->heights_m + (size_t)south * columns + west, *last_m = first_m + (size_t)side * columns;
    const struct square square = square_of(first_m[0], first_m[side], last_m[0], last_m[side]);
    const float step = 1 / (float)side;
    for (int32_t y = 0; y <= side; y++) {
        const float *row_m = first_m + (size_t)y * columns;
        for (int32_t x = 0; x <= side; x++)
            if (fabsf(square_height_m(&square, (float)x * step, (float)y * step) - row_m[x]) > all->epsilon_m)
                return false;
    }
    return true;
}

/* At most as deep as SUBDIVISION_CELLS can be halved. */
static uint64_t count(const struct subdivision *all, int32_t west, int32_t south, int32_t side) {
    const int32_t wide = all->columns - 1 - west, high = all->rows - 1 - south;
    if (wide <= 0 || high <= 0) return 0;
    if (side == 1 || (side <= wide && side <= high && is_flat(all, west, south, side))) return 2;
    const int32_t half = side / 2;
    return count(all, west, south, half) + count(all, west + half, south, half) + count(all, west, south + half, half) +
           count(all, west + half, south + half, half);
}

uint64_t subdivision_triangles(const float *heights_m, int32_t columns, int32_t rows, double epsilon_m) {
    const struct subdivision all = {heights_m, columns, rows, (float)epsilon_m};
    uint64_t triangles = 0;
    for (int32_t y = 0; y < rows - 1; y += SUBDIVISION_CELLS)
        for (int32_t x = 0; x < columns - 1; x += SUBDIVISION_CELLS) triangles += count(&all, x, y, SUBDIVISION_CELLS);
    return triangles;
}
