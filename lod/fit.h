/* Fitting: a mesh within its bound is brought nearer to the samples, in the sense of least squares, and loses the
 * vertices that it then can do without. Pure.
 *
 * A simplifier that picks vertices among the posts has to put the surface through them. Least squares asks for less:
 * interior vertices take the height, and the place among the posts next to them, that leave the least sum of squared
 * vertical distances, and an edge is turned where the other diagonal leaves less. One vertex or edge is looked at after
 * another, in the mesh's order, and a change is made only if the sum falls and no sample gets farther than the
 * tolerance; so the root mean square never grows and the bound holds at every moment. The normal equations of the
 * heights are well conditioned (each row leans on its own vertex), so that going round a few times solves them; and
 * what the bound forbids is left out one height at a time, which no linear solver could do.
 *
 * Border vertices stay as they are. Their heights could be fitted along the border line alone, and neighbours would
 * agree; but then triangles next to the border would lean on heights that their own samples never saw, and nobody could
 * promise the bound there.
 *
 * Edges turned by what they do to the error: N. Dyn, D. Levin and S. Rippa, "Data dependent triangulations for
 * piecewise linear interpolation" (IMA J. Numer. Anal. 10, 1990). */
#ifndef SCREE_LOD_FIT_H
#define SCREE_LOD_FIT_H

#include "lod/mesh.h"
#include "lod/position_code.h"

struct fit_options {
    double tolerance_m;      /* no change takes a sample farther; where one is farther already, no farther still */
    double height_unit_m;    /* heights are whole multiples of it, and the mesh's `heights` follow; 0: any height */
    bool thins;              /* vertices may go, by lod/simplify.h, as far as the tolerance allows */
    int32_t least_vertices;  /* see struct simplify_options */
    int64_t locked_step;     /* vertices whose x and y are multiples of it neither go nor move; 0: none are locked */
    struct code_frame codes; /* triangles stay positive in these codes too; span 0: they are not looked at */
    bool in_place;           /* vertices keep their places: only heights and edges are fitted */
    bool keep_edges;         /* no edge is turned */
};

/* Fits a connected mesh, whose triangles' errors need not be set and mean nothing afterwards. When memory lacks the
 * mesh is still one within its bound. */
enum scree_status fit_mesh(struct scree_memory *memory, struct mesh *mesh, const struct samples *samples,
                           const struct fit_options *options, struct scree_error *error);

/* What fitting makes small: the sum of squared distances of all samples but those on the tile's northern and eastern
 * border, each counted once. */
double fit_sum_squares_m2(const struct mesh *mesh, const struct samples *samples);

#endif
