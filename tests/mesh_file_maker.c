#include "tests/mesh_file_maker.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double mesh_file_square[4][3] = {{512345.678, 4412345.678, 12.5},
                                       {512346.678, 4412345.678, 12.625},
                                       {512346.678, 4412346.678, -3.1},
                                       {512345.678, 4412346.678, 0.1}};
const uint32_t mesh_file_corners[6] = {0, 1, 2, 0, 2, 3};

void mesh_file_put_text(struct mesh_file_bytes *made, const char *text) {
    size_t length = strlen(text);
    if (made->size_bytes + length > MESH_FILE_BYTES) abort();
    memcpy(made->bytes + made->size_bytes, text, length);
    made->size_bytes += length;
}

static void put_number(struct mesh_file_bytes *made, uint64_t bits, size_t size_bytes, bool is_big) {
    if (made->size_bytes + size_bytes > MESH_FILE_BYTES) abort();
    for (size_t i = 0; i < size_bytes; i++)
        made->bytes[made->size_bytes++] = (unsigned char)(bits >> 8 * (is_big ? size_bytes - 1 - i : i));
}

static void put_double(struct mesh_file_bytes *made, double value, bool is_big) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_number(made, bits, sizeof bits, is_big);
}

static void put_float(struct mesh_file_bytes *made, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_number(made, bits, sizeof bits, false);
}

/* ---- good files, one square each ---- */

static void make_obj(struct mesh_file_bytes *made) {
    mesh_file_put_text(made,
                       "# a square\nmtllib none.mtl\no square\n"
                       "v 512345.678 4412345.678 12.5\nv 512346.678 4412345.678 12.625 1.0\nvn 0 0 1\r\n"
                       "v 512346.678 4412346.678 -3.1\nv 5.12345678e5 4412346.678 .1\nf 1 2/1 3//1 -1/1/1 # all\n");
}

static void make_off(struct mesh_file_bytes *made) {
    mesh_file_put_text(made, "COFF # colours\n\n4 2 0\n512345.678 4412345.678 12.5 255 0 0\n# between\n\n"
                             "512346.678 4412345.678 12.625\n512346.678\t4412346.678 -3.1\n512345.678 4412346.678 0.1\n"
                             "3 0 1 2 0.5 0.5 0.5\n3 0 2 3");
}

static void make_stl_text(struct mesh_file_bytes *made) {
    static const char *const points[4] = {"512345.678 4412345.678 12.5", "512346.678 4412345.678 12.625",
                                          "512346.678 4412346.678 -3.1", "512345.678 4412346.678 0.1"};
    mesh_file_put_text(made, "solid my #1 vertex\n");
    for (int t = 0; t < 2; t++) {
        mesh_file_put_text(made, "facet normal 0 0 nan\n outer loop\n");
        for (int k = 0; k < 3; k++) {
            mesh_file_put_text(made, "  vertex ");
            mesh_file_put_text(made, points[mesh_file_corners[3 * t + k]]);
            mesh_file_put_text(made, "\n");
        }
        mesh_file_put_text(made, " endloop\nendfacet\n");
    }
    mesh_file_put_text(made, "endsolid my #1 vertex\n");
}

static void make_stl(struct mesh_file_bytes *made) {
    mesh_file_put_text(made, "solid but binary, as many are                                                   ");
    put_number(made, 2, 4, false);
    for (int t = 0; t < 2; t++) {
        for (int axis = 0; axis < 3; axis++) put_float(made, NAN);
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 3; axis++)
                put_float(made, (float)mesh_file_square[mesh_file_corners[3 * t + k]][axis]);
        put_number(made, 7, 2, false);
    }
}

static void make_ply_text(struct mesh_file_bytes *made) {
    mesh_file_put_text(
        made, "ply\r\nformat ascii 1.0\r\ncomment it's #1\r\nelement vertex 4\r\nproperty double x\r\n"
              "property double y\r\nproperty uchar red\r\nproperty double z\r\nproperty list uchar int near\r\n"
              "element face 1\r\nproperty float area\r\nproperty list uchar int vertex_indices\r\n"
              "element edge 1000000\r\nproperty int vertex1\r\nend_header\r\n"
              "512345.678 4412345.678 255 12.5 0\r\n512346.678 4412345.678 255 12.625 2 1 1\r\n"
              "512346.678 4412346.678 0 -3.1 1 2\r\n512345.678 4412346.678 0 0.1 0\r\n0.5 4 0 1 2 3");
}

static void make_ply_binary(struct mesh_file_bytes *made, bool is_big) {
    mesh_file_put_text(made, is_big ? "ply\nformat binary_big_endian 1.0\n" : "ply\nformat binary_little_endian 1.0\n");
    mesh_file_put_text(made,
                       "element material 1\nproperty int id\nelement face 2\nproperty list uint8 uint16 vertex_index\n"
                       "element vertex 4\nproperty short quality\nproperty float64 x\nproperty float64 y\n"
                       "property float64 z\nend_header\n");
    put_number(made, 5, 4, is_big);
    for (int t = 0; t < 2; t++) {
        put_number(made, 3, 1, is_big);
        for (int k = 0; k < 3; k++) put_number(made, mesh_file_corners[3 * t + k], 2, is_big);
    }
    for (int i = 0; i < 4; i++) {
        put_number(made, 0xfffe, 2, is_big);
        for (int axis = 0; axis < 3; axis++) put_double(made, mesh_file_square[i][axis], is_big);
    }
}

static void make_ply_little(struct mesh_file_bytes *made) {
    make_ply_binary(made, false);
}

static void make_ply_big(struct mesh_file_bytes *made) {
    make_ply_binary(made, true);
}

static void put_om_head(struct mesh_file_bytes *made, char mesh, unsigned version, uint32_t faces, uint32_t edges) {
    const char magic[] = {'O', 'M', mesh, '\0'};
    mesh_file_put_text(made, magic);
    put_number(made, version, 1, false);
    put_number(made, 4, 4, false);
    put_number(made, faces, 4, false);
    put_number(made, edges, 4, false);
    put_number(made, 0x5600, 2, false); /* points: three doubles each */
    for (int i = 0; i < 4; i++)
        for (int axis = 0; axis < 3; axis++) put_double(made, mesh_file_square[i][axis], false);
}

/* As OpenMesh writes it: 5 edges, each as two half-edges of next one, point at the end, face; then a property that
 * others made, and what closes the file. */
static void make_om(struct mesh_file_bytes *made) {
    static const signed char half_edges[10][3] = {{2, 1, 0}, {7, 0, -1},  /* 0-1 */
                                                  {4, 2, 0}, {1, 1, -1},  /* 1-2 */
                                                  {0, 0, 0}, {6, 2, 1},   /* 2-0 */
                                                  {8, 3, 1}, {3, 2, -1},  /* 2-3 */
                                                  {5, 0, 1}, {9, 3, -1}}; /* 3-0 */
    put_om_head(made, 'T', 0x42, 2, 5);
    put_number(made, 0x2602 + (6 << 5), 2, false); /* vertices' own property: a name, a type, a size, data */
    mesh_file_put_text(made, "\4rain\5float");
    put_number(made, 8, 4, false);
    mesh_file_put_text(made, "12345678");
    put_number(made, 0x16f8, 2, false);
    for (int i = 0; i < 10; i++)
        for (int k = 0; k < 3; k++) put_number(made, (unsigned char)half_edges[i][k], 1, false);
    put_number(made, 0x06e8, 2, false);
    mesh_file_put_text(made, "\4\10"); /* each face's half-edge */
    put_number(made, 0x001c, 2, false);
}

/* Of before 2.0, with the faces' corners: one polygon. */
static void make_old_om(struct mesh_file_bytes *made) {
    put_om_head(made, 'P', 0x22, 1, 4);
    put_number(made, 0x06e8, 2, false);
    put_number(made, 4, 2, false);
    for (unsigned i = 0; i < 4; i++) put_number(made, i, 1, false);
}

const struct mesh_file_kind mesh_file_kinds[MESH_FILE_KINDS] = {
    {"good.obj", "OBJ, with what does not count", make_obj, false, false},
    {"good.OFF", "OFF with colours and comments", make_off, false, false},
    {"text.stl", "STL as text", make_stl_text, false, true},
    {"good.stl", "binary STL that begins with solid", make_stl, true, true},
    {"text.ply", "PLY as text, a quad, with lists and elements that do not count", make_ply_text, false, false},
    {"little.ply", "binary PLY, faces first", make_ply_little, false, false},
    {"big.Ply", "the same the other way round", make_ply_big, false, false},
    {"good.om", "OM 2.2 of doubles, with a property of somebody's own", make_om, false, false},
    {"old.om", "OM 1.2, a polygon", make_old_om, false, false},
};
