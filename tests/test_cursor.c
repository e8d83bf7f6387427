/* The byte cursors: values, order of bytes, and what happens at and after the end. */
#include "stream/cursor.h"

#include <CUnit/CUnit.h>
#include <stdlib.h>
#include <string.h>

static void what_is_written_is_read(void) {
    unsigned char bytes[64];
    struct scree_writer writer = scree_writer(bytes, sizeof bytes);
    scree_write_u8(&writer, 0xab);
    scree_write_u16(&writer, 0x1234);
    scree_write_align(&writer, 4);
    scree_write_u32(&writer, 0xdeadbeef);
    scree_write_u64(&writer, 0x0123456789abcdef);
    scree_write_f32(&writer, -1.5f);
    scree_write_f64(&writer, 0.1);
    scree_write_bytes(&writer, "end", 3);
    CU_ASSERT_FALSE(writer.ran_out);
    CU_ASSERT_EQUAL(writer.at_bytes, 1 + 2 + 1 + 4 + 8 + 4 + 8 + 3);
    CU_ASSERT_EQUAL(bytes[1], 0x34); /* little-endian on every machine */
    CU_ASSERT_EQUAL(bytes[3], 0);

    struct scree_reader reader = scree_reader(bytes, writer.at_bytes);
    CU_ASSERT_EQUAL(scree_read_u8(&reader), 0xab);
    CU_ASSERT_EQUAL(scree_read_u16(&reader), 0x1234);
    scree_read_align(&reader, 4);
    CU_ASSERT_EQUAL(scree_read_u32(&reader), 0xdeadbeef);
    CU_ASSERT_EQUAL(scree_read_u64(&reader), 0x0123456789abcdef);
    CU_ASSERT_EQUAL(scree_read_f32(&reader), -1.5f);
    CU_ASSERT_EQUAL(scree_read_f64(&reader), 0.1);
    const unsigned char *end = scree_read_bytes(&reader, 3);
    CU_ASSERT_PTR_NOT_NULL_FATAL(end);
    CU_ASSERT_EQUAL(memcmp(end, "end", 3), 0);
    CU_ASSERT_EQUAL(scree_reader_left(&reader), 0);
    CU_ASSERT_FALSE(reader.ran_out);
}

/* Exact-size copies on the heap, so that a sanitizer sees a read beyond the end. */
static void running_out_is_remembered(void) {
    for (size_t size_bytes = 0; size_bytes < 12; size_bytes++) {
        unsigned char *bytes = malloc(size_bytes + (size_bytes == 0));
        memset(bytes, 0xff, size_bytes);
        struct scree_reader reader = scree_reader(bytes, size_bytes);
        uint32_t first = scree_read_u32(&reader);
        uint64_t second = scree_read_u64(&reader);
        CU_ASSERT_EQUAL(first, size_bytes < 4 ? 0 : UINT32_MAX);
        CU_ASSERT_EQUAL(second, 0);
        CU_ASSERT_TRUE(reader.ran_out);
        CU_ASSERT_EQUAL(scree_reader_left(&reader), 0);
        CU_ASSERT_EQUAL(scree_read_u8(&reader), 0); /* even where a byte is left: the record was cut */
        CU_ASSERT_PTR_NULL(scree_read_bytes(&reader, 0));
        free(bytes);
    }
}

static void counts_are_compared_without_overflow(void) {
    unsigned char bytes[10] = {0};
    struct scree_reader reader = scree_reader(bytes, sizeof bytes);
    CU_ASSERT_TRUE(scree_reader_holds(&reader, 5, 2));
    CU_ASSERT_FALSE(scree_reader_holds(&reader, 6, 2));
    CU_ASSERT_TRUE(scree_reader_holds(&reader, 0, 8));
    CU_ASSERT_FALSE(scree_reader_holds(&reader, UINT64_MAX, 8));
    CU_ASSERT_FALSE(scree_reader_holds(&reader, (UINT64_C(1) << 63) + 1, 2));
    CU_ASSERT_PTR_NULL(scree_read_bytes(&reader, SIZE_MAX));
    CU_ASSERT_TRUE(reader.ran_out);
    CU_ASSERT_FALSE(scree_reader_holds(&reader, 1, 1));
}

static void alignment_at_the_end_runs_out(void) {
    unsigned char bytes[3] = {0};
    struct scree_reader reader = scree_reader(bytes, sizeof bytes);
    scree_read_u8(&reader);
    scree_read_align(&reader, 2);
    CU_ASSERT_EQUAL(reader.at_bytes, 2);
    scree_read_align(&reader, 2);
    CU_ASSERT_EQUAL(reader.at_bytes, 2);
    CU_ASSERT_FALSE(reader.ran_out);
    scree_read_u8(&reader);
    scree_read_align(&reader, 4);
    CU_ASSERT_TRUE(reader.ran_out);
}

static void a_full_writer_drops_the_rest(void) {
    unsigned char *bytes = malloc(6);
    struct scree_writer writer = scree_writer(bytes, 6);
    scree_write_u32(&writer, 1);
    scree_write_u32(&writer, 2);
    CU_ASSERT_TRUE(writer.ran_out);
    CU_ASSERT_EQUAL(writer.at_bytes, 4);
    scree_write_u8(&writer, 3); /* would fit, but what came before it does not exist */
    scree_write_align(&writer, 8);
    CU_ASSERT_EQUAL(writer.at_bytes, 4);
    free(bytes);
}

int suite_cursor(void) {
    CU_pSuite suite = CU_add_suite("cursor", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, what_is_written_is_read);
    CU_ADD_TEST(suite, running_out_is_remembered);
    CU_ADD_TEST(suite, counts_are_compared_without_overflow);
    CU_ADD_TEST(suite, alignment_at_the_end_runs_out);
    CU_ADD_TEST(suite, a_full_writer_drops_the_rest);
    return 0;
}
