/* Selection: which tiles to draw at which scale, and what to load next. docs/selection.md tells the formulas.
 *
 *     scree_select_link(&terrain, tiles, tile_count, &error);                    once; again when tiles come or go
 *     for every frame:
 *         scree_view_of_matrix(matrix, SCREE_DEPTH_MINUS_ONE, width_px, height_px, &view, &error);
 *         scree_select(&terrain, tiles, tile_count, &view, &options, &selection, &error);
 *         draw selection.drawn[], each at its level: scree_player_seek_level; stitched: scree/stitch.h
 *         fetch selection.wanted[], most urgent first
 *
 * The world is metres: in the geodetic profile WGS84 ECEF, in the local one the CRS's coordinates times metres a unit,
 * and heights for z. Nothing is allocated and nothing is remembered from frame to frame. */
#ifndef SCREE_SELECT_H
#define SCREE_SELECT_H

#include <scree/cut.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Between which values of z / w the near and the far plane lie. */
enum scree_depth {
    SCREE_DEPTH_ANY,       /* neither plane takes anything away */
    SCREE_DEPTH_MINUS_ONE, /* -1 .. 1: OpenGL */
    SCREE_DEPTH_ZERO       /* 0 .. 1, either way round: Vulkan, Direct3D, glClipControl */
};

/* A camera, from one of the functions below. */
struct scree_view {
    uint32_t plane_count;
    double planes[6][4];  /* a place is seen where x p[0] + y p[1] + z p[2] + p[3] >= 0 for all of them */
    double depth[4];      /* w of a place, in the same way; (0, 0, 0, w) when the projection is orthogonal */
    double pixels;        /* a metre parallel to the screen is at most so many pixels where w is 1 */
    double slope;         /* by how much w grows in a metre along the view; 0: orthogonal */
    double eye[3];        /* perspective only */
    double direction[3];  /* perspective only: unit vector along the view; zeros: all around */
    double corner_cosine; /* perspective only: of the angle between that and the farthest corner of the screen */
    double axis[2][4];    /* orthogonal only: metres of a place from the middle of the screen, to the right and up */
};

/* A camera from its view-projection matrix. Clip coordinate j (of x, y, z, w) is the sum over i (of x, y, z, 1) of the
 * world's coordinate i times matrix[4 * i + j]: how OpenGL (column by column, for column vectors) and OpenSceneGraph
 * (row by row, for row vectors) keep matrices in memory. Perspective, oblique, orthogonal and all between.
 * SCREE_E_ARGUMENT: not a number, no such projection, or an empty viewport. */
SCREE_API enum scree_status scree_view_of_matrix(const double matrix[16], enum scree_depth depth, double width_px,
                                                 double height_px, struct scree_view *view, struct scree_error *error);

/* A camera that looks all around, from its place alone: nothing is culled. `height_px` pixels span `field_of_view_rad`
 * from top to bottom (below pi). */
SCREE_API enum scree_status scree_view_of_eye(const double eye[3], double field_of_view_rad, double height_px,
                                              struct scree_view *view, struct scree_error *error);

/* The largest of a zoom's tiles, for tiles whose header has not arrived. */
struct scree_zoom_scale {
    double finest_svo_m;
    double finest_max_error_m;
};

/* All tiles together, as their manifest tells. */
struct scree_terrain {
    enum scree_profile profile;
    double lowest_m, highest_m;           /* of all heights */
    const struct scree_zoom_scale *zooms; /* by zoom, as far as there are tiles; NULL: not known */
    /* local profile only: */
    int32_t finest_zoom;
    int64_t columns, rows;       /* lattice steps of the whole (posts less one) */
    double west, south;          /* of the south-western post, in CRS units */
    double spacing_x, spacing_y; /* of a lattice step, in the same */
    double metres_x, metres_y;   /* the same in metres */
};

/* A tile that exists, and what is there of it. */
struct scree_select_tile {
    struct scree_tile_id id;
    uint32_t rungs_ready;                     /* that can be drawn: scree_player_rungs_ready */
    const struct scree_stream_header *header; /* NULL: not arrived */
    float lowest_m, highest_m; /* of the tile and all below it; lowest_m > highest_m or NaN: those of its parent */
    uint32_t first_child, child_count; /* scree_select_link's: the next zoom's, next to one another */
    void *own;                         /* the caller's, whatever it be */
};

/* Sorts the tiles by zoom, then along the Z curve, and links them. The tiles of the lowest zoom are the roots.
 * SCREE_E_ARGUMENT: a tile is there twice, is none of the profile's, or lacks its parent; the tiles have been sorted
 * then, and are not to be used. */
SCREE_API enum scree_status scree_select_link(const struct scree_terrain *terrain, struct scree_select_tile *tiles,
                                              uint32_t tile_count, struct scree_error *error);

/* Bounds for the heights of a tile and all below it from one of its meshes: its lowest and highest vertex, the rung's
 * max error, and how far a flat triangle may lie below a round globe. */
SCREE_API void scree_select_heights(const struct scree_terrain *terrain, const struct scree_stream_header *header,
                                    uint32_t rung, const struct scree_vertex *vertices, float *lowest_m,
                                    float *highest_m);

enum scree_measure {
    SCREE_BY_SVO,      /* the smallest visible object, parallel to the screen, is at most the tolerance long */
    SCREE_BY_MAX_ERROR /* no post is farther than the tolerance from where it belongs, on the screen */
};

/* Zeros are the defaults. */
struct scree_select_options {
    enum scree_measure measure;
    double tolerance_px;      /* 0: 1 pixel */
    uint64_t triangle_budget; /* 0: none */
    uint64_t byte_budget;     /* of what is drawn or wanted, from the files' beginnings, and of all base meshes on the
                                 way there; 0: none */
};

struct scree_select_drawn {
    uint32_t tile;   /* index into the tiles */
    uint32_t rung;   /* index of the mesh to draw, which has arrived: it keeps the tolerance where one does */
    double level;    /* for morphing, scree_player_seek_level: above rung - 1, where the error passes the tolerance */
    double error_px; /* of the rung */
};

struct scree_select_wanted {
    uint32_t tile;
    uint32_t first_rung, end_rung; /* the blocks missing, from the first to before the end; 0: with the header */
    double error_px;               /* of what is to be seen until then */
    double distance_m;             /* of the tile from the eye, or from the axis of an orthogonal view */
};

/* The caller's arrays, each with room for `capacity` items, at least as many as there are tiles; and what was chosen.
 */
struct scree_selection {
    uint32_t capacity;
    struct scree_select_drawn *drawn;   /* set in the order of scree/cut.h */
    struct scree_select_wanted *wanted; /* set in the order of urgency: the largest error first, then the nearest */
    void *workspace;                    /* of scree_select_workspace bytes, aligned for a double */
    size_t workspace_bytes;
    uint32_t drawn_count, wanted_count;
    uint64_t triangles;  /* of what is drawn */
    double tolerance_px; /* what was asked for, or the larger one that a budget allows */
};

/* Bytes of workspace for so many tiles. */
SCREE_API size_t scree_select_workspace(uint32_t tile_count);

/* Chooses. A tile gives way to its children when its finest rung is not good enough and the base meshes of all of them
 * have arrived; until then it is drawn at the finest rung that it has. Tiles out of sight are neither drawn nor wanted,
 * unless a sibling in sight waits for them. With a budget, the tolerance is raised until what is drawn and what is
 * wanted keep it, to within a 64th of an octave; when the roots' base meshes alone are too much, those are chosen.
 * SCREE_E_ARGUMENT: options that make no sense. SCREE_E_LIMIT: too little room. */
SCREE_API enum scree_status scree_select(const struct scree_terrain *terrain, const struct scree_select_tile *tiles,
                                         uint32_t tile_count, const struct scree_view *view,
                                         const struct scree_select_options *options, struct scree_selection *selection,
                                         struct scree_error *error);

#ifdef __cplusplus
}
#endif
#endif
