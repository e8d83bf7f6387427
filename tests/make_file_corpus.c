/* make_file_corpus: writes small files of all kinds that people give, good ones, and a README about them, into a
 * folder. Usage: make_file_corpus FOLDER */
#include "tests/las_maker.h"
#include "tests/mesh_file_maker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_BYTES 16384
#define GRID_SIDE  7

static bool write_file(const char *folder, const char *name, const void *bytes, size_t size_bytes, const char *mode) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, mode);
    bool written = file != NULL && fwrite(bytes, 1, size_bytes, file) == size_bytes;
    if (file != NULL) written = fclose(file) == 0 && written;
    if (!written) perror(path);
    return written;
}

/* One file and its line in the README. */
static bool put_file(const char *folder, const char *name, const char *about, const void *bytes, size_t size_bytes) {
    char line[256];
    const int length = snprintf(line, sizeof line, "| %s | %s |\n", name, about);
    return write_file(folder, name, bytes, size_bytes, "wb") &&
           write_file(folder, "README.md", line, (size_t)length, "ab");
}

/* ---- clouds ---- */

static struct las_point some_point(uint32_t i) {
    return (struct las_point){.x = 500000 + (double)(i * 7919 % 97),
                              .y = 4000000 + (double)(i * 104729 % 89),
                              .z = 100 + (double)(i * 31 % 11),
                              .class_number = (uint8_t)(i % 3 == 0 ? 9 : 2),
                              .return_number = 1,
                              .return_count = (uint8_t)(1 + i % 2)};
}

static const struct {
    const char *name, *about;
    struct las_fixture fixture;
} clouds[] = {
    {"good-1-2.las",
     "LAS 1.2 with GeoTIFF's keys",
     {.version_minor = 2, .point_format = 1, .count = 24, .point = some_point, .epsg = 32611}},
    {"good-1-4.las",
     "LAS 1.4 with WKT behind the points",
     {.version_minor = 4,
      .point_format = 6,
      .count = 16,
      .point = some_point,
      .wkt = "LOCAL_CS[\"here\",UNIT[\"metre\",1]]",
      .wkt_is_extended = true}},
    {"good-1-0.las", "LAS 1.0", {.version_minor = 0, .point_format = 0, .count = 9, .point = some_point}},
};

static const struct {
    const char *name, *about, *text;
} texts[] = {
    {"good.xyz", "points with names of columns",
     "// points\nclass;Z;Easting;Northing\n2;1.5;0;0\n2;2;10;0\n9;3;0;10\n2;4;10;10\n2;-1;3;6\n2;7e0;6;3\n2;7;6;3\n"},
    {"line.xyz", "points on one line", "0 0 1\n1 1 2\n2 2 3\n3 3 4\n"},
    {"roof.obj", "a roof over a field", "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 2 2 5\nv 3 2 5\nv 2 3 5\nf 1 2 3\nf 4 5 6\n"},
    {"wall.obj", "a vertical face", "v 0 0 0\nv 9 0 0\nv 9 0 5\nv 0 9 0\nf 1 2 3\nf 1 2 4\n"},
    {"fin.off", "three triangles at an edge",
     "OFF\n5 3 0\n0 0 0\n4 0 0\n0 4 0\n0 -4 0\n1 3 5\n3 0 1 2\n3 0 3 1\n3 0 1 4\n"},
    {"touch.obj", "parts that meet at rounded points",
     "v 0 0 0\nv 3.333 1.111 0\nv 0 3 0\nv 1.667 .556 0\nv 2 -2 1\nf 1 2 3\nf 1 5 4\nf 4 5 2\n"},
};

/* A hilly square with every triangle there for itself, some turned over. */
static size_t make_hills(char *text) {
    size_t length = 0;
    for (int i = 0; i < GRID_SIDE * GRID_SIDE; i++) {
        const int x = i % GRID_SIDE, y = i / GRID_SIDE;
        const int corners[2][3][2] = {{{x, y}, {x + 1, y}, {x + 1, y + 1}}, {{x, y}, {x + 1, y + 1}, {x, y + 1}}};
        for (int t = 0; t < 2; t++) {
            for (int k = 0; k < 3; k++)
                length +=
                    (size_t)snprintf(text + length, MOST_BYTES - length, "v %d.%d %d.5 %d\n", corners[t][k][0],
                                     corners[t][k][1] % 3, corners[t][k][1], corners[t][k][0] * corners[t][k][1] % 5);
            length += (size_t)snprintf(text + length, MOST_BYTES - length, "%s\n", i % 5 ? "f -3 -2 -1" : "f -1 -2 -3");
        }
    }
    return length;
}

static const char heading[] = "# Files for tests\n\n"
                              "Made by `tests/make_file_corpus`, every byte of them; read by `tests/fuzz_files.c`. "
                              "finding-* came out of fuzzing.\n"
                              "\n"
                              "| file | what it is |\n|---|---|\n";

int main(int argc, char **argv) {
    static struct mesh_file_bytes made;
    static char hills[MOST_BYTES];
    if (argc != 2) {
        fprintf(stderr, "usage: make_file_corpus FOLDER\n");
        return 2;
    }
    bool fine = write_file(argv[1], "README.md", heading, sizeof heading - 1, "wb");
    for (size_t i = 0; i < MESH_FILE_KINDS && fine; i++) {
        made.size_bytes = 0;
        mesh_file_kinds[i].make(&made);
        fine = put_file(argv[1], mesh_file_kinds[i].name, mesh_file_kinds[i].about, made.bytes, made.size_bytes);
    }
    for (size_t i = 0; i < sizeof clouds / sizeof *clouds && fine; i++) {
        size_t size_bytes;
        unsigned char *bytes = las_make(&clouds[i].fixture, &size_bytes);
        fine = put_file(argv[1], clouds[i].name, clouds[i].about, bytes, size_bytes);
        free(bytes);
    }
    for (size_t i = 0; i < sizeof texts / sizeof *texts && fine; i++)
        fine = put_file(argv[1], texts[i].name, texts[i].about, texts[i].text, strlen(texts[i].text));
    if (fine)
        fine = put_file(argv[1], "hills.obj", "a surface whose triangles have nothing in common", hills,
                        make_hills(hills));
    return fine ? 0 : 1;
}
