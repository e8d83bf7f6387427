/* Tests of meshes as files: every format gives the triangles that are in it, coordinates to the last bit; what is no
 * mesh, lies about itself or is cut off gives one line that names it. */
#include "src/file_io.h"
#include "src/mesh_file_io.h"
#include "src/mesh_file_read.h"
#include "tests/mesh_file_maker.h"
#include "tests/suites.h"

#include <CUnit/CUnit.h>
#include <cpl_vsi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void put_file(const char *path, struct mesh_file_bytes *made) {
    VSIFCloseL(VSIFileFromMemBuffer(path, made->bytes, made->size_bytes, FALSE));
}

static enum scree_status read_made(const char *name, struct mesh_file_bytes *made, struct tin *tin,
                                   struct scree_error *error) {
    char path[256];
    snprintf(path, sizeof path, "/vsimem/%s", name);
    put_file(path, made);
    *error = (struct scree_error){0};
    enum scree_status status = mesh_file_read(path, tin, error);
    VSIUnlink(path);
    if (status == SCREE_OK) return status;
    CU_ASSERT_EQUAL(strncmp(error->text, path, strlen(path)), 0);
    CU_ASSERT_PTR_NULL(strchr(error->text, '\n'));
    CU_ASSERT_EQUAL(tin->memory->used_bytes, 0);
    return status;
}

static void check_square(const struct tin *tin, bool has_floats, bool has_own_corners) {
    CU_ASSERT_EQUAL(tin->point_count, has_own_corners ? 6 : 4);
    CU_ASSERT_EQUAL_FATAL(tin->triangle_count, 2);
    for (int i = 0; i < 6; i++) {
        const struct cloud_point *point = &tin->points[tin->corners[i]];
        const double *wanted = mesh_file_square[mesh_file_corners[i]];
        const double found[3] = {point->x, point->y, point->z};
        for (int axis = 0; axis < 3; axis++)
            CU_ASSERT_TRUE(has_floats ? (float)found[axis] == (float)wanted[axis] : found[axis] == wanted[axis]);
    }
}

static void test_formats(void) {
    for (size_t i = 0; i < MESH_FILE_KINDS; i++) {
        static struct mesh_file_bytes made;
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct scree_error error;
        made.size_bytes = 0;
        mesh_file_kinds[i].make(&made);
        CU_ASSERT_TRUE(mesh_file_is_mesh(mesh_file_kinds[i].name));
        if (read_made(mesh_file_kinds[i].name, &made, &tin, &error) == SCREE_OK)
            check_square(&tin, mesh_file_kinds[i].has_floats, mesh_file_kinds[i].has_own_corners);
        else
            CU_FAIL(error.text);
        tin_release(&tin);
        CU_ASSERT_EQUAL(memory.used_bytes, 0);
    }
    CU_ASSERT_FALSE(mesh_file_is_mesh("a.tif") || mesh_file_is_mesh("ply") || mesh_file_is_mesh("a.ply/b"));
}

/* What OpenMesh writes we read, from archives too. */
static void test_written(void) {
    static const char *const endings[] = {"ply", "obj", "off", "stl"};
    char folder[] = "mesh-files-XXXXXX", path[64];
    double xyz[12];
    for (int i = 0; i < 12; i++) xyz[i] = (float)mesh_file_square[i / 3][i % 3];
    CU_ASSERT_PTR_NOT_NULL_FATAL(mkdtemp(folder));
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct scree_error error = {0};
        snprintf(path, sizeof path, "%s/a.%s", folder, endings[i]);
        CU_ASSERT_EQUAL(mesh_file_write(path, xyz, 4, mesh_file_corners, 2, &error), SCREE_OK);
        CU_ASSERT_EQUAL(mesh_file_read(path, &tin, &error), SCREE_OK);
        if (error.status == SCREE_OK) check_square(&tin, true, i == 3);
        tin_release(&tin);
        unlink(path);
    }
    static struct mesh_file_bytes made = {.size_bytes = 0};
    struct scree_memory memory = {0};
    struct tin tin = {.memory = &memory};
    struct scree_error error = {0};
    for (size_t i = 0; i < MESH_FILE_KINDS; i++)
        if (strcmp(mesh_file_kinds[i].name, "big.Ply") == 0) mesh_file_kinds[i].make(&made);
    VSILFILE *archive = VSIFOpenL("/vsizip/vsimem/a.zip/b.ply", "wb");
    CU_ASSERT_PTR_NOT_NULL_FATAL(archive);
    CU_ASSERT_EQUAL(VSIFWriteL(made.bytes, 1, made.size_bytes, archive), made.size_bytes);
    VSIFCloseL(archive);
    CU_ASSERT_EQUAL(mesh_file_read("/vsizip/vsimem/a.zip/b.ply", &tin, &error), SCREE_OK);
    if (error.status == SCREE_OK) check_square(&tin, false, false);
    tin_release(&tin);
    VSIUnlink("/vsimem/a.zip");
    rmdir(folder);
}

/* ---- bad files ---- */

static const char ply_start[] = "ply\nformat ascii 1.0\n";

static const struct {
    const char *name, *text, *word;
    enum scree_status status;
} bads[] = {
    {"a.ply", "", "does not begin", SCREE_E_CORRUPT},
    {"a.ply", "plymouth\n", "does not begin", SCREE_E_CORRUPT},
    {"a.ply", "ply\nelement vertex 3\nend_header\n", "no format", SCREE_E_CORRUPT},
    {"a.ply", "ply\nformat ebcdic 1.0\n", "line 2: a format", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 3\n", "no end", SCREE_E_CORRUPT},
    {"a.ply", "@property double x\nend_header\n", "without an element", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex -3\nend_header\n", "line 3", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 3\nproperty quad x\nend_header\n", "line 4: a property", SCREE_E_CORRUPT},
    {"a.ply", "@element face 3\nproperty list float int vertex_indices\nend_header\n", "line 4", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 3\nproperty double x\nproperty double y\nend_header\n1 2\n", "x, y and z",
     SCREE_E_CORRUPT},
    {"a.ply", "@what\nend_header\n", "line 3", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 4294967295\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
     "too short", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 nan 0\n",
     "vertex 1 of 1", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 1e300 0\n",
     "no position", SCREE_E_CORRUPT},
    {"a.ply", "@element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 1 0\n",
     "no triangles", SCREE_E_CORRUPT},
    {"a.ply", "@element face 1\nproperty list int int vertex_indices\nend_header\n3 0 1 2\n", "there are 0",
     SCREE_E_CORRUPT},
    {"a.ply", "@element face 1\nproperty list int int vertex_indices\nend_header\n3 0 1 -2\n", "point -2",
     SCREE_E_CORRUPT},
    {"a.ply", "@element face 1\nproperty list int int vertex_indices\nend_header\n3 0 1 1e99\n", "face 1 of 1",
     SCREE_E_CORRUPT},
    {"a.ply", "@element face 1\nproperty list int int vertex_indices\nend_header\n4000000000 0 1 2\n", "face 1 of 1",
     SCREE_E_CORRUPT},
    {"a.ply", "@element nothing 4000000000\nend_header\n", "no triangles", SCREE_E_CORRUPT},
    {"a.obj", "", "no triangles", SCREE_E_CORRUPT},
    {"a.obj", "<html>\n<body>\n", "no triangles", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2\n", "line 1: a point", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2 inf\n", "line 1", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2 3\nf 1 0 1\n", "line 2: a face", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2 3\nf 1 1 -2\n", "point -1", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2 3\nf 1 1 2\n", "there are 1", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2 3\nf 1 1 99999999999999999999\n", "line 2", SCREE_E_CORRUPT},
    {"a.obj", "v 1 2 3\nf 1 1 4294967297\n", "point 4294967296", SCREE_E_CORRUPT},
    {"a.obj", "f a b c\n", "line 1", SCREE_E_CORRUPT},
    {"a.off", "", "does not begin", SCREE_E_CORRUPT},
    {"a.off", "4OFF\n1 1 1\n", "does not begin", SCREE_E_CORRUPT},
    {"a.off", "OFF BINARY\n", "binary OFF", SCREE_E_UNSUPPORTED},
    {"a.off", "OFF\nmany\n", "line 2", SCREE_E_CORRUPT},
    {"a.off", "OFF\n3\n", "number of faces", SCREE_E_CORRUPT},
    {"a.off", "OFF\n0 4000000000 0\n", "too short", SCREE_E_CORRUPT},
    {"a.off", "OFF\n4000000000 0 0\n", "too short", SCREE_E_CORRUPT},
    {"a.off", "OFF\n-1 1 0\n", "too short", SCREE_E_CORRUPT},
    {"a.off", "OFF\n1 1 0\n0 0 x\n3 0 0 0\n", "line 3: a point", SCREE_E_CORRUPT},
    {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0\n", "fewer corners", SCREE_E_CORRUPT},
    {"a.off", "OFF\n1 2 0\n0 0 0\n3 0 0 0\n", "a face is missing", SCREE_E_CORRUPT},
    {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "there are 1", SCREE_E_CORRUPT},
    {"a.off", "OFF\n1 1 0\n0 0 0\n-3 0 0 1\n", "line 4", SCREE_E_CORRUPT},
    {"a.stl", "", "too short", SCREE_E_CORRUPT},
    {"a.stl", "solid\n", "endsolid", SCREE_E_CORRUPT},
    {"a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "line 4", SCREE_E_CORRUPT},
    {"a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n", "three vertices", SCREE_E_CORRUPT},
    {"a.stl", "solid\nvertex 0 0 0\n", "outside of a loop", SCREE_E_CORRUPT},
    {"a.stl", "solid\nfact\n", "line 2", SCREE_E_CORRUPT},
    {"a.stl", "solid\nendsolid\n", "no triangles", SCREE_E_CORRUPT},
    {"a.stl",
     "A model of 80 bytes and a number that says more triangles than there are bytes for; these.\n"
     "And more and more and more and more of them.\n",
     "cut off", SCREE_E_CORRUPT},
    {"a.om", "", "does not begin", SCREE_E_CORRUPT},
    {"a.om", "OMX\002", "does not begin", SCREE_E_CORRUPT},
    {"a.om", "OMT\x42", "cut off", SCREE_E_CORRUPT},
    {"a.om", "OMT\x43 more of this", "later version", SCREE_E_UNSUPPORTED},
    {"a.om", "OMT\x42\1\1\1\1\1\1\1\1\1\1\1\1ab", "cut off", SCREE_E_CORRUPT},
};

static void test_bad(void) {
    for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
        static struct mesh_file_bytes made;
        struct scree_memory memory = {0};
        struct tin tin = {.memory = &memory};
        struct scree_error error;
        made.size_bytes = 0;
        if (bads[i].text[0] == '@') mesh_file_put_text(&made, ply_start);
        mesh_file_put_text(&made, bads[i].text + (bads[i].text[0] == '@'));
        CU_ASSERT_EQUAL(read_made(bads[i].name, &made, &tin, &error), bads[i].status);
        if (strstr(error.text, bads[i].word) == NULL) {
            printf("\n%zu: %s\n", i, error.text);
            CU_FAIL("another reason");
        }
        CU_ASSERT_TRUE(memory.peak_bytes < 200000);
    }
    struct scree_memory memory = {.limit_bytes = 3000};
    struct tin tin = {.memory = &memory};
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(mesh_file_read("/vsimem/none.ply", &tin, &error), SCREE_E_IO);
    CU_ASSERT_STRING_EQUAL(error.text, "/vsimem/none.ply: there is no such file");
    error = (struct scree_error){0};
    CU_ASSERT_EQUAL(mesh_file_read("a.tif", &tin, &error), SCREE_E_ARGUMENT);
    error = (struct scree_error){0};
    VSIMkdir("/vsimem/folder.ply", 0755);
    CU_ASSERT_EQUAL(mesh_file_read("/vsimem/folder.ply", &tin, &error), SCREE_E_IO);
    CU_ASSERT_STRING_EQUAL(error.text, "/vsimem/folder.ply: is no file");
    VSIRmdir("/vsimem/folder.ply");
    static struct mesh_file_bytes many = {.size_bytes = 0};
    mesh_file_put_text(&many, "v 0 0 0\nf");
    for (int i = 0; i <= MESH_MOST_CORNERS; i++) mesh_file_put_text(&many, " 1");
    memory.limit_bytes = 0;
    CU_ASSERT_EQUAL(read_made("many.obj", &many, &tin, &error), SCREE_E_UNSUPPORTED);
    memory.limit_bytes = 3000;
    CU_ASSERT_EQUAL(read_made("large.obj", &many, &tin, &error), SCREE_E_LIMIT);
}

/* Every beginning of every good file, and every change of one byte: a surface with corners that are points, or one line
 * about the file. */
static void test_damaged(void) {
    static const unsigned char others[] = {0x00, 0x01, 0x7f, 0x80, 0xff, ' ', '\n', '9', '-'};
    static struct mesh_file_bytes good, made;
    uint64_t accepted = 0, refused = 0;
    for (size_t i = 0; i < MESH_FILE_KINDS; i++) {
        good.size_bytes = 0;
        mesh_file_kinds[i].make(&good);
        for (size_t at = 0; at < good.size_bytes; at++)
            for (size_t k = 0; k <= sizeof others; k++) {
                struct scree_memory memory = {0};
                struct tin tin = {.memory = &memory};
                struct scree_error error;
                made = good;
                if (k == sizeof others)
                    made.size_bytes = at;
                else
                    made.bytes[at] = others[k];
                if (read_made(mesh_file_kinds[i].name, &made, &tin, &error) == SCREE_OK) {
                    accepted++;
                    for (size_t c = 0; c < 3 * (size_t)tin.triangle_count; c++)
                        CU_ASSERT_TRUE_FATAL(tin.corners[c] < tin.point_count);
                } else {
                    refused++;
                }
                tin_release(&tin);
            }
    }
    CU_ASSERT_TRUE(accepted > 1000 && refused > 1000);
}

static void test_no_memory(void) {
    for (size_t i = 0; i < MESH_FILE_KINDS; i++) {
        static struct mesh_file_bytes made;
        enum scree_status status = SCREE_E_MEMORY;
        made.size_bytes = 0;
        mesh_file_kinds[i].make(&made);
        uint64_t n = 1;
        for (; status == SCREE_E_MEMORY && n < 50; n++) {
            struct scree_memory memory = {.fail_request = n};
            struct tin tin = {.memory = &memory};
            struct scree_error error;
            status = read_made(mesh_file_kinds[i].name, &made, &tin, &error);
            tin_release(&tin);
        }
        CU_ASSERT_EQUAL(status, SCREE_OK);
        CU_ASSERT_TRUE(n > 3);
    }
}

int suite_mesh_files(void) {
    CU_pSuite suite = CU_add_suite("mesh_files", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, test_formats);
    CU_ADD_TEST(suite, test_written);
    CU_ADD_TEST(suite, test_bad);
    CU_ADD_TEST(suite, test_damaged);
    CU_ADD_TEST(suite, test_no_memory);
    return 0;
}
