/* A city's ground: see the header. */
#include "tests/city_maker.h"

#include "lod/context_filter.h"
#include "tests/fractal.h"

#include <math.h>
#include <string.h>

/* All in posts. */
#define ROAD_Y        330.0
#define ROAD_HALF     4.0
#define BRIDGE_HALF   18.0
#define RAMP_END      80.0
#define RIVER_HALF    9.0
#define RAILS_HALF    8.0
#define WOOD_X        480.0
#define WOOD_Y        130.0
#define WOOD_RADIUS   70.0
#define WOOD_CORNERS  360
#define RAILS_REACH   700.0
#define FULL_TURN_RAD 6.283185307179586

static double river_x(double y) {
    return 200 + 30 * sin(y / 60);
}

/* 1 within `half` posts, 0 beyond `half + slope`. */
static double shelf(double distance, double half, double slope) {
    return fmin(fmax(1 - (distance - half) / slope, 0), 1);
}

static double height_m(int32_t x, int32_t y, double roughness, uint8_t *use) {
    const double river = fabs(x - river_x(y)), rails = fabs(0.6 * x + 0.8 * y - 480);
    const double road = fabs(y - ROAD_Y), bridge = fabs(x - river_x(ROAD_Y));
    const double heap = hypot(x - 500, y - 470), wood = hypot(x - WOOD_X, y - WOOD_Y);
    double z = 30 + 1.5 * sin(x / 70.0) * cos(y / 90.0);
    z += 25 * shelf(heap, 25, 30) + fmin(roughness, 1) * 0.5 * shelf(heap, 40, 10);
    z += 6 * shelf(wood, 20, 60) + 0.6 * roughness * shelf(wood, WOOD_RADIUS, 4);
    if (wood < WOOD_RADIUS) *use |= GROUND_FOREST;
    z += (36 - z) * shelf(rails, 3, 5);
    if (rails < RAILS_HALF) *use |= GROUND_RAILWAY;
    z += (27 - z) * shelf(river, 8, 5);
    if (river < RIVER_HALF) *use |= GROUND_WATER;
    const double deck_m = 30 + 6 * shelf(bridge, BRIDGE_HALF, 60);
    z += (fmax(deck_m, z) - z) * shelf(road, 3, 2);
    if (road < ROAD_HALF && bridge < BRIDGE_HALF) *use = GROUND_BRIDGE;
    if (road < ROAD_HALF && bridge >= BRIDGE_HALF && bridge < RAMP_END) *use |= GROUND_RAMP;
    return z + 0.12 * roughness;
}

void city_make(uint64_t seed, float *heights_m, uint8_t *uses) {
    const struct fractal fractal = {.seed = seed};
    memset(uses, 0, CITY_POSTS);
    for (int32_t y = 0; y < CITY_SIDE; y++) {
        float row_m[CITY_SIDE];
        fractal_window(&fractal, 0, y, CITY_SIDE, 1, row_m, CITY_SIDE);
        for (int32_t x = 0; x < CITY_SIDE; x++) {
            /* The fractal's finest octaves only: how far a post is from the mean of its neighbours. */
            const double west_m = row_m[x > 0 ? x - 1 : x], east_m = row_m[x + 1 < CITY_SIDE ? x + 1 : x];
            const double roughness = fmax(fmin(row_m[x] - (west_m + east_m) / 2, 2), -2);
            const size_t post = (size_t)y * CITY_SIDE + (size_t)x;
            heights_m[post] = (float)height_m(x, y, roughness, &uses[post]);
        }
    }
}

/* ---- outlines ---- */

static void add(struct city_outline *outline, double x, double y) {
    outline->corners[outline->count][0] = x;
    outline->corners[outline->count++][1] = y;
}

static void add_rectangle(struct city_outline *outline, double west, double east) {
    add(outline, west, ROAD_Y - ROAD_HALF);
    add(outline, east, ROAD_Y - ROAD_HALF);
    add(outline, east, ROAD_Y + ROAD_HALF);
    add(outline, west, ROAD_Y + ROAD_HALF);
}

static void add_river(struct city_outline *outline) {
    for (int y = -1; y <= CITY_SIDE; y++) add(outline, river_x(y) + RIVER_HALF, y);
    for (int y = CITY_SIDE; y >= -1; y--) add(outline, river_x(y) - RIVER_HALF, y);
}

/* Along 0.6 x + 0.8 y = 480. */
static void add_rails(struct city_outline *outline) {
    for (int corner = 0; corner < 4; corner++) {
        const double along = corner == 0 || corner == 3 ? -RAILS_REACH : RAILS_REACH;
        const double half = RAILS_HALF - 0.01; /* posts just on the edge are outside */
        const double across = corner < 2 ? -half : half;
        add(outline, 0.6 * (480 + across) + 0.8 * along, 0.8 * (480 + across) - 0.6 * along);
    }
}

static void add_wood(struct city_outline *outline) {
    for (int i = 0; i < WOOD_CORNERS; i++) {
        const double angle_rad = FULL_TURN_RAD * i / WOOD_CORNERS;
        add(outline, WOOD_X + WOOD_RADIUS * cos(angle_rad), WOOD_Y + WOOD_RADIUS * sin(angle_rad));
    }
}

void city_outline(int which, struct city_outline *outline) {
    static const uint8_t uses[CITY_OUTLINES] = {GROUND_WATER, GROUND_RAILWAY, GROUND_BRIDGE,
                                                GROUND_RAMP,  GROUND_RAMP,    GROUND_FOREST};
    const double bridge_x = river_x(ROAD_Y);
    outline->use = uses[which];
    outline->count = 0;
    switch (which) {
    case 0: add_river(outline); break;
    case 1: add_rails(outline); break;
    case 2: add_rectangle(outline, bridge_x - BRIDGE_HALF, bridge_x + BRIDGE_HALF); break;
    case 3: add_rectangle(outline, bridge_x - RAMP_END, bridge_x - BRIDGE_HALF); break;
    case 4: add_rectangle(outline, bridge_x + BRIDGE_HALF, bridge_x + RAMP_END); break;
    default: add_wood(outline); break;
    }
}
