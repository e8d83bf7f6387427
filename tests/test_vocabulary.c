/* The vocabulary that all rooms share: errors and budgeted memory. */
#include "stream/memory.h"

#include <CUnit/CUnit.h>
#include <scree/error.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static void test_first_failure_wins(void) {
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(scree_fail(&error, SCREE_E_IO, "%s: cannot be read", "a.tif"), SCREE_E_IO);
    CU_ASSERT_EQUAL(scree_fail(&error, SCREE_E_LIMIT, "what followed"), SCREE_E_LIMIT);
    CU_ASSERT_EQUAL(error.status, SCREE_E_IO);
    CU_ASSERT_EQUAL(error.offset_bytes, SCREE_NO_OFFSET);
    CU_ASSERT_STRING_EQUAL(error.text, "a.tif: cannot be read");
}

static void test_failure_at_an_offset(void) {
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(scree_fail_at(&error, SCREE_E_CORRUPT, 92, "index %d", 7), SCREE_E_CORRUPT);
    CU_ASSERT_EQUAL(error.offset_bytes, 92);
}

static void test_failure_without_context(void) {
    CU_ASSERT_EQUAL(scree_fail(NULL, SCREE_E_MEMORY, "nobody listens"), SCREE_E_MEMORY);
    CU_ASSERT_EQUAL(scree_fail_at(NULL, SCREE_E_CORRUPT, 1, "nobody listens"), SCREE_E_CORRUPT);
}

static void test_text_is_one_line_and_bounded(void) {
    struct scree_error error = {0};
    char longer[2 * sizeof error.text];
    memset(longer, 'x', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    scree_fail(&error, SCREE_E_IO, "two\nlines\r%s", longer);
    CU_ASSERT_EQUAL(strlen(error.text), sizeof error.text - 1);
    CU_ASSERT_PTR_NULL(strpbrk(error.text, "\r\n"));
}

static void test_every_status_has_its_own_text(void) {
    const enum scree_status statuses[] = {SCREE_OK,        SCREE_MORE,          SCREE_E_ARGUMENT,
                                          SCREE_E_MEMORY,  SCREE_E_LIMIT,       SCREE_E_IO,
                                          SCREE_E_CORRUPT, SCREE_E_UNSUPPORTED, SCREE_E_INTERRUPTED};
    const size_t count = sizeof statuses / sizeof *statuses;
    for (size_t i = 0; i < count; i++) {
        CU_ASSERT_STRING_NOT_EQUAL(scree_status_text(statuses[i]), "unknown error");
        for (size_t j = 0; j < i; j++)
            CU_ASSERT_STRING_NOT_EQUAL(scree_status_text(statuses[i]), scree_status_text(statuses[j]));
    }
    CU_ASSERT_STRING_EQUAL(scree_status_text((enum scree_status)99), "unknown error");
}

static void test_budget_counts_and_refuses(void) {
    struct scree_memory memory = {.limit_bytes = 1000};
    struct scree_error error = {0};
    unsigned char *first = scree_allocate(&memory, 60, 10, "the first", &error);
    CU_ASSERT_PTR_NOT_NULL_FATAL(first);
    for (size_t i = 0; i < 600; i++) CU_ASSERT_EQUAL(first[i], 0);
    CU_ASSERT_EQUAL(memory.used_bytes, 600);
    CU_ASSERT_PTR_NULL(scree_allocate(&memory, 401, 1, "the second", &error));
    CU_ASSERT_EQUAL(error.status, SCREE_E_LIMIT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "the second"));
    void *exact = scree_allocate(&memory, 400, 1, "the rest", NULL);
    CU_ASSERT_PTR_NOT_NULL(exact);
    scree_release(&memory, exact);
    scree_release(&memory, first);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    CU_ASSERT_EQUAL(memory.peak_bytes, 1000);
}

static void test_products_that_overflow_are_refused(void) {
    struct scree_memory memory = {0};
    const size_t counts[] = {SIZE_MAX, SIZE_MAX / 2 + 1, SIZE_MAX / 16 + 1};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        struct scree_error error = {0};
        CU_ASSERT_PTR_NULL(scree_allocate(&memory, counts[i], 16, "too many items", &error));
        CU_ASSERT_EQUAL(error.status, SCREE_E_LIMIT);
    }
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void test_nothing_is_a_valid_block(void) {
    struct scree_memory memory = {0};
    void *nothing = scree_allocate(&memory, 0, 16, "nothing", NULL);
    CU_ASSERT_PTR_NOT_NULL(nothing);
    scree_release(&memory, nothing);
    scree_release(&memory, NULL);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

static void test_reallocate_keeps_bytes_and_accounts(void) {
    struct scree_memory memory = {.limit_bytes = 100};
    struct scree_error error = {0};
    unsigned char *block = scree_reallocate(&memory, NULL, 40, 1, "a block", &error);
    CU_ASSERT_PTR_NOT_NULL_FATAL(block);
    memset(block, 7, 40);
    CU_ASSERT_PTR_NULL(scree_reallocate(&memory, block, 101, 1, "a block", &error));
    CU_ASSERT_EQUAL(error.status, SCREE_E_LIMIT);
    CU_ASSERT_EQUAL(memory.used_bytes, 40);
    block = scree_reallocate(&memory, block, 100, 1, "a block", NULL); /* the old 40 bytes do not count against it */
    CU_ASSERT_PTR_NOT_NULL_FATAL(block);
    CU_ASSERT_EQUAL(block[39], 7);
    block = scree_reallocate(&memory, block, 10, 1, "a block", NULL);
    CU_ASSERT_PTR_NOT_NULL_FATAL(block);
    CU_ASSERT_EQUAL(memory.used_bytes, 10);
    CU_ASSERT_EQUAL(memory.peak_bytes, 100);
    scree_release(&memory, block);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

/* A small user of the budget: three blocks or none. */
static enum scree_status three_blocks(struct scree_memory *memory, struct scree_error *error) {
    void *blocks[3] = {NULL, NULL, NULL};
    for (int i = 0; i < 3 && error->status == SCREE_OK; i++) blocks[i] = scree_allocate(memory, 8, 8, "a block", error);
    for (int i = 2; i >= 0; i--) scree_release(memory, blocks[i]);
    return error->status;
}

static void test_nth_request_fails(void) {
    uint64_t n = 0;
    enum scree_status status;
    do {
        struct scree_memory memory = {.fail_request = ++n};
        struct scree_error error = {0};
        status = three_blocks(&memory, &error);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
        CU_ASSERT(status == SCREE_OK || (status == SCREE_E_MEMORY && memory.requests == n));
    } while (status != SCREE_OK && n < 100);
    CU_ASSERT_EQUAL(n, 4); /* requests 1, 2 and 3 can fail */
}

static void test_failed_reallocate_leaves_the_block(void) {
    struct scree_memory memory = {.fail_request = 2};
    struct scree_error error = {0};
    unsigned char *block = scree_allocate(&memory, 4, 1, "a block", &error);
    CU_ASSERT_PTR_NOT_NULL_FATAL(block);
    block[3] = 9;
    CU_ASSERT_PTR_NULL(scree_reallocate(&memory, block, 4000, 1, "a block", &error));
    CU_ASSERT_EQUAL(error.status, SCREE_E_MEMORY);
    CU_ASSERT_EQUAL(block[3], 9);
    scree_release(&memory, block);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
}

int suite_vocabulary(void) {
    CU_TestInfo tests[] = {
        {"the first failure wins", test_first_failure_wins},
        {"a failure at an offset", test_failure_at_an_offset},
        {"a failure without a context", test_failure_without_context},
        {"the text is one line and bounded", test_text_is_one_line_and_bounded},
        {"every status has its own text", test_every_status_has_its_own_text},
        {"the budget counts and refuses", test_budget_counts_and_refuses},
        {"products that overflow are refused", test_products_that_overflow_are_refused},
        {"nothing is a valid block", test_nothing_is_a_valid_block},
        {"reallocate keeps bytes and accounts", test_reallocate_keeps_bytes_and_accounts},
        {"the n-th request fails", test_nth_request_fails},
        {"a failed reallocate leaves the block", test_failed_reallocate_leaves_the_block},
        CU_TEST_INFO_NULL,
    };
    CU_SuiteInfo suites[] = {{"vocabulary", NULL, NULL, NULL, NULL, tests}, CU_SUITE_INFO_NULL};
    return CU_register_suites(suites) == CUE_SUCCESS ? 0 : 1;
}
