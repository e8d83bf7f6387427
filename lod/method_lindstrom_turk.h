/* Edge collapse with free placement: the memoryless simplification of Lindstrom and Turk (lod/lindstrom_cost.h), with
 * the placement rules for tiles of R. Campos et al., "On the Simplification and Terrain Tiling ..." (ISPRS Int. J.
 * Geo-Inf. 9(2), 2020), section 4.2. Pure.
 *
 * Their rules, and what becomes of them here:
 *   - an edge at a corner of the tile collapses to the corner;
 *   - an edge of a constrained border never collapses. All borders are, unless `free_borders` says otherwise; then the
 *     better of its two ends stays, and an edge that crosses the tile from border to border never collapses;
 *   - an edge with one end on the border collapses to that end;
 *   - no vertical walls: they refuse triangles whose normal is level, here no triangle may turn over either, so that
 *     the mesh stays one of the plane.
 * They leave open an edge collapse that stops on error: here no collapse may take a post farther from the mesh than the
 * tolerance, measured at all posts.
 *
 * Costs are computed in metres, with heights stretched so that the tile's relief is as long as its longer side: volumes
 * do not mind, the weights of lengths and the angle between planes do. Collapses are carried out in classes of costs
 * within a factor of two; costs are looked at again when an edge's turn comes. */
#ifndef SCREE_LOD_METHOD_LINDSTROM_TURK_H
#define SCREE_LOD_METHOD_LINDSTROM_TURK_H

#include "lod/lindstrom_cost.h"
#include "lod/method.h"
#include "lod/position_code.h"

struct method_lindstrom_turk_options {
    uint32_t edges;                   /* e_e: stop when no more are left; 0: go on as long as a collapse is admitted */
    bool is_bounded;                  /* no collapse goes beyond the tolerance. Needed where `edges` is 0 */
    double tolerance_m;               /* at least 0 */
    struct lindstrom_weights weights; /* e_v, e_b, e_s, at least 0; all 0: 0.5, 0.5 and 0, as is usual */
    bool free_borders;                /* the lines' vertices may go as well: for a tile without neighbours */
    struct code_frame codes; /* in lattice steps: triangles stay positive in these codes too; span 0: not looked at */
};

/* What method_tile_check accepts; SCREE_E_LIMIT beyond 2^18 cells a side. */
enum scree_status method_lindstrom_turk(struct scree_memory *memory, const struct method_tile *tile,
                                        const struct method_lindstrom_turk_options *options, struct method_mesh *mesh,
                                        struct scree_error *error);

#endif
