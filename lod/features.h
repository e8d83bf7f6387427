/* Sharp edges of a tile's full grid, traced into lines: crests, cliffs and walls that point set simplification would
 * wash out. Pure. Campos et al., "3D Simplification Methods and Large Scale Terrain Tiling" (2020), section 4.3.1.
 *
 * The surface is that of all posts, every cell cut along the diagonal in whose direction the terrain bends less: along
 * a crest or a valley rather than across it. An edge is sharp where the planes on its two sides make an angle larger
 * than the threshold; 0 is level ground. Edges that meet are joined; a line ends where any other number than two come
 * together, and at the border. Short lines are noise, and are dropped. */
#ifndef SCREE_LOD_FEATURES_H
#define SCREE_LOD_FEATURES_H

#include "lod/method.h"

#define FEATURE_ANGLE_DEG 60.0
#define FEATURE_EDGES     5

struct feature_options {
    double angle_deg;    /* the threshold; 0: FEATURE_ANGLE_DEG */
    int32_t least_edges; /* that a line has; p_m; 0: FEATURE_EDGES */
    bool in_unit_cube;   /* measure angles with the tile, relief included, stretched to a cube, as the paper does; else
                            in metres */
};

struct feature_post {
    int32_t column, row;
};

/* Lines of posts, one after the other; a closed line has its first post once more at its end. Lines meet at their ends
 * only. Posts on the border are ends, and are vertices of the tile's border lines. */
struct feature_lines {
    uint32_t line_count;
    uint32_t *starts; /* line_count + 1: where lines begin in `posts` */
    struct feature_post *posts;
};

/* The tile is one that method_tile_check accepts. On failure the lines are empty. */
enum scree_status features_find(struct scree_memory *memory, const struct method_tile *tile,
                                const struct feature_options *options, struct feature_lines *lines,
                                struct scree_error *error);

/* Fine on empty lines, and twice. */
void feature_lines_release(struct scree_memory *memory, struct feature_lines *lines);

#endif
