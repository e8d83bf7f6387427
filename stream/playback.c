#include "stream/playback.h"

#include <string.h>

static uint32_t fixups_of(const struct playback *playback, uint32_t splits) {
    return splits == 0 ? 0 : playback->progressive->splits[splits - 1].fixup_end;
}

static uint32_t triangles_of(const struct playback *playback, uint32_t splits) {
    return splits == 0 ? playback->progressive->base_triangles : playback->progressive->splits[splits - 1].triangle_end;
}

uint32_t playback_vertices(const struct playback *playback) {
    return playback->slots_known == 0 ? 0 : playback->progressive->base_vertices + playback->splits;
}

uint32_t playback_triangles(const struct playback *playback) {
    return playback->slots_known == 0 ? 0 : triangles_of(playback, playback->splits);
}

static size_t pages_of(uint32_t slots) {
    return ((size_t)slots >> PLAYBACK_PAGE_SHIFT) + 1;
}

static bool grow(struct scree_memory *memory, uint32_t **array, size_t count, struct scree_error *error) {
    uint32_t *grown = scree_reallocate(memory, *array, count, sizeof **array, "the tile's triangles", error);
    if (grown != NULL) *array = grown;
    return grown != NULL;
}

static bool grow_pages(struct scree_memory *memory, unsigned char **pages, size_t count, struct scree_error *error) {
    unsigned char *grown = scree_reallocate(memory, *pages, count, 1, "the tile's triangles", error);
    if (grown != NULL) *pages = grown;
    return grown != NULL;
}

/* Chains each new fix-up to the one before it of the same slot. */
static void link_fixups(struct playback *playback) {
    const struct progressive *progressive = playback->progressive;
    for (uint32_t i = playback->fixups_known; i < progressive->fixup_count; i++) {
        uint32_t *latest = &playback->latest[progressive->fixups[i].slot];
        playback->next[i] = UINT32_MAX;
        playback->previous[i] = *latest;
        if (*latest != 0) playback->next[*latest - 1] = i;
        *latest = i + 1;
    }
    playback->fixups_known = progressive->fixup_count;
}

bool playback_extend(struct playback *playback, struct scree_error *error) {
    const struct progressive *progressive = playback->progressive;
    struct scree_memory *memory = playback->memory;
    uint32_t slots = 3 * progressive->triangle_count, fixups = progressive->fixup_count;
    if (!grow(memory, &playback->corners, slots, error) || !grow(memory, &playback->latest, slots, error) ||
        !grow(memory, &playback->next, fixups, error) || !grow(memory, &playback->previous, fixups, error) ||
        !grow_pages(memory, &playback->dirty_pages, pages_of(slots), error))
        return false;
    uint32_t new_slots = slots - playback->slots_known;
    if (new_slots > 0) {
        memcpy(playback->corners + playback->slots_known, progressive->corners + playback->slots_known,
               new_slots * sizeof *playback->corners);
        memset(playback->latest + playback->slots_known, 0, new_slots * sizeof *playback->latest);
    }
    size_t old_pages = playback->slots_known == 0 ? 0 : pages_of(playback->slots_known);
    memset(playback->dirty_pages + old_pages, 0, pages_of(slots) - old_pages);
    playback->slots_known = slots;
    link_fixups(playback);
    playback->splits_ready = progressive->split_count;
    return true;
}

static void write_slot(struct playback *playback, uint32_t slot, uint32_t corner) {
    playback->corners[slot] = corner;
    playback->dirty_pages[slot >> PLAYBACK_PAGE_SHIFT] = 1;
}

void playback_seek(struct playback *playback, uint32_t splits) {
    const struct progressive_fixup *fixups = playback->progressive->fixups;
    uint32_t from = fixups_of(playback, playback->splits), to = fixups_of(playback, splits);
    for (uint32_t i = from; i < to; i++)
        if (playback_is_last(playback, i, to)) write_slot(playback, fixups[i].slot, fixups[i].fine);
    for (uint32_t i = to; i < from; i++)
        if (playback_is_first(playback, i, to)) write_slot(playback, fixups[i].slot, fixups[i].coarse);
    playback->splits = splits;
    playback->next_page = 0;
    uint32_t slots = 3 * playback_triangles(playback);
    if (playback->slots_told > slots) playback->slots_told = slots; /* those beyond are lost to the viewer */
}

struct scree_range playback_dirty_vertices(struct playback *playback) {
    struct scree_range range = {playback->vertices_told, playback_vertices(playback)};
    if (range.first > range.end) range.first = range.end;
    if (range.end > playback->vertices_told) playback->vertices_told = range.end;
    return range;
}

bool playback_dirty_slots(struct playback *playback, struct scree_range *slots) {
    unsigned char *dirty = playback->dirty_pages;
    uint32_t slot_count = 3 * playback_triangles(playback), told = playback->slots_told, page = playback->next_page;
    uint32_t pages = told == 0 ? 0 : ((told - 1) >> PLAYBACK_PAGE_SHIFT) + 1;
    while (page < pages && !dirty[page]) page++;
    slots->first = page < pages ? page << PLAYBACK_PAGE_SHIFT : told;
    while (page < pages && dirty[page]) dirty[page++] = 0;
    slots->end = page << PLAYBACK_PAGE_SHIFT;
    if (page >= pages) { /* with the last of those told before go all that are there since */
        slots->end = slot_count;
        for (; page << PLAYBACK_PAGE_SHIFT < slot_count; page++) dirty[page] = 0;
        playback->slots_told = slot_count;
    }
    playback->next_page = page;
    return slots->first < slots->end;
}

void playback_dirty_all(struct playback *playback) {
    playback->vertices_told = 0;
    playback->slots_told = 0;
    playback->next_page = 0;
}

void playback_release(struct playback *playback) {
    scree_release(playback->memory, playback->dirty_pages);
    scree_release(playback->memory, playback->previous);
    scree_release(playback->memory, playback->next);
    scree_release(playback->memory, playback->latest);
    scree_release(playback->memory, playback->corners);
    *playback = (struct playback){0};
}
