/* Where a tile is: its geometry, the frame of its position codes, its posts, and the rungs on its way. What the two
 * ways to build a tile have in common (src/tile_build.h, src/method_build.h). */
#ifndef SCREE_TILE_PLACE_H
#define SCREE_TILE_PLACE_H

#include "lod/tile.h"
#include "src/ladder.h"
#include "src/raster_io.h"

struct method_choice;
struct tin_source;

/* What a build without products is for: the sizes of all meshes. */
enum census { CENSUS_NONE, CENSUS_OF_TRIANGLES, CENSUS_OF_SVO };

struct rung_count {
    int rung;
    uint32_t vertices, triangles;
    double mmqe_m2; /* CENSUS_OF_SVO */
};

/* What is the same for all tiles of a build. */
struct tile_plan {
    const struct lattice *lattice;
    const struct ladder *ladder;
    double nodata_height_m;
    bool no_normals, plain, fits; /* see struct pyramid_options */
    uint32_t rungs_per_increment; /* of streams; 0: 1 */
    const struct method_choice *method;
    const struct tin_source *tin; /* that tiles are made of; NULL: of a raster's posts */
    enum census census;
    bool has_base;
    int base_rung; /* where streams end, if they have a base; or before it where the tile does */
};

/* The room that a tile's geometry points to. */
struct tile_drops {
    float east_m[TILE_CELLS + 1];
};
/* Cells along the side of a whole tile. */
int32_t tile_place_cells(const struct tile_plan *plan, int zoom);

struct tile_geometry tile_place_geometry(const struct tile_plan *plan, struct tile_id id, struct tile_drops *drops);

/* The frame in which a tile of `zoom` will be written, as the tile `id` sees it: its own, or its parent's. */
struct code_frame tile_place_frame(const struct tile_plan *plan, struct tile_id id, int zoom);

/* Lattice steps from post to post of the grid that a tile without data begins with. */
int32_t tile_place_level_step(const struct tile_plan *plan, struct tile_id id, const struct tile_geometry *geometry);

/* The posts of a tile of the finest zoom; must not be moved. */
struct placed_posts {
    struct tile_posts posts;
    float *heights_m;
    double east_m[TILE_CELLS + 1], north_m[TILE_CELLS + 1];
};
enum scree_status placed_posts_read(const struct tile_plan *plan, struct tile_id id, struct raster_reader *reader,
                                    struct scree_memory *memory, struct placed_posts *posts, struct scree_error *error);
void placed_posts_release(struct scree_memory *memory, struct placed_posts *posts);

/* ---- rungs ---- */

/* The last one of a tile: that of its parent, if it has one. */
static inline int tile_coarsest_rung(const struct tile_plan *plan, struct tile_id id) {
    return id.zoom > 0 ? RUNGS_A_ZOOM * (id.zoom - 1) : plan->ladder->coarsest_rung;
}

/* The zoom whose static tile the rung is, or is on the way to. */
static inline int tile_zoom_ahead(struct tile_id id, int rung) {
    return rung >= RUNGS_A_ZOOM * id.zoom ? id.zoom : id.zoom - 1;
}

/* Whether static tiles are made of the rung. */
static inline bool rung_is_static(int rung, int zoom) {
    return zoom >= 0 && rung == RUNGS_A_ZOOM * zoom;
}

#endif
