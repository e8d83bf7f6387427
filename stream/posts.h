/* Lattice posts in triangles: which triangle a post belongs to, how many posts there are, and which one is meant. Pure.
 *
 * Every post of the rectangle that is not a vertex belongs to exactly one triangle. Those on an edge belong to the side
 * on which the edge runs north, or east if it is level; those on the border to the only triangle there is. */
#ifndef SCREE_STREAM_POSTS_H
#define SCREE_STREAM_POSTS_H

#include "stream/range_coder.h"
#include "stream/surface.h"

/* What is learned about where in triangles vertices come. */
struct post_models {
    struct bit_model row[8], column[8]; /* eighths of a triangle's rows, and of a row */
};
void post_models_start(struct post_models *models);

/* Whether the post belongs to the triangle. */
bool posts_belong(const struct surface *surface, uint32_t triangle, int32_t x, int32_t y);

/* How many posts belong to it, as far as 65535. */
uint16_t posts_count(const struct surface *surface, uint32_t triangle);

/* Codes one of the triangle's posts (it has at least one); x and y are looked at only when writing. False when bytes
 * name none. */
bool posts_code(struct range_coder *coder, struct post_models *models, const struct surface *surface, uint32_t triangle,
                int32_t *x, int32_t *y);

#endif
