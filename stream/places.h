/* On which posts of a triangle new vertices come. Pure. */
#ifndef SCREE_STREAM_PLACES_H
#define SCREE_STREAM_PLACES_H

#include "stream/range_coder.h"
#include "stream/surface.h"

/* A vertex on its way in. */
struct pending {
    int32_t x, y;
    uint32_t triangle; /* that it lies in now */
    uint32_t next;     /* in the same triangle */
};

/* What is learned about where in triangles vertices come. */
struct place_models {
    struct bit_model row[8], column[8]; /* eighths of a triangle's rows, and of a row */
};
void place_models_start(struct place_models *models);

/* Codes the places of `count` vertices, 1 up to the triangle's posts, in ascending order of rows and columns: x and y
 * of each, which are looked at only when writing. False when bytes name what is no such place. */
bool places_code(struct range_coder *coder, struct place_models *models, const struct surface *surface,
                 uint32_t triangle, uint32_t count, struct pending *places);

#endif
