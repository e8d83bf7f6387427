/* LAS files made by code: every version and point format, written after the ASPRS specification and not with the
 * reader's own tables. */
#ifndef SCREE_TESTS_LAS_MAKER_H
#define SCREE_TESTS_LAS_MAKER_H

#include "src/las.h"

struct las_fixture {
    int version_minor, point_format;
    uint32_t count;
    struct las_point (*point)(uint32_t i); /* what each is to hold */
    int extra_bytes;                       /* behind each point's own fields */
    double scale, offset[3];               /* scale 0: 0.25 */
    int epsg;                              /* as GeoTIFF's keys; 0: none */
    int vertical_unit_epsg;                /* of the same; 0: none */
    const char *wkt;                       /* NULL: none */
    bool wkt_is_extended;                  /* behind the points (1.4) */
};

/* The file's bytes, to be freed; stops the test program when memory runs out. */
unsigned char *las_make(const struct las_fixture *fixture, size_t *size_bytes);

#endif
