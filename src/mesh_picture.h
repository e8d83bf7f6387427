/* A picture of a mesh, seen from above and in perspective, with its edges. Pure. */
#ifndef SCREE_MESH_PICTURE_H
#define SCREE_MESH_PICTURE_H

#include "lod/mesh_distance.h"
#include <scree/error.h>
#include <stdint.h>

struct mesh_picture {
    uint32_t width_px, height_px;
    uint8_t *rgb; /* rows from the top, 3 bytes a pixel */
};

/* Draws a mesh twice, side by side, each in a square of `side_px` pixels: from above, north is up, and from the south,
 * from 35 degrees above the horizon. x is east, y north, z up, in metres. Relief that is small against the mesh's
 * width is exaggerated in perspective. Light comes from the north-west. Edges are left out where triangles are hardly
 * larger than pixels. SCREE_E_ARGUMENT as space_mesh_check, or no side of 16 to 4096 pixels. */
enum scree_status mesh_picture_new(struct scree_memory *memory, const struct space_mesh *mesh, uint32_t side_px,
                                   struct mesh_picture *picture, struct scree_error *error);
void mesh_picture_release(struct scree_memory *memory, struct mesh_picture *picture);

#endif
