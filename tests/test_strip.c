/* Recordings of many tiles: every mesh that a simplification leaves can be stripped to its corners. */
#include "tests/fractal.h"
#include "tests/stream_maker.h"

#include <CUnit/CUnit.h>
#include <stdio.h>

/* In some of these, a vertex lies on the only diagonal of a quadrilateral that is inside it. */
static void every_mesh_can_be_stripped(void) {
    enum { STEPS = 48, STRIDE = STEPS + 3 };
    static struct made_recording made;
    static float heights_m[STRIDE * STRIDE];
    for (uint64_t seed = 8; seed < 14; seed++) {
        const struct fractal fractal = {seed, true};
        struct scree_memory memory = {0};
        struct scree_error error = {0};
        const struct stream_wish wish = {.heights_m = heights_m + STRIDE + 1,
                                         .stride = STRIDE,
                                         .columns = STEPS,
                                         .rows = STEPS,
                                         .finest_m = 0.5,
                                         .rungs = 1};
        fractal_window(&fractal, 4900, -4900, STRIDE, STRIDE, heights_m, STRIDE);
        CU_ASSERT_EQUAL(stream_make_recording(&memory, &wish, &made, &error), SCREE_OK);
        if (error.status != SCREE_OK) printf("\n    seed %u: %s\n", (unsigned)seed, error.text);
        CU_ASSERT_EQUAL(made.recorder.recording.removal_count + 4, made.finest.vertex_count);
        stream_release_recording(&made);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
}

int suite_strip(void) {
    CU_pSuite suite = CU_add_suite("strip", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, every_mesh_can_be_stripped);
    return 0;
}
