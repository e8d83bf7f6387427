/* The tiles that a manifest lists against the files that are there: of static tiles and of streams. Pure. */
#ifndef SCREE_VERIFY_LISTED_H
#define SCREE_VERIFY_LISTED_H

#include "src/manifest_read_io.h"
#include "src/tile_list.h"
#include "src/verify_report.h"
#include "stream/memory.h"
#include <scree/error.h>

struct verify_listing {
    enum promise promise; /* to book */
    const char *manifest; /* its name, for the lines */
    const struct manifest_ranges *available;
    const struct tile_list *tiles; /* MAX_ZOOM + 1 of them, sorted */
};

/* Each file is listed once, and nothing else is. Fails only for want of memory. */
enum scree_status verify_listed(struct scree_memory *memory, const struct verify_listing *listing,
                                struct verify_report *report, struct scree_error *error);

/* PROMISE_ANCESTORS: the roots are there, when `coarsest` is 0, and the parent of every tile of a finer zoom is. */
void verify_ancestors(const struct tile_list *tiles, enum profile profile, int coarsest, struct verify_report *report);

#endif
