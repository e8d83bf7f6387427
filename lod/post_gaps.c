/* Gaps in rows of heights: see the header. */
#include "lod/post_gaps.h"

#include <stddef.h>
#include <string.h>

/* false: the row has no height. */
static bool fill_row(float *row_m, const uint8_t *is_gap, int32_t columns) {
    int32_t before = -1;
    for (int32_t x = 0; x < columns; x++) {
        if (is_gap[x]) continue;
        for (int32_t i = before + 1; i < x; i++) {
            const float share = (float)(i - before) / (float)(x - before);
            row_m[i] = before < 0 ? row_m[x] : row_m[before] + share * (row_m[x] - row_m[before]);
        }
        before = x;
    }
    for (int32_t i = before + 1; i < columns && before >= 0; i++) row_m[i] = row_m[before];
    return before >= 0;
}

/* Rows after `before` and before `next` have nothing yet; either may be missing (-1, rows). */
static void fill_rows(float *heights_m, int32_t columns, int32_t before, int32_t next, int32_t rows) {
    for (int32_t y = before + 1; y < next; y++) {
        const bool is_southern = before >= 0 && (next == rows || y - before <= next - y);
        memcpy(heights_m + (size_t)y * (size_t)columns,
               heights_m + (size_t)(is_southern ? before : next) * (size_t)columns,
               (size_t)columns * sizeof *heights_m);
    }
}

bool post_gaps_fill(float *heights_m, const uint8_t *is_gap, int32_t columns, int32_t rows) {
    int32_t before = -1;
    for (int32_t y = 0; y < rows; y++) {
        const size_t first = (size_t)y * (size_t)columns;
        if (!fill_row(heights_m + first, is_gap + first, columns)) continue;
        fill_rows(heights_m, columns, before, y, rows);
        before = y;
    }
    if (before >= 0) fill_rows(heights_m, columns, before, rows, rows);
    return before >= 0;
}
