#include "lod/extremes.h"

static inline void widen(struct sample *pair, struct sample sample) {
    if (sample.height_m < pair[0].height_m) pair[0] = sample;
    if (sample.height_m > pair[1].height_m) pair[1] = sample;
}

static inline int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

void extremes_from_posts(const float *heights_m, int32_t stride, int32_t columns, int32_t rows,
                         struct sample *extremes) {
    for (int32_t y = 0; y < rows; y += 2)
        for (int32_t x = 0; x < columns; x += 2, extremes += 2) {
            extremes[0] = extremes[1] = (struct sample){x, y, heights_m[(int64_t)y * stride + x]};
            for (int32_t j = y; j <= least(y + 2, rows); j++)
                for (int32_t i = x; i <= least(x + 2, columns); i++)
                    widen(extremes, (struct sample){i, j, heights_m[(int64_t)j * stride + i]});
        }
}

void extremes_reduce(const struct sample *fine, int32_t fine_columns, int32_t fine_rows, struct sample *extremes) {
    for (int32_t row = 0; row < fine_rows; row += 2)
        for (int32_t column = 0; column < fine_columns; column += 2, extremes += 2) {
            extremes[0] = fine[2 * ((int64_t)row * fine_columns + column)];
            extremes[1] = extremes[0];
            for (int32_t j = row; j < least(row + 2, fine_rows); j++)
                for (int32_t i = column; i < least(column + 2, fine_columns); i++)
                    for (int k = 0; k < 2; k++) widen(extremes, fine[2 * ((int64_t)j * fine_columns + i) + k]);
        }
}

void extremes_place(const struct sample *child, int32_t child_columns, int32_t child_rows, int32_t column, int32_t row,
                    int32_t x, int32_t y, struct sample *extremes, int32_t columns) {
    for (int32_t j = 0; j < child_rows; j++)
        for (int32_t i = 0; i < child_columns; i++)
            for (int k = 0; k < 2; k++) {
                struct sample sample = child[2 * ((int64_t)j * child_columns + i) + k];
                sample.x += x;
                sample.y += y;
                extremes[2 * ((int64_t)(row + j) * columns + column + i) + k] = sample;
            }
}
