/* Lattice posts in triangles: which triangle a post belongs to, how many posts there are, and which one is meant. Pure.
 *
 * Every post of the rectangle that is not a vertex belongs to exactly one triangle. Those on an edge belong to the side
 * on which the edge runs north, or east if it is level; those on the border to the only triangle there is. */
#ifndef SCREE_STREAM_POSTS_H
#define SCREE_STREAM_POSTS_H

#include "stream/range_coder.h"
#include "stream/surface.h"

/* A vertex on its way in. */
struct pending {
    int32_t x, y;
    uint32_t triangle; /* that it lies in now */
    uint32_t next;     /* in the same triangle */
};

/* What is learned about where in triangles vertices come. */
struct post_models {
    struct bit_model row[8], column[8]; /* eighths of a triangle's rows, and of a row */
};
void post_models_start(struct post_models *models);

/* The greatest common divisor; the other number where one is 0. */
uint32_t posts_divisor(uint32_t a, uint32_t b);

/* Whether the post belongs to the triangle. */
bool posts_belong(const struct surface *surface, uint32_t triangle, int32_t x, int32_t y);

/* How many posts belong to it, as far as 65535. */
uint16_t posts_count(const struct surface *surface, uint32_t triangle);

/* Codes the places of `count` vertices, 1 up to the triangle's posts, in ascending order of rows and columns: x and y
 * of each, which are looked at only when writing. False when bytes name what is no such place. */
bool posts_code(struct range_coder *coder, struct post_models *models, const struct surface *surface, uint32_t triangle,
                uint32_t count, struct pending *places);

#endif
