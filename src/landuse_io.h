/* Land use from polygons: any vector source that OGR reads, drawn on the posts of a raster. */
#ifndef SCREE_LANDUSE_IO_H
#define SCREE_LANDUSE_IO_H

#include "src/filter_raster_io.h"
#include "src/landuse_rules.h"

struct landuse_posts {
    uint8_t *uses;        /* bits of enum ground_use (lod/context_filter.h), a byte a post */
    uint32_t *waters;     /* the number of the water at each post, 0: none; NULL: there is no water at all */
    uint32_t water_count; /* features; numbers go from 1 to this */
    uint32_t features[LANDUSE_COUNT];  /* on the raster */
    uint32_t ramps;                    /* of the roads, those that meet a bridge */
    uint32_t outside, repaired, empty; /* features that a rule fits: off the raster; invalid, and made valid; without a
                                          geometry, or with one that cannot be made valid or reprojected */
};

/* Reads all layers of `path`; another CRS is transformed to the raster's, and a missing one is taken to be that. A post
 * has a polygon's use where it lies inside; lines and points count for the posts nearest to them. A feature of water is
 * one level, of all posts that have data and no bridge. `rules_path` NULL: the default rules. `posts` is to be freed in
 * any case. */
enum scree_status landuse_read(struct scree_memory *memory, const char *path, const char *rules_path,
                               const struct filter_raster *raster, struct landuse_posts *posts,
                               struct scree_error *error);
void landuse_free(struct scree_memory *memory, struct landuse_posts *posts);

#endif
