/* What verify found: for each promise how often it was looked at, how often it was broken, and the first few lines
 * that say where. Pure. */
#ifndef SCREE_VERIFY_REPORT_H
#define SCREE_VERIFY_REPORT_H

#include "src/lattice.h"
#include <stdint.h>

enum promise {
    PROMISE_LAYER,       /* layer.json says what clients need */
    PROMISE_AVAILABLE,   /* `available` lists the files that are there, no more and no less */
    PROMISE_ANCESTORS,   /* every tile's parent is there, and so are the roots */
    PROMISE_FORMAT,      /* tiles decode: sizes, counts and indices are right */
    PROMISE_VERTICES,    /* every vertex is used; never exactly 65,536 of them */
    PROMISE_HEADER,      /* centre, heights and bounding sphere fit the vertices */
    PROMISE_OCCLUSION,   /* where the horizon occlusion point is hidden, so is every vertex */
    PROMISE_EDGE_LISTS,  /* exactly the vertices of each border, corners included */
    PROMISE_ORIENTATION, /* every triangle has a positive area in the plane */
    PROMISE_COVER,       /* the triangles cover the tile once, without a hole or an overlap */
    PROMISE_BORDERS,     /* neighbours of a zoom have the same border vertices at the same heights */
    PROMISE_NORMALS,     /* and the same normals there */
    PROMISE_COUNTS,      /* layer.json's tiles, vertices, triangles and bytes are those of the files */
    PROMISE_LADDER,      /* tolerance and SVO never grow from a zoom to the next finer one */
    PROMISE_ERROR,       /* the finest zoom is within its tolerance of the source */
    /* of streams, besides ancestors, orientation, cover and borders */
    PROMISE_STREAM_LISTED,   /* scree.json lists the files that are there, no more and no less */
    PROMISE_STREAM_COUNTS,   /* and its figures are those of the files */
    PROMISE_STREAM_FORMAT,   /* streams decode, checksums are right */
    PROMISE_STREAM_PLACE,    /* headers agree with scree.json and with the names of the files */
    PROMISE_STREAM_SCALES,   /* rungs are on the ladder, SVO does not grow and is what the MMQE makes it */
    PROMISE_STREAM_FAMILIES, /* a tile at its finest rung is the union of its children at their coarsest */
    PROMISE_STREAM_ERROR,    /* no post of the source is farther from a mesh than its stream says */
    PROMISE_COUNT
};

#define REPORT_NOTES      10 /* the first so many breaches of a promise are told, the others counted */
#define REPORT_NOTE_BYTES 240

struct promise_state {
    uint64_t checked, broken;
    int note_count;
    char notes[REPORT_NOTES][REPORT_NOTE_BYTES];
};

struct zoom_count {
    uint64_t tiles, vertices, triangles, bytes;
};

struct verify_report {
    struct promise_state promises[PROMISE_COUNT];
    struct zoom_count zooms[MAX_ZOOM + 1];
    double border_difference_m; /* the largest between two neighbours */
    uint64_t borders;           /* pairs of neighbours compared */
};

/* Short name for machines ("edge_lists") and the promise in words. */
const char *promise_name(enum promise promise);
const char *promise_text(enum promise promise);

/* Counts one check that held. */
void report_held(struct verify_report *report, enum promise promise);

/* Counts one check that did not, with a line (printf style) that says where and how. */
void report_broken(struct verify_report *report, enum promise promise, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* How many promises are broken. */
int report_broken_promises(const struct verify_report *report);

#endif
