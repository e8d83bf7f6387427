#include "tests/small_stream.h"

#include "tests/stream_maker.h"

#include <stdio.h>
#include <stdlib.h>

unsigned char *small_stream_new(struct scree_memory *memory, size_t *size_bytes) {
    const struct stream_wish wish = {.profile = SCREE_LOCAL,
                                     .seed = 3,
                                     .columns = SMALL_STREAM_STEPS,
                                     .rows = SMALL_STREAM_STEPS,
                                     .finest_m = 1,
                                     .base_vertices = 60};
    struct scree_error error = {0};
    unsigned char *bytes;
    if (stream_make(memory, &wish, NULL, &bytes, size_bytes, &error) != SCREE_OK) {
        fprintf(stderr, "a small stream: %s\n", error.text);
        exit(99);
    }
    return bytes;
}
