/* The triangles of a tile at any of its scales: what happens between one number of splits and another. Pure.
 *
 * Beyond its triangles an array of corners holds those to come, as they are when they appear: coarsening puts them
 * back, so refining need not fetch them. Fix-ups of the same slot know of one another, so that a seek over many splits
 * writes only the last of them on the way up, and undoes only the first on the way down. */
#ifndef SCREE_STREAM_PLAYBACK_H
#define SCREE_STREAM_PLAYBACK_H

#include "stream/memory.h"
#include "stream/progressive.h"
#include <scree/player.h>
#include <stdbool.h>

#define PLAYBACK_PAGE_SHIFT 9 /* what is dirty is told in pages of so many slots: 2 KiB of indices */

struct playback {
    struct scree_memory *memory;
    const struct progressive *progressive; /* the decoder's */
    uint32_t splits_ready, splits;         /* that can be applied; that are */
    uint32_t slots_known, fixups_known;    /* how far the arrays below go */
    uint32_t *corners;                     /* a slot */
    uint32_t *latest;                      /* a slot: 1 + its last fix-up that is known, 0: none */
    uint32_t *next, *previous;             /* a fix-up: the next one of its slot, UINT32_MAX: none; 1 + the one before
                                              it, 0: none */
    unsigned char *dirty_pages;            /* written since they were last told */
    uint32_t next_page;                    /* where to go on telling */
    uint32_t slots_told;                   /* slots from here on are dirty as well */
    uint32_t vertices_told;                /* and vertices */
};

/* Takes in what the decoder has appended. False, with what lacked in `error`: all is as it was. */
bool playback_extend(struct playback *playback, struct scree_error *error);

/* To a number of splits, at most splits_ready. Does not allocate. */
void playback_seek(struct playback *playback, uint32_t splits);

uint32_t playback_vertices(const struct playback *playback);
uint32_t playback_triangles(const struct playback *playback);

/* As scree_player_dirty_*. */
struct scree_range playback_dirty_vertices(struct playback *playback);
bool playback_dirty_slots(struct playback *playback, struct scree_range *slots);
void playback_dirty_all(struct playback *playback);

void playback_release(struct playback *playback);

/* Whether a seek up to before fix-up `end` has to write this one; down to before fix-up `first`, to undo it. */
static inline bool playback_is_last(const struct playback *playback, uint32_t fixup, uint32_t end) {
    return playback->next[fixup] >= end;
}
static inline bool playback_is_first(const struct playback *playback, uint32_t fixup, uint32_t first) {
    return playback->previous[fixup] <= first;
}

#endif
