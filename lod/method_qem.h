/* `qem`: Scree's own collapse (lod/simplify.h) on the posts of one zoom, for comparison with the methods of the
 * literature: quadrics propose, the exact growth of the sum of squared errors decides the order, and the bound on the
 * vertical error holds at every post. Without the bound the order alone is at work. What is left may be fitted to the
 * posts (lod/fit.h). Pure. */
#ifndef SCREE_LOD_METHOD_QEM_H
#define SCREE_LOD_METHOD_QEM_H

#include "lod/method.h"
#include <stdbool.h>

struct method_qem_options {
    double tolerance_m;      /* no inner post ends up farther from the surface; >= 0 */
    bool is_unbounded;       /* any error will do: stop by least_vertices alone */
    uint32_t least_vertices; /* stop when so many are left, border included; 0: when no collapse is allowed */
    bool fits;               /* fit the mesh, and let go what the bound then no longer needs */
};

enum scree_status method_qem(struct scree_memory *memory, const struct method_tile *tile,
                             const struct method_qem_options *options, struct method_mesh *mesh,
                             struct scree_error *error);

#endif
