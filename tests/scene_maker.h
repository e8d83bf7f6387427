/* What scree_select chooses from, made by code: a terrain of many tiles with the rungs that a build would give them,
 * and cameras. */
#ifndef SCREE_TESTS_SCENE_MAKER_H
#define SCREE_TESTS_SCENE_MAKER_H

#include <scree/select.h>
#include <stdbool.h>

#define SCENE_MOST_TILES 4096
#define SCENE_MOST_ZOOM  12

/* Tiles share the headers of their zoom; own points to one's scene_tile. */
struct scene {
    struct scree_terrain terrain;
    struct scree_zoom_scale zooms[SCENE_MOST_ZOOM + 1];
    struct scree_stream_header headers[SCENE_MOST_ZOOM + 1];
    uint32_t tile_count;
    struct scree_select_tile tiles[SCENE_MOST_TILES];
    struct scree_select_drawn drawn[SCENE_MOST_TILES];
    struct scree_select_wanted wanted[SCENE_MOST_TILES];
    double workspace[8 * SCENE_MOST_TILES];
    struct scree_selection selection;
};

/* All tiles down to `whole_zoom`, and those around a point (in root tiles from the south-western corner) down to
 * `finest_zoom`; everything has arrived. Heights are 0 .. `highest_m`, those of a tile a part of its parent's. */
void scene_make(struct scene *scene, enum scree_profile profile, int whole_zoom, int finest_zoom, double x, double y,
                double highest_m);

/* The tile among those drawn that holds a point, or UINT32_MAX; each point of the terrain is in one at most. */
uint32_t scene_drawn_at(const struct scene *scene, double x, double y);

/* The world's place of a point. */
void scene_place(const struct scene *scene, double x, double y, double height_m, double place[3]);

struct scene_camera {
    double eye[3], target[3];
    bool orthogonal;
    double height; /* of the screen: an angle in radians, or metres */
    double width_px, height_px;
    double shift;   /* of the middle of the screen to the right, in half screens */
    double stretch; /* pixels are so much wider than high; 0: not */
    enum scree_depth depth;
};

/* The near plane is at 1 m, the far one at 10^8 m, but for perspective with SCREE_DEPTH_ZERO, which has none. */
void scene_matrix(const struct scene_camera *camera, double matrix[16]);

/* Pixels from the middle of the screen; false behind the camera. */
bool scene_project(const struct scene_camera *camera, const double matrix[16], const double place[3], double pixels[2]);

#endif
