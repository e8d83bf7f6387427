/* What scree compare found, and its forms: CSV, Markdown, JSON and charts. Pure.
 *
 * An entry is a method at a zoom, with one set of figures for every tile. Means are over tiles, as in Campos et al.
 * (2020), tables 2, 4 and 5; the RMS is over all posts, the max over all tiles. */
#ifndef SCREE_COMPARE_REPORT_H
#define SCREE_COMPARE_REPORT_H

#include "lod/hausdorff.h"
#include "src/lattice.h"
#include "src/text.h"
#include <stdbool.h>
#include <stdint.h>

/* One method on one tile. */
struct compare_figures {
    struct tile_id id;
    double main_value; /* of the option that decides how many triangles there are */
    double cpu_s;
    uint32_t vertices, triangles;
    uint64_t bytes; /* of the static tile, as it is stored */
    struct hausdorff distance;
    double max_error_m, sum_squares_m2; /* vertical, over all posts */
    int64_t posts;
};

struct compare_entry {
    int zoom;
    int method;                    /* of the report's */
    uint32_t wanted_triangles;     /* 0: as many as the options give */
    char options[256];             /* as they were at this zoom, without the main one where triangles are wanted */
    struct compare_figures *tiles; /* one a tile of the zoom, in the same order for all methods */
    char picture[64];              /* a file beside the report; "": none was drawn */
    uint32_t picture_triangles;
};

struct compare_zoom {
    int zoom;
    uint32_t tile_count;   /* that were compared: each full of data */
    uint32_t tiles_in_all; /* that the data touch */
    bool is_cut; /* the zoom has no whole tile of 256 x 256 cells: this is one that the raster's border cuts */
    double tolerance_m;
    char picture[64]; /* of the posts of one tile; "": none was drawn */
    struct tile_id picture_tile;
};

struct compare_report {
    const char *dem; /* its name */
    int method_count;
    const char *const *methods;      /* names */
    const char *const *main_options; /* of each method: what decides the number of triangles; "": it has no options */
    uint32_t zoom_count, entry_count;
    const struct compare_zoom *zooms;    /* from coarse to fine */
    const struct compare_entry *entries; /* by zoom, then by wanted triangles, then by method */
};

/* An entry's means over its tiles. */
struct compare_means {
    double cpu_s, vertices, triangles, bytes;
    double main_low, main_high;          /* the range of the main option's values */
    double hausdorff_m, hausdorff_max_m; /* mean and largest of the tiles' symmetric distances */
    double mean_distance_m;              /* of the tiles' mean distances */
    double max_error_m, rms_error_m;
    bool has_wanted_triangles; /* every tile within 2 % of what was wanted */
};
struct compare_means compare_means_of(const struct compare_entry *entry, uint32_t tile_count);

/* How many tiles the entry has figures of. */
uint32_t compare_tile_count(const struct compare_report *report, const struct compare_entry *entry);

/* One line an entry, and one line an entry and tile. */
void compare_add_csv(const struct compare_report *report, struct text *text);
void compare_add_tiles_csv(const struct compare_report *report, struct text *text);

/* A page that shows the charts "hausdorff.svg" and "error.svg", which lie beside it, and the pictures. */
void compare_add_markdown(const struct compare_report *report, struct text *text);

/* The table for a terminal. */
void compare_add_table(const struct compare_report *report, struct text *text);

/* In a malloc'd block that is the caller's; NULL: no memory. */
char *compare_json_new(const struct compare_report *report);

/* Sorted Hausdorff distances of the tiles, a panel a table (figure 8 there), and RMS error against triangles, a panel a
 * zoom. SCREE_E_MEMORY. */
enum scree_status compare_add_hausdorff_chart(const struct compare_report *report, struct scree_memory *memory,
                                              struct text *text, struct scree_error *error);
enum scree_status compare_add_error_chart(const struct compare_report *report, struct scree_memory *memory,
                                          struct text *text, struct scree_error *error);

#endif
