/* quantized-mesh tiles made by the tests themselves: a regular grid that a test may spoil before it is encoded. */
#ifndef SCREE_TESTS_TILE_MAKER_H
#define SCREE_TESTS_TILE_MAKER_H

#include "src/lattice.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct tile_recipe {
    double center_m[3];
    float height_min_m, height_max_m;
    double sphere_center_m[3], sphere_radius_m;
    double occlusion[3];
    uint32_t vertex_count, triangle_count;
    uint16_t *u, *v, *h;
    uint32_t *corners;
    uint32_t edge_count[4];
    uint32_t *edges[4]; /* west, south, east, north; any order */
    uint8_t *normals;   /* 2 a vertex, or NULL */
};

/* A grid of cells x cells squares over codes 0..right and 0..top, two triangles each; flat at height code 0, with
 * heights from -100 m to -100 + 32767 / 16 m. Room for one more vertex and two more triangles. */
struct tile_recipe tile_recipe_grid(int cells, uint16_t right, uint16_t top);

/* Height codes from a function of the place in the plane (the tile's bounds: west, south, east, north), so that
 * neighbours agree. */
void tile_recipe_relief(struct tile_recipe *recipe, const double bounds[4]);

/* Centre, bounding sphere and horizon occlusion point for the vertices as they are. */
void tile_recipe_header(struct tile_recipe *recipe, enum profile profile, const double bounds[4]);

/* The bytes, malloc'd; vertices are renumbered in the order of their first use, unused ones last. */
unsigned char *tile_recipe_encode(const struct tile_recipe *recipe, size_t *size_bytes);

void tile_recipe_free(struct tile_recipe *recipe);

/* gzip'd, malloc'd. */
unsigned char *tile_gzip(const unsigned char *bytes, size_t size_bytes, size_t *gzip_bytes);

/* The folder of real data, or NULL after a line that says that the test is skipped. */
const char *tile_test_data(const char *test);

#endif
