/* Memory with a budget: every allocation of the pure rooms goes through one of these, so that hostile counts meet a
 * limit before they meet malloc, tests can fail the n-th request, and peaks are known.
 *
 * A budget is thread-compatible: one thread at a time; give each worker its own. */
#ifndef SCREE_STREAM_MEMORY_H
#define SCREE_STREAM_MEMORY_H

#include <scree/error.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct scree_memory {
    size_t limit_bytes;    /* 0: no limit */
    size_t used_bytes;     /* live now, without malloc's own overhead */
    size_t peak_bytes;     /* the most that was ever live */
    uint64_t requests;     /* calls so far that asked for memory */
    uint64_t fail_request; /* for tests: the request of this number (from 1) fails; 0: none */
};

/* An array of `count` items of `size_bytes` each, zeroed; aligned for any type. Returns NULL and records
 * SCREE_E_LIMIT or SCREE_E_MEMORY with `what` in the line ("the tile's triangles"). A count of 0 gives a valid
 * pointer. The product is checked for overflow. */
void *scree_allocate(struct scree_memory *memory, size_t count, size_t size_bytes, const char *what,
                     struct scree_error *error);

/* Grows or shrinks `block` (NULL or from scree_allocate of the same budget) to `count` items; new bytes are not
 * zeroed. On failure NULL comes back and `block` stays as it was. */
void *scree_reallocate(struct scree_memory *memory, void *block, size_t count, size_t size_bytes, const char *what,
                       struct scree_error *error);

/* Gives a block back to the budget that it came from; NULL is fine. */
void scree_release(struct scree_memory *memory, void *block);

#ifdef __cplusplus
}
#endif
#endif
