/* Tests of LAS: every version and point format, files cut off at every length, headers that lie. */
#include "tests/las_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct las_point some_point(uint32_t i) {
    return (struct las_point){.x = 1000 - 0.25 * i,
                              .y = -2000 + 0.5 * i,
                              .z = i % 7,
                              .class_number = (uint8_t)(i % 20),
                              .return_number = (uint8_t)(1 + i % 5),
                              .return_count = 5,
                              .is_withheld = i % 11 == 3};
}

static const struct las_fixture small = {
    .version_minor = 2, .point_format = 0, .count = 6, .point = some_point, .epsg = 2949};

static enum scree_status read_header(const unsigned char *bytes, size_t size, struct las_header *header,
                                     struct scree_error *error) {
    *error = (struct scree_error){0};
    return las_header_read("a.las", bytes, size < LAS_HEADER_BYTES ? size : LAS_HEADER_BYTES, size, header, error);
}

static void check_points(const struct las_fixture *fixture) {
    struct las_header header;
    struct scree_error error;
    size_t size;
    unsigned char *bytes = las_make(fixture, &size);
    CU_ASSERT_EQUAL_FATAL(read_header(bytes, size, &header, &error), SCREE_OK);
    CU_ASSERT_EQUAL_FATAL(header.point_count, fixture->count);
    CU_ASSERT_EQUAL_FATAL(header.points_at + fixture->count * header.point_bytes, size);
    for (uint32_t i = 0; i < fixture->count; i++) {
        struct las_point is = las_point_read(&header, bytes + header.points_at + i * header.point_bytes);
        struct las_point was = some_point(i);
        CU_ASSERT_EQUAL(is.x, was.x);
        CU_ASSERT_EQUAL(is.y, was.y);
        CU_ASSERT_EQUAL(is.z, was.z);
        CU_ASSERT_EQUAL(is.class_number, was.class_number);
        CU_ASSERT_EQUAL(is.return_number, was.return_number);
        CU_ASSERT_EQUAL(is.return_count, was.return_count);
        CU_ASSERT_EQUAL(is.is_withheld, was.is_withheld);
    }
    free(bytes);
}

/* Formats came with versions: 0 and 1 with 1.0, 2 and 3 with 1.2, 4 and 5 with 1.3, the others with 1.4. */
static void test_versions_and_formats(void) {
    static const int last_format[] = {1, 1, 3, 5, 10};
    for (int minor = 0; minor <= 4; minor++)
        for (int format = 0; format <= last_format[minor]; format++) {
            struct las_fixture fixture = {.version_minor = minor,
                                          .point_format = format,
                                          .count = 40,
                                          .point = some_point,
                                          .offset = {900, -1900, 3},
                                          .epsg = 2949};
            check_points(&fixture);
            fixture.extra_bytes = 5;
            check_points(&fixture);
        }
}

static void test_truncated(void) {
    for (int minor = 2; minor <= 4; minor += 2) {
        struct las_fixture fixture = small;
        fixture.version_minor = minor;
        struct las_header header;
        struct scree_error error;
        size_t size;
        unsigned char *bytes = las_make(&fixture, &size);
        CU_ASSERT_EQUAL(read_header(bytes, size, &header, &error), SCREE_OK);
        for (size_t cut = 0; cut < size; cut++) {
            unsigned char *copy = malloc(cut > 0 ? cut : 1); /* as long as it is: sanitizers see what is read beyond */
            memcpy(copy, bytes, cut);
            enum scree_status status = read_header(copy, cut, &header, &error);
            CU_ASSERT_TRUE(status == SCREE_E_CORRUPT && strstr(error.text, "a.las") != NULL);
            free(copy);
        }
        free(bytes);
    }
}

/* One wrong number in a header that is fine otherwise. */
static const struct {
    size_t at;
    size_t count;
    const char *bytes;
    enum scree_status status;
    const char *word;
} lies[] = {
    {0, 4, "LASX", SCREE_E_CORRUPT, "no LAS"},
    {24, 1, "\2", SCREE_E_UNSUPPORTED, "LAS 2.4"},
    {25, 1, "\5", SCREE_E_UNSUPPORTED, "LAS 1.5"},
    {94, 2, "\1\0", SCREE_E_CORRUPT, "header"},
    {94, 2, "\377\377", SCREE_E_CORRUPT, "begin at byte"},
    {96, 4, "\0\0\0\0", SCREE_E_CORRUPT, "begin at byte"},
    {96, 4, "\377\377\377\377", SCREE_E_CORRUPT, "begin at byte"},
    {100, 4, "\377\377\377\377", SCREE_E_CORRUPT, "records"},
    {104, 1, "\200", SCREE_E_UNSUPPORTED, "laszip"},
    {104, 1, "\106", SCREE_E_UNSUPPORTED, "LAZ"},
    {104, 1, "\13", SCREE_E_UNSUPPORTED, "format 11"},
    {105, 2, "\0\0", SCREE_E_CORRUPT, "20 bytes at least"},
    {105, 2, "\23\0", SCREE_E_CORRUPT, "20 bytes at least"},
    {105, 2, "\377\377", SCREE_E_CORRUPT, "points"},
    {131, 8, "\0\0\0\0\0\0\0\0", SCREE_E_CORRUPT, "scale"},
    {131, 8, "\0\0\0\0\0\0\370\177", SCREE_E_CORRUPT, "scale"},
    {155, 8, "\0\0\0\0\0\0\360\177", SCREE_E_CORRUPT, "offset"},
    {235, 12, "\377\377\377\377\377\377\377\377\1\0\0\0", SCREE_E_CORRUPT, "extended"},
    {243, 4, "\1\0\0\0", SCREE_E_CORRUPT, "extended"},
    {247, 8, "\7\0\0\0\0\0\0\0", SCREE_E_CORRUPT, "7 points, but there are bytes for 6"},
    {247, 8, "\377\377\377\377\377\377\377\377", SCREE_E_CORRUPT, "cut off"},
};

static void test_lies(void) {
    struct las_fixture fixture = small;
    fixture.version_minor = 4;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        struct las_header header;
        struct scree_error error;
        size_t size;
        unsigned char *bytes = las_make(&fixture, &size);
        memcpy(bytes + lies[i].at, lies[i].bytes, lies[i].count);
        CU_ASSERT_EQUAL(read_header(bytes, size, &header, &error), lies[i].status);
        bool has_word = strstr(error.text, lies[i].word) != NULL;
        CU_ASSERT_TRUE(has_word);
        if (!has_word) printf("\n    lie %zu: \"%s\" lacks \"%s\"\n", i, error.text, lies[i].word);
        free(bytes);
    }
}

/* The count of 1.4 that has 64 bits counts; where it is 0, the old one does. */
static void test_counts(void) {
    struct las_fixture fixture = small;
    struct las_header header;
    struct scree_error error;
    size_t size;
    fixture.version_minor = 4;
    unsigned char *bytes = las_make(&fixture, &size);
    memset(bytes + 107, 0xFF, 4);
    CU_ASSERT_EQUAL(read_header(bytes, size, &header, &error), SCREE_OK);
    CU_ASSERT_EQUAL(header.point_count, 6);
    memcpy(bytes + 107, "\5\0\0\0", 4);
    memset(bytes + 247, 0, 8);
    CU_ASSERT_EQUAL(read_header(bytes, size, &header, &error), SCREE_OK);
    CU_ASSERT_EQUAL(header.point_count, 5);
    bytes[104] = 6;
    bytes[25] = 3;
    CU_ASSERT_EQUAL(read_header(bytes, size, &header, &error), SCREE_E_CORRUPT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "LAS 1.3 does not have"));
    free(bytes);
}

/* Every byte of the header with other values: an error, or points that are all in the file. */
static void test_any_byte(void) {
    struct las_fixture fixture = small;
    size_t size, fine = 0, refused = 0;
    fixture.version_minor = 4;
    unsigned char *bytes = las_make(&fixture, &size);
    for (size_t at = 0; at < LAS_HEADER_BYTES; at++)
        for (int value = 0; value < 256; value += 15) {
            struct las_header header;
            struct scree_error error;
            unsigned char kept = bytes[at];
            bytes[at] = (unsigned char)value;
            if (read_header(bytes, size, &header, &error) == SCREE_OK) {
                fine++;
                CU_ASSERT_TRUE(header.points_at + header.point_count * header.point_bytes <= size);
                for (uint64_t i = 0; i < header.point_count; i++)
                    las_point_read(&header, bytes + header.points_at + i * header.point_bytes);
            } else {
                refused++;
                CU_ASSERT_TRUE(error.status < 0 && error.text[0] != '\0');
            }
            bytes[at] = kept;
        }
    CU_ASSERT_TRUE(fine > 1000 && refused > 100);
    free(bytes);
}

int suite_las(void) {
    CU_pSuite suite = CU_add_suite("las", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_versions_and_formats);
    CU_ADD_TEST(suite, test_truncated);
    CU_ADD_TEST(suite, test_lies);
    CU_ADD_TEST(suite, test_counts);
    CU_ADD_TEST(suite, test_any_byte);
    return 0;
}
