/* How many triangles a surface needs: squares, split where they are not flat. Pure.
 *
 * The measure of S. Goebbels and R. Pohle-Froehlich, "Context-sensitive filtering of terrain data based on multi scale
 * analysis" (GRAPP 2015), section 2: a square of posts is two triangles (lod/square.h), and four squares of half its
 * side where a post lies more than epsilon above or below these. Squares of different sizes do not meet without gaps.
 */
#ifndef SCREE_LOD_SQUARE_SUBDIVISION_H
#define SCREE_LOD_SQUARE_SUBDIVISION_H

#include <stdint.h>

#define SUBDIVISION_CELLS 128 /* sides of the largest squares; the paper's are a kilometre */

/* Triangles of `columns` x `rows` posts (at least 2 each), row by row. Squares that reach beyond them are split. */
uint64_t subdivision_triangles(const float *heights_m, int32_t columns, int32_t rows, double epsilon_m);

#endif
