#include "stream/memory.h"

#include <stdlib.h>
#include <string.h>

/* In front of every block: its size, padded so that what follows stays aligned for any type. */
union block_header {
    size_t size_bytes;
    max_align_t alignment;
};

static enum scree_status admit(struct scree_memory *memory, size_t count, size_t size_bytes, size_t already_bytes,
                               const char *what, struct scree_error *error) {
    memory->requests++;
    if (memory->requests == memory->fail_request)
        return scree_fail(error, SCREE_E_MEMORY, "no memory for %s (failure asked for by a test)", what);
    if (size_bytes != 0 && count > (SIZE_MAX - sizeof(union block_header)) / size_bytes)
        return scree_fail(error, SCREE_E_LIMIT, "%s: %zu items are more than memory can address", what, count);
    size_t wanted_bytes = count * size_bytes;
    size_t others_bytes = memory->used_bytes - already_bytes;
    if (memory->limit_bytes != 0 &&
        (others_bytes > memory->limit_bytes || wanted_bytes > memory->limit_bytes - others_bytes))
        return scree_fail(error, SCREE_E_LIMIT, "%s: %zu bytes would pass the memory limit of %zu bytes", what,
                          wanted_bytes, memory->limit_bytes);
    return SCREE_OK;
}

static void account(struct scree_memory *memory, size_t from_bytes, size_t to_bytes) {
    memory->used_bytes = memory->used_bytes - from_bytes + to_bytes;
    if (memory->used_bytes > memory->peak_bytes) memory->peak_bytes = memory->used_bytes;
}

void *scree_reallocate(struct scree_memory *memory, void *block, size_t count, size_t size_bytes, const char *what,
                       struct scree_error *error) {
    union block_header *old = block == NULL ? NULL : (union block_header *)block - 1;
    size_t old_bytes = old == NULL ? 0 : old->size_bytes;
    if (admit(memory, count, size_bytes, old_bytes, what, error) != SCREE_OK) return NULL;
    union block_header *header = realloc(old, sizeof *header + count * size_bytes);
    if (header == NULL) {
        scree_fail(error, SCREE_E_MEMORY, "no memory for %s (%zu bytes)", what, count * size_bytes);
        return NULL;
    }
    header->size_bytes = count * size_bytes;
    account(memory, old_bytes, header->size_bytes);
    return header + 1;
}

void *scree_allocate(struct scree_memory *memory, size_t count, size_t size_bytes, const char *what,
                     struct scree_error *error) {
    void *block = scree_reallocate(memory, NULL, count, size_bytes, what, error);
    if (block != NULL) memset(block, 0, count * size_bytes);
    return block;
}

void scree_release(struct scree_memory *memory, void *block) {
    if (block == NULL) return;
    union block_header *header = (union block_header *)block - 1;
    account(memory, header->size_bytes, 0);
    free(header);
}
