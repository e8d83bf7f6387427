/* Fractal terrain: gradient noise in octaves, the middle ones folded into ridges. Only integer hashing and + - * on
 * floats, each post by the same operations whatever the window. */
#include "tests/fractal.h"

#include <math.h>

enum { RUN = 256, FIRST_OCTAVE = 12, LAST_OCTAVE = 1, FIRST_RIDGE = 9, LAST_RIDGE = 4 };

/* The strength of each octave, by the logarithm of its wavelength in posts; index 0 is unused. */
static const float amplitude_m[FIRST_OCTAVE + 1] = {0,     2.f,   4.f,   10.f,  50.f,  130.f, 270.f,
                                                    450.f, 600.f, 600.f, 400.f, 500.f, 600.f};

struct gradient {
    float x, y;
};

/* The mixing steps of MurmurHash3's 64-bit finalizer (Austin Appleby, public domain). */
static uint64_t mix(uint64_t h) {
    h ^= h >> 33;
    h *= UINT64_C(0xff51afd7ed558ccd);
    h ^= h >> 33;
    h *= UINT64_C(0xc4ceb9fe1a85ec53);
    return h ^ (h >> 33);
}

static struct gradient gradient_at(uint64_t row_hash, int64_t cell_x) {
    uint64_t h = mix(row_hash + (uint64_t)cell_x * UINT64_C(0x9e3779b97f4a7c15));
    return (struct gradient){(float)(int16_t)(h >> 48) * 0x1p-15f, (float)(int16_t)(h >> 32) * 0x1p-15f};
}

static float fade(float t) {
    return t * t * t * (t * (t * 6.f - 15.f) + 10.f);
}

/* One octave of noise, about -0.7 to 0.7, for `count` posts of a row. */
static void noise_row(uint64_t seed, int octave, int64_t x, int64_t y, int32_t count, float *noise) {
    /* Every octave has an origin of its own: lattice lines that coincide would show as a grid. */
    const uint64_t origin = mix(seed + (uint64_t)octave * UINT64_C(0x9e3779b97f4a7c15));
    x += (int64_t)(origin & 0xffffff);
    y += (int64_t)(origin >> 40);
    const int64_t span = INT64_C(1) << octave;
    const float step = 1.f / (float)span;
    const int64_t cell_y = y >> octave;
    const uint64_t south_hash = mix(seed ^ mix((uint64_t)cell_y * 64 + (uint64_t)octave));
    const uint64_t north_hash = mix(seed ^ mix((uint64_t)(cell_y + 1) * 64 + (uint64_t)octave));
    const float ty = (float)(y - cell_y * span) * step, fy = fade(ty);

    int64_t cell_x = x >> octave;
    struct gradient sw = gradient_at(south_hash, cell_x), nw = gradient_at(north_hash, cell_x);
    for (int32_t i = 0; i < count; cell_x++) {
        struct gradient se = gradient_at(south_hash, cell_x + 1), ne = gradient_at(north_hash, cell_x + 1);
        /* Blended to the row, the two western corners give a linear function of tx, and so do the eastern ones. */
        float west_slope = sw.x + fy * (nw.x - sw.x), east_slope = se.x + fy * (ne.x - se.x);
        float west = sw.y * ty + fy * (nw.y * (ty - 1.f) - sw.y * ty);
        float east = se.y * ty + fy * (ne.y * (ty - 1.f) - se.y * ty);
        int32_t offset = (int32_t)(x + i - cell_x * span);
        int32_t end = (int32_t)span - offset < count - i ? i + (int32_t)span - offset : count;
        for (; i < end; i++, offset++) {
            float tx = (float)offset * step;
            float from_west = west + west_slope * tx, from_east = east + east_slope * (tx - 1.f);
            noise[i] = from_west + fade(tx) * (from_east - from_west);
        }
        sw = se;
        nw = ne;
    }
}

static float clamp(float value, float least, float most) {
    return value < least ? least : value > most ? most : value;
}

/* Plain octaves first: their sum also says how mountainous a place is. Then ridges, each octave strongest where the one
 * before it was high (Musgrave's ridged multifractal). The finest octaves are plain again, stronger in the mountains.
 */
static void height_row(const struct fractal *fractal, int64_t x, int64_t y, int32_t count, float *heights_m) {
    float noise[RUN], rugged[RUN], weight[RUN];
    for (int32_t i = 0; i < count; i++) {
        heights_m[i] = 700.f;
        rugged[i] = 0.6f;
    }
    for (int octave = FIRST_OCTAVE; octave > FIRST_RIDGE; octave--) {
        noise_row(fractal->seed, octave, x, y, count, noise);
        for (int32_t i = 0; i < count; i++) {
            heights_m[i] += amplitude_m[octave] * noise[i];
            rugged[i] += 0.8f * noise[i];
        }
    }
    for (int32_t i = 0; i < count; i++) {
        rugged[i] = clamp(rugged[i], 0.02f, 1.f);
        weight[i] = rugged[i];
    }
    for (int octave = FIRST_RIDGE; octave >= LAST_RIDGE; octave--) {
        noise_row(fractal->seed, octave, x, y, count, noise);
        for (int32_t i = 0; i < count; i++) {
            float ridge = 1.f - 2.f * (noise[i] < 0 ? -noise[i] : noise[i]);
            heights_m[i] += amplitude_m[octave] * weight[i] * ridge;
            weight[i] = rugged[i] * clamp(0.4f + 0.8f * ridge, 0.1f, 1.f);
        }
    }
    for (int octave = LAST_RIDGE - 1; octave >= LAST_OCTAVE; octave--) {
        noise_row(fractal->seed, octave, x, y, count, noise);
        for (int32_t i = 0; i < count; i++) heights_m[i] += amplitude_m[octave] * 2.f * rugged[i] * noise[i];
    }
    for (int32_t i = 0; i < count; i++) heights_m[i] = clamp(heights_m[i], -500.f, 4500.f);
    if (fractal->whole_metres)
        for (int32_t i = 0; i < count; i++) heights_m[i] = floorf(heights_m[i] + 0.5f);
}

void fractal_window(const struct fractal *fractal, int64_t x, int64_t y, int32_t columns, int32_t rows,
                    float *heights_m, int32_t stride) {
    for (int32_t row = 0; row < rows; row++)
        for (int32_t column = 0; column < columns; column += RUN) {
            int32_t count = columns - column < RUN ? columns - column : RUN;
            height_row(fractal, x + column, y + row, count, heights_m + (int64_t)row * stride + column);
        }
}
