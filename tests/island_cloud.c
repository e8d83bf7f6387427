/* island_cloud: writes lidar-like points of a made-up coral island with its reef, as text (.xyz) or as a LAS 1.2 file:
 * what Ai et al. 2019 had of Yanzhi island (21,134 points, 5.5 m apart in the mean, 0.3 square kilometres of land).
 *
 * A square of 803 m: a cay with beaches, storm berm, scrub and a hollow; around it a reef flat with boulders and an
 * algal ridge where the waves come from; a lagoon with knolls in the lee, a pass and a dredged channel through the rim;
 * a fore-reef of spurs and grooves down to a terrace and the deep. Only + - * / and square roots: the same bytes on
 * every machine. */
#include "lod/counter_random.h"
#include "tests/las_maker.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE_M         803.0 /* of the square */
#define EAST_M         607000.0
#define NORTH_M        1868000.0
#define EPSG           32649
#define SENSOR_NOISE_M 0.05
#define DEEPEST_M      -28.0 /* a level floor */

enum seed {
    SEED_POINT = 1,
    SEED_GAP,
    SEED_SHORE,
    SEED_RIM,
    SEED_LAND,
    SEED_SCRUB,
    SEED_FLAT,
    SEED_KNOLL,
    SEED_SPUR,
    SEED_BLOCK
};

static const char help[] = "Usage: island_cloud -o FILE.xyz|FILE.las [--points N]\n"
                           "Writes N (21134) lidar-like points of a coral island and its reef, 803 m square, in\n"
                           "EPSG:32649, with heights above sea level.\n";

static double clamp(double value, double least, double most) {
    return value < least ? least : value > most ? most : value;
}

/* 0 up to `from`, 1 from `to` on, smooth between. */
static double step_between(double from, double to, double value) {
    double t = clamp((value - from) / (to - from), 0, 1);
    return t * t * (3 - 2 * t);
}

static double mix(double a, double b, double part) {
    return a + part * (b - a);
}

/* ---- noise ---- */

static double random_unit(uint64_t seed, uint64_t counter) {
    return (double)(counter_random(seed, counter) >> 11) * 0x1p-53;
}

/* What a corner of the noise's lattice adds at (x, y) from it: a slope of its own. */
static double slope_at(enum seed seed, int64_t column, int64_t row, double x, double y) {
    uint64_t counter = 2 * ((uint64_t)(row + 4096) * 8192 + (uint64_t)(column + 4096));
    double slope_x = 2 * random_unit((uint64_t)seed, counter) - 1;
    double slope_y = 2 * random_unit((uint64_t)seed, counter + 1) - 1;
    return slope_x * x + slope_y * y;
}

/* Gradient noise, about -1 to 1, of waves about `wave_m` long. */
static double noise(enum seed seed, double wave_m, double x_m, double y_m) {
    double x = x_m / wave_m, y = y_m / wave_m;
    int64_t column = (int64_t)floor(x), row = (int64_t)floor(y);
    double u = x - (double)column, v = y - (double)row, across = step_between(0, 1, u), up = step_between(0, 1, v);
    double south = mix(slope_at(seed, column, row, u, v), slope_at(seed, column + 1, row, u - 1, v), across);
    double north =
        mix(slope_at(seed, column, row + 1, u, v - 1), slope_at(seed, column + 1, row + 1, u - 1, v - 1), across);
    return 1.7 * mix(south, north, up);
}

/* Three octaves, the finer ones weaker and turned. */
static double rough(enum seed seed, double wave_m, double x_m, double y_m) {
    double turned_x = 0.8 * x_m + 0.6 * y_m, turned_y = 0.8 * y_m - 0.6 * x_m;
    return 0.62 * noise(seed, wave_m, x_m, y_m) + 0.31 * noise(seed, wave_m / 2, turned_x, turned_y) +
           0.18 * noise(seed, wave_m / 4, x_m + 77, y_m + 33);
}

static double distance(double x, double y) {
    return sqrt(x * x + y * y);
}

/* Round humps from 0 to 1, one somewhere in each square cell with sides of `cell_m`, with a radius of up to a third of
 * it; `share` of the cells have one. */
static double humps(enum seed seed, double cell_m, double share, double x_m, double y_m) {
    int64_t column = (int64_t)floor(x_m / cell_m), row = (int64_t)floor(y_m / cell_m);
    double highest = 0;
    for (int64_t r = row - 1; r <= row + 1; r++)
        for (int64_t c = column - 1; c <= column + 1; c++) {
            uint64_t counter = 4 * ((uint64_t)(r + 4096) * 8192 + (uint64_t)(c + 4096));
            if (random_unit((uint64_t)seed, counter) >= share) continue;
            double middle_x = ((double)c + random_unit((uint64_t)seed, counter + 1)) * cell_m;
            double middle_y = ((double)r + random_unit((uint64_t)seed, counter + 2)) * cell_m;
            double radius_m = cell_m / 3 * (0.4 + 0.6 * random_unit((uint64_t)seed, counter + 3));
            highest = fmax(highest, 1 - step_between(0.3, 1, distance(x_m - middle_x, y_m - middle_y) / radius_m));
        }
    return highest;
}

/* ---- the shapes, as distances ---- */

/* What the island is made of, at one place. */
struct place {
    double x_m, y_m;
    double inland_m;  /* from the waterline, positive on land */
    double inside_m;  /* from the reef's rim, positive within */
    double lagoon;    /* 0 outside, 1 in its middle */
    double windward;  /* 0 in the lee, 1 where the waves come from: the south-east */
    double channel_m; /* from the middle of the nearest channel */
};

/* About the distance from an ellipse's line, positive inside. */
static double ellipse(double x_m, double y_m, double half_x_m, double half_y_m) {
    double r = distance(x_m / half_x_m, y_m / half_y_m);
    return (1 - r) * sqrt(half_x_m * half_y_m);
}

static double from_segment(double x, double y, const double a[2], const double b[2]) {
    double dx = b[0] - a[0], dy = b[1] - a[1];
    double t = clamp(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy), 0, 1);
    return distance(x - a[0] - t * dx, y - a[1] - t * dy);
}

/* The lesser of two distances, its corner rounded over `round_m`. */
static double least_of(double a_m, double b_m, double round_m) {
    double part = clamp(0.5 + (b_m - a_m) / (2 * round_m), 0, 1);
    return mix(b_m, a_m, part) - round_m * part * (1 - part);
}

static struct place place_at(double x_m, double y_m) {
    static const double pass[3][2] = {{235, 600}, {180, 690}, {80, 790}}, dredged[2][2] = {{430, 175}, {450, -20}};
    struct place place = {.x_m = x_m, .y_m = y_m};
    double bend_x = 34 * rough(SEED_SHORE, 170, x_m, y_m), bend_y = 34 * rough(SEED_SHORE, 170, x_m + 900, y_m);
    double land_m = ellipse(x_m - 425 + bend_x, y_m - 375 + bend_y, 355, 272);
    double bay_m = ellipse(x_m - 245 + bend_x, y_m - 600 + bend_y, 190, 125);
    place.inland_m = least_of(land_m, -bay_m, 45);
    place.inside_m = ellipse(x_m - 405 + 45 * rough(SEED_RIM, 150, x_m, y_m), y_m - 400, 405, 385);
    place.lagoon = step_between(-15, 60, bay_m) * step_between(5, 45, place.inside_m);
    place.windward = step_between(-250, 250, 0.75 * (x_m - 400) - 0.65 * (y_m - 400));
    double wander = 10 * noise(SEED_RIM, 60, x_m, y_m);
    double by_pass_m =
        fmin(from_segment(x_m + wander, y_m, pass[0], pass[1]), from_segment(x_m + wander, y_m, pass[1], pass[2]));
    place.channel_m = fmin(by_pass_m, 1.6 * from_segment(x_m, y_m, dredged[0], dredged[1]));
    return place;
}

/* ---- heights above sea level ---- */

static double land_height(const struct place *p) {
    double d = p->inland_m;
    double berm_m = 0.8 + 1.1 * p->windward;
    double berm = step_between(14, 30, d) * (1 - step_between(36, 70, d));
    double beach = clamp(d / 11, 0, 2.1);
    double hollow = step_between(95, 160, d + 25 * noise(SEED_LAND, 120, p->x_m, p->y_m));
    double height = beach + berm_m * berm - 1.3 * hollow + 0.5 * rough(SEED_LAND, 70, p->x_m, p->y_m);
    double scrub = step_between(-0.1, 0.35, noise(SEED_SCRUB, 45, p->x_m, p->y_m)) * step_between(28, 50, d);
    return height + scrub * (1.1 + 0.9 * rough(SEED_SCRUB, 14, p->x_m, p->y_m));
}

static double flat_height(const struct place *p) {
    double moat = 1 - step_between(8, 40, -p->inland_m);
    double ridge = p->windward * step_between(-4, 6, p->inside_m) * (1 - step_between(16, 34, p->inside_m));
    double height = -0.9 - 0.5 * moat + 0.75 * ridge + 0.3 * rough(SEED_FLAT, 22, p->x_m, p->y_m);
    /* Boulders that storms have thrown onto the flat, behind the ridge. */
    double bend_x_m = p->x_m + 3 * noise(SEED_BLOCK, 9, p->x_m, p->y_m);
    double blocks = humps(SEED_BLOCK, 24, 0.25 + 0.45 * p->windward, bend_x_m, p->y_m);
    height += (0.6 + 0.7 * p->windward) * blocks * step_between(0, 20, p->inside_m) * step_between(3, 12, -p->inland_m);
    double bottom = -5.5 + 0.5 * rough(SEED_FLAT, 60, p->x_m, p->y_m);
    double knoll = humps(SEED_KNOLL, 60, 0.7, p->x_m + 8 * noise(SEED_KNOLL, 20, p->x_m, p->y_m), p->y_m);
    return mix(height, mix(bottom, -1.2, knoll), p->lagoon);
}

static double fore_reef_height(const struct place *p) {
    double d = -p->inside_m;
    /* Spurs run down the slope: noise over the direction from the middle, not over the distance. */
    double from_middle_m = distance(p->x_m - 405, p->y_m - 400) + 1;
    double along_x = (p->x_m - 405) / from_middle_m * 400, along_y = (p->y_m - 400) / from_middle_m * 400;
    double spur = noise(SEED_SPUR, 17, along_x, along_y) * step_between(0, 15, d) * (1 - step_between(55, 90, d));
    double terrace = d < 45 ? -0.9 - 0.2 * d : -9.9 - 0.04 * (d - 45);
    double drop = 0.42 * clamp(d - 85, 0, 1000);
    return terrace - drop + (1 + p->windward) * spur + 0.5 * rough(SEED_FLAT, 22, p->x_m, p->y_m);
}

static double height_at(double x_m, double y_m) {
    struct place p = place_at(x_m, y_m);
    double sea = mix(fore_reef_height(&p), flat_height(&p), step_between(-6, 6, p.inside_m));
    double cut = 1 - step_between(7, 19, p.channel_m);
    if (p.inland_m < 8 && sea > -6.5) sea = mix(sea, -6.5, cut);
    double height = mix(sea, land_height(&p), step_between(-10, 6, p.inland_m));
    return height > DEEPEST_M ? height : DEEPEST_M + 0.15 * rough(SEED_FLAT, 60, x_m, y_m);
}

/* ---- points ---- */

static struct {
    struct las_point *points;
    uint32_t count;
} cloud;

static struct las_point point_of(uint32_t i) {
    return cloud.points[i];
}

/* One point somewhere in each cell of a square grid, as thinned lidar has it; of the cells, which are a few too many,
 * some at random have none (Knuth, The Art of Computer Programming, vol. 2, algorithm 3.4.2 S). */
static void scatter(uint32_t side) {
    uint64_t cells = (uint64_t)side * side;
    double cell_m = SIDE_M / side;
    uint32_t made = 0;
    for (uint64_t i = 0; i < cells && made < cloud.count; i++) {
        if (random_unit(SEED_GAP, i) * (double)(cells - i) >= cloud.count - made) continue;
        double x_m = cell_m * ((double)(i % side) + random_unit(SEED_POINT, 4 * i));
        double y_m = cell_m * ((double)(i / side) + random_unit(SEED_POINT, 4 * i + 1));
        /* Nearly normal: the sum of two even ones. */
        double error = random_unit(SEED_POINT, 4 * i + 2) + random_unit(SEED_POINT, 4 * i + 3) - 1;
        double height_m = height_at(x_m, y_m);
        cloud.points[made++] = (struct las_point){.x = EAST_M + x_m,
                                                  .y = NORTH_M + y_m,
                                                  .z = height_m + 2.4 * SENSOR_NOISE_M * error,
                                                  .class_number = height_m < 0 ? 40 : 2,
                                                  .return_number = 1,
                                                  .return_count = 1};
    }
}

static bool write_text(FILE *file) {
    bool is_written = true;
    for (uint32_t i = 0; i < cloud.count && is_written; i++)
        is_written = fprintf(file, "%.2f %.2f %.2f\n", cloud.points[i].x, cloud.points[i].y, cloud.points[i].z) > 0;
    return is_written;
}

static bool write_las(FILE *file) {
    struct las_fixture fixture = {.version_minor = 2,
                                  .count = cloud.count,
                                  .point = point_of,
                                  .scale = 0.01,
                                  .offset = {EAST_M, NORTH_M, 0},
                                  .epsg = EPSG};
    size_t size;
    unsigned char *bytes = las_make(&fixture, &size);
    bool is_written = fwrite(bytes, 1, size, file) == size;
    free(bytes);
    return is_written;
}

int main(int argc, char **argv) {
    const char *path = NULL;
    double points = 21134;
    bool is_known = true;
    for (int i = 1; i < argc; i += 2) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(argv[i], "-o") == 0) {
            path = value;
        } else if (strcmp(argv[i], "--points") == 0) {
            points = strtod(value, NULL);
        } else {
            is_known = false;
        }
    }
    size_t length = path != NULL ? strlen(path) : 0;
    bool is_las = length > 4 && strcmp(path + length - 4, ".las") == 0;
    if (!is_known || length == 0 || !(points >= 16 && points <= 1e7)) {
        fputs(help, stderr);
        return 2;
    }
    cloud.count = (uint32_t)points;
    cloud.points = calloc(cloud.count, sizeof *cloud.points);
    if (cloud.points == NULL) return 99;
    scatter((uint32_t)ceil(sqrt(1.008 * cloud.count)));
    FILE *file = fopen(path, "wb");
    bool is_written = file != NULL && (is_las ? write_las(file) : write_text(file));
    is_written = (file == NULL || fclose(file) == 0) && is_written;
    if (!is_written) fprintf(stderr, "island_cloud: %s cannot be written\n", path);
    free(cloud.points);
    return is_written ? 0 : 1;
}
