/* make_corpus FOLDER: writes the streams of tests/corpus/stream and their README.md. good-* are streams, bad-* are
 * corrupt, unsupported-* well formed but of another kind than version 1 knows. Those there are kept as they are: what
 * could be read once has to be readable for ever. New kinds are added to the lists below. */
#include "tests/stream_forge.h"
#include "tests/stream_maker.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 4096, SIDE = 48, STRIDE = SIDE + 3, PATH_BYTES = 1024 };

struct file {
    unsigned char bytes[2 * MAX_BYTES];
    size_t size_bytes;
};

/* ---- good ones ---- */

enum surface { FRACTAL, FLAT, RAMP, SPIKE, CLIFF, DEEP };

static const struct good {
    const char *name, *about;
    enum surface surface;
    struct stream_wish wish;
    uint32_t rungs_per_increment;
} goods[] = {
    {"example",
     "the worked example of docs/stream.md",
     FRACTAL,
     {.seed = 10, .columns = 3, .rows = 2, .profile = SCREE_LOCAL, .finest_m = 5.66, .rungs = 3},
     1},
    {"flat", "two triangles, one rung", FLAT, {.columns = 8, .rows = 8, .finest_m = 1, .rungs = 1}, 1},
    {"flat-rungs",
     "two triangles at ten rungs: blocks that add nothing",
     FLAT,
     {.columns = 8, .rows = 8, .finest_m = 1, .rungs = 10},
     1},
    {"one-step", "the smallest tile", FRACTAL, {.seed = 2, .columns = 1, .rows = 1, .finest_m = 1, .rungs = 2}, 1},
    {"ramp", "a plane that is not level", RAMP, {.columns = 16, .rows = 16, .finest_m = 0.25, .rungs = 2}, 1},
    {"spike", "one high post", SPIKE, {.columns = 16, .rows = 16, .finest_m = 1, .rungs = 30}, 1},
    {"cliff", "a wall along a line of posts", CLIFF, {.columns = 24, .rows = 24, .finest_m = 4, .rungs = 12}, 1},
    {"deep", "heights below zero", DEEP, {.columns = 16, .rows = 16, .finest_m = 2, .rungs = 8}, 1},
    {"row", "one step high, forty wide", FRACTAL, {.seed = 3, .columns = 40, .rows = 1, .finest_m = 1, .rungs = 12}, 1},
    {"column",
     "one step wide, forty high",
     FRACTAL,
     {.seed = 3, .columns = 1, .rows = 40, .finest_m = 1, .rungs = 12},
     1},
    {"uneven", "23 by 41 steps", FRACTAL, {.seed = 4, .columns = 23, .rows = 41, .finest_m = 4, .rungs = 20}, 1},
    {"geodetic",
     "a tile of the globe",
     FRACTAL,
     {.seed = 6, .columns = 32, .rows = 32, .profile = SCREE_GEODETIC, .finest_m = 4, .rungs = 16},
     1},
    {"local",
     "a tile of a projected raster",
     FRACTAL,
     {.seed = 7, .columns = 32, .rows = 32, .profile = SCREE_LOCAL, .finest_m = 4, .rungs = 16},
     1},
    {"all-posts",
     "every post that is not on a plane",
     FRACTAL,
     {.seed = 8, .columns = 24, .rows = 24, .finest_m = 0.01, .rungs = 40},
     1},
    {"base-only", "a single mesh", FRACTAL, {.seed = 9, .columns = 32, .rows = 32, .finest_m = 8, .rungs = 1}, 1},
    {"merged",
     "four rungs an increment",
     FRACTAL,
     {.seed = 7, .columns = 32, .rows = 32, .finest_m = 4, .rungs = 17},
     4},
    {"one-increment",
     "all rungs in one increment",
     FRACTAL,
     {.seed = 7, .columns = 32, .rows = 32, .finest_m = 4, .rungs = 17},
     255},
    {"fine-heights",
     "steps of 1/16 m",
     FRACTAL,
     {.seed = 10, .columns = 20, .rows = 20, .height_exponent = -4, .finest_m = 3, .rungs = 10},
     1},
    {"coarse-heights",
     "steps of 64 m",
     FRACTAL,
     {.seed = 11, .columns = 32, .rows = 32, .height_exponent = 6, .finest_m = 64, .rungs = 10},
     1},
    {"many-rungs", "sixty rungs", FRACTAL, {.seed = 12, .columns = 16, .rows = 16, .finest_m = 0.5, .rungs = 60}, 1},
    {"wide-posts",
     "a kilometre from post to post",
     FRACTAL,
     {.seed = 13, .columns = 24, .rows = 24, .spacing_m = 1000, .finest_m = 8, .rungs = 12},
     1},
    {"coarse",
     "tolerances from 40 m on",
     FRACTAL,
     {.seed = 14, .columns = 48, .rows = 48, .finest_m = 40, .rungs = 12},
     1},
};

static void fill(enum surface surface, float *heights_m) {
    for (int y = 0; y < STRIDE; y++)
        for (int x = 0; x < STRIDE; x++) {
            float *at = &heights_m[y * STRIDE + x];
            *at = 100;
            if (surface == RAMP) *at = (float)(3 * x + 2 * y);
            if (surface == SPIKE) *at = x == 8 && y == 6 ? 2000 : 0;
            if (surface == CLIFF) *at = 2 * x + y > 30 ? (float)(500 + x % 3) : (float)(y % 4);
            if (surface == DEEP) *at = (float)(-4000 - 7 * ((x * x + 3 * y * y) % 50));
        }
}

static bool make_good(const struct good *good, struct file *file) {
    static float heights_m[STRIDE * STRIDE];
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    struct stream_wish wish = good->wish;
    const struct encode_options options = {.rungs_per_increment = good->rungs_per_increment};
    unsigned char *bytes = NULL;
    if (good->surface != FRACTAL) {
        fill(good->surface, heights_m);
        wish.heights_m = heights_m + STRIDE + 1;
        wish.stride = STRIDE;
    }
    stream_make(&memory, &wish, &options, &bytes, &file->size_bytes, &error);
    if (error.status == SCREE_OK && file->size_bytes > MAX_BYTES)
        scree_fail(&error, SCREE_E_LIMIT, "%zu bytes are too many for the corpus", file->size_bytes);
    if (error.status == SCREE_OK)
        memcpy(file->bytes, bytes, file->size_bytes);
    else
        fprintf(stderr, "make_corpus: good-%s: %s\n", good->name, error.text);
    scree_release(&memory, bytes);
    return error.status == SCREE_OK;
}

/* ---- altered ones ---- */

enum alteration {
    FIELD,      /* `width` bytes at `at` become `value`, with the checksums made true */
    DAMAGE,     /* the same, checksums left as they were */
    RUNG_FIELD, /* the same as FIELD, of rung `rung` */
    SHRINK,     /* the last block loses `width` bytes at its end, the header agrees */
    GROW,       /* it gains `width` bytes `value`, the header agrees */
    TRAIL,      /* a byte follows the stream */
    SWAP,       /* blocks 1 and 2 change places, with their checksums */
    REPEAT,     /* block 2 is block 1 again */
    NOISE,      /* the bytes of block `rung` are replaced by chance, checksums made true */
    ZEROS,      /* by zeros */
    ONES,       /* by 0xff */
    FLIP,       /* bit `value` of byte `at` of block `rung` is flipped, checksums made true */
    EXTEND,     /* an extension of type `value` is put behind the rungs; `width` bytes of it, `at` of them stated */
};

static const struct altered {
    const char *name, *about;
    enum alteration alteration;
    size_t at;
    int width;
    uint64_t value;
    uint32_t rung;
} altereds[] = {
    {"good-extension", "an extension that may be skipped", EXTEND, 5, 5, 7, 0},
    {"bad-magic", "another first byte", FIELD, 0, 1, 0x88, 0},
    {"bad-line-end", "a copy as text: CR LF became LF LF", FIELD, 6, 1, 0x0a, 0},
    {"bad-header-size", "one byte less than the rungs take", FIELD, FORGE_HEADER_BYTES, 2, 300, 0},
    {"bad-header-huge", "a header of 65,535 bytes", FIELD, FORGE_HEADER_BYTES, 2, 65535, 0},
    {"bad-no-rungs", "no rung", FIELD, FORGE_RUNG_COUNT, 2, 0, 0},
    {"bad-too-many-rungs", "65,535 rungs", FIELD, FORGE_RUNG_COUNT, 2, 65535, 0},
    {"bad-header-checksum", "a damaged header", DAMAGE, FORGE_WEST, 1, 0x55, 0},
    {"bad-zoom", "zoom 200", FIELD, FORGE_ZOOM, 1, 200, 0},
    {"bad-tile", "tile number 2^32 - 1", FIELD, FORGE_TILE_X, 4, UINT32_MAX, 0},
    {"bad-no-columns", "0 columns", FIELD, FORGE_COLUMNS, 4, 0, 0},
    {"bad-columns-negative", "-1 columns", FIELD, FORGE_COLUMNS, 4, UINT32_MAX, 0},
    {"bad-rows-huge", "2^31 - 1 rows", FIELD, FORGE_ROWS, 4, INT32_MAX, 0},
    {"bad-height-step", "steps of 2^127 m", FIELD, FORGE_EXPONENT, 1, 127, 0},
    {"bad-west-nan", "no number for a place", FIELD, FORGE_WEST, 8, 0x7ff8000000000000, 0},
    {"bad-metres-infinite", "infinite steps", FIELD, FORGE_METRES_X, 8, 0x7ff0000000000000, 0},
    {"bad-metres-negative", "negative steps", FIELD, FORGE_METRES_Y, 8, 0xbff0000000000000, 0},
    {"bad-vertices-huge", "2^32 - 1 vertices", RUNG_FIELD, FORGE_VERTICES, 4, UINT32_MAX, 3},
    {"bad-vertices-fall", "fewer vertices than the rung before", RUNG_FIELD, FORGE_VERTICES, 4, 4, 3},
    {"bad-vertices-more", "one vertex more than the block adds", RUNG_FIELD, FORGE_VERTICES, 4, 0, 15},
    {"bad-triangles-huge", "2^32 - 1 triangles", RUNG_FIELD, FORGE_TRIANGLES, 4, UINT32_MAX, 3},
    {"bad-triangles-few", "fewer triangles than vertices", RUNG_FIELD, FORGE_TRIANGLES, 4, 2, 0},
    {"bad-rungs-descend", "a rung of the ladder below the one before", RUNG_FIELD, 0, 2, 0x8000, 2},
    {"bad-svo-nan", "no number for an error", RUNG_FIELD, FORGE_SVO, 4, 0x7fc00000, 1},
    {"bad-svo-grows", "an SVO that grows with detail", RUNG_FIELD, FORGE_SVO, 4, 0x7f000000, 4},
    {"bad-error-negative", "a negative error", RUNG_FIELD, FORGE_ERROR, 4, 0xbf800000, 1},
    {"bad-mmqe-infinite", "an infinite MMQE", RUNG_FIELD, FORGE_MMQE, 4, 0x7f800000, 1},
    {"bad-block-empty", "a block of no bytes that adds vertices", RUNG_FIELD, FORGE_BLOCK_BYTES, 4, 0, 5},
    {"bad-block-checksum", "a checksum that lies", RUNG_FIELD, FORGE_BLOCK_CHECKSUM, 4, 0, 5},
    {"bad-block-shifted", "a block of a byte more than it has", RUNG_FIELD, FORGE_BLOCK_BYTES, 4, 40, 4},
    {"bad-block-short", "the last block without its last eight bytes", SHRINK, 0, 8, 0, 0},
    {"bad-block-long", "a last block with eight bytes too many", GROW, 0, 8, 0x5a, 0},
    {"bad-block-long-zeros", "a last block with eight zeros too many", GROW, 0, 8, 0, 0},
    {"bad-trailing", "a byte behind the end", TRAIL, 0, 0, 0x0a, 0},
    {"bad-swapped", "two blocks in the wrong order", SWAP, 0, 0, 0, 0},
    {"bad-repeated", "a block twice", REPEAT, 0, 0, 0, 0},
    {"bad-base-noise", "a base mesh of chance bytes", NOISE, 0, 0, 0, 0},
    {"bad-base-zeros", "a base mesh of zeros", ZEROS, 0, 0, 0, 0},
    {"bad-base-ones", "a base mesh of ones", ONES, 0, 0, 0, 0},
    {"bad-increment-noise", "an increment of chance bytes", NOISE, 0, 0, 0, 9},
    {"bad-increment-zeros", "an increment of zeros", ZEROS, 0, 0, 0, 9},
    {"bad-increment-ones", "an increment of ones", ONES, 0, 0, 0, 9},
    {"bad-last-noise", "a last increment of chance bytes", NOISE, 0, 0, 0, 15},
    {"bad-base-flip", "a bit of the base mesh, with its checksum made true", FLIP, 2, 0, 3, 0},
    {"bad-increment-flip", "a bit of an increment, with its checksum made true", FLIP, 3, 0, 6, 7},
    {"bad-first-flip", "the first bit of an increment, with its checksum made true", FLIP, 0, 0, 7, 12},
    {"bad-extension-cut", "an extension longer than the header", EXTEND, 9, 5, 7, 0},
    {"unsupported-version-2", "the next version", FIELD, FORGE_VERSION, 2, 2, 0},
    {"unsupported-version-0", "an earlier version", FIELD, FORGE_VERSION, 2, 0, 0},
    {"unsupported-version-65535", "a far version", FIELD, FORGE_VERSION, 2, 65535, 0},
    {"unsupported-profile", "a third profile", FIELD, FORGE_PROFILE, 1, 2, 0},
    {"unsupported-reserved", "a reserved bit", FIELD, FORGE_RESERVED, 1, 1, 0},
    {"unsupported-reserved-all", "all reserved bits", FIELD, FORGE_RESERVED, 1, 255, 0},
    {"unsupported-extension", "an extension that must be understood", EXTEND, 5, 5, 0x8007, 0},
};

static uint32_t rungs_of(const struct file *file) {
    return (uint32_t)forge_get(file->bytes + FORGE_RUNG_COUNT, 2);
}

static unsigned char *rung_of(struct file *file, uint32_t rung) {
    return file->bytes + FORGE_RUNGS + rung * FORGE_RUNG_SIZE;
}

static void swap_blocks(struct file *file, bool repeat) {
    unsigned char held[MAX_BYTES];
    size_t first = forge_block(file->bytes, 1), second = forge_block(file->bytes, 2), end = forge_block(file->bytes, 3);
    size_t first_bytes = second - first, second_bytes = end - second;
    memcpy(held, file->bytes + first, end - first);
    if (repeat) { /* the second block takes the first one's place as well */
        memmove(file->bytes + first + 2 * first_bytes, file->bytes + end, file->size_bytes - end);
        memcpy(file->bytes + second, held, first_bytes);
        file->size_bytes += first_bytes - second_bytes;
        forge_put(rung_of(file, 2) + FORGE_BLOCK_BYTES, first_bytes, 4);
    } else {
        memcpy(file->bytes + first, held + first_bytes, second_bytes);
        memcpy(file->bytes + first + second_bytes, held, first_bytes);
        forge_put(rung_of(file, 1) + FORGE_BLOCK_BYTES, second_bytes, 4);
        forge_put(rung_of(file, 2) + FORGE_BLOCK_BYTES, first_bytes, 4);
    }
    forge_checksums(file->bytes, file->size_bytes);
}

static void overwrite_block(struct file *file, const struct altered *altered) {
    size_t at = forge_block(file->bytes, altered->rung), end = forge_block(file->bytes, altered->rung + 1);
    uint32_t chance = 2463534242u;
    for (; at < end; at++) {
        chance ^= chance << 13;
        chance ^= chance >> 17;
        chance ^= chance << 5;
        file->bytes[at] = altered->alteration == NOISE ? (unsigned char)chance : altered->alteration == ONES ? 0xff : 0;
    }
    forge_checksums(file->bytes, file->size_bytes);
}

static void extend(struct file *file, const struct altered *altered) {
    size_t header_bytes = (size_t)forge_get(file->bytes + FORGE_HEADER_BYTES, 2);
    size_t extra_bytes = 4 + (size_t)altered->width;
    unsigned char *at = file->bytes + header_bytes - 4;
    memmove(at + extra_bytes, at, file->size_bytes - header_bytes + 4);
    forge_put(at, altered->value, 2);
    forge_put(at + 2, altered->at, 2);
    memset(at + 4, 'x', (size_t)altered->width);
    file->size_bytes += extra_bytes;
    forge_put(file->bytes + FORGE_HEADER_BYTES, header_bytes + extra_bytes, 2);
    forge_put(file->bytes + FORGE_EXTENSION_BYTES, extra_bytes, 2);
    forge_checksums(file->bytes, file->size_bytes);
}

static void change_last_block(struct file *file, const struct altered *altered) {
    unsigned char *size = rung_of(file, rungs_of(file) - 1) + FORGE_BLOCK_BYTES;
    uint64_t last_bytes = forge_get(size, 4), change_bytes = (uint64_t)altered->width;
    memset(file->bytes + file->size_bytes, (int)altered->value, (size_t)altered->width);
    last_bytes = altered->alteration == GROW ? last_bytes + change_bytes : last_bytes - change_bytes;
    file->size_bytes = forge_block(file->bytes, rungs_of(file) - 1) + (size_t)last_bytes;
    forge_put(size, last_bytes, 4);
    forge_checksums(file->bytes, file->size_bytes);
}

static void put_rung_field(struct file *file, const struct altered *altered) {
    unsigned char *at = rung_of(file, altered->rung) + altered->at;
    uint64_t value = altered->value;
    if (strcmp(altered->name, "bad-vertices-more") == 0) { /* consistent, but not with the block */
        value = forge_get(at, 4) + 1;
        unsigned char *triangles = rung_of(file, altered->rung) + FORGE_TRIANGLES;
        forge_put(triangles, forge_get(triangles, 4) + 2, 4);
    }
    forge_put(at, value, altered->width);
    if (altered->at == FORGE_BLOCK_CHECKSUM) { /* only the header's checksum is true */
        unsigned char kept[4];
        memcpy(kept, at, 4);
        forge_checksums(file->bytes, forge_block(file->bytes, 0));
        memcpy(at, kept, 4);
        forge_checksums(file->bytes, (size_t)forge_get(file->bytes + FORGE_HEADER_BYTES, 2));
    } else {
        forge_checksums(file->bytes, file->size_bytes);
    }
}

static void alter(const struct altered *altered, struct file *file) {
    switch (altered->alteration) {
    case FIELD:
    case DAMAGE:
        forge_put(file->bytes + altered->at, altered->value, altered->width);
        if (altered->alteration == FIELD) forge_checksums(file->bytes, file->size_bytes);
        break;
    case RUNG_FIELD: put_rung_field(file, altered); break;
    case SHRINK:
    case GROW: change_last_block(file, altered); break;
    case TRAIL: file->bytes[file->size_bytes++] = (unsigned char)altered->value; break;
    case SWAP:
    case REPEAT: swap_blocks(file, altered->alteration == REPEAT); break;
    case NOISE:
    case ZEROS:
    case ONES: overwrite_block(file, altered); break;
    case FLIP:
        file->bytes[forge_block(file->bytes, altered->rung) + altered->at] ^= (unsigned char)(1u << altered->value);
        forge_checksums(file->bytes, file->size_bytes);
        break;
    case EXTEND: extend(file, altered); break;
    }
}

/* ---- files ---- */

static bool write_file(const char *folder, const char *name, const void *bytes, size_t size_bytes, const char *mode) {
    char path[PATH_BYTES];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, mode);
    bool written = file != NULL && fwrite(bytes, 1, size_bytes, file) == size_bytes;
    if (file != NULL) written = fclose(file) == 0 && written;
    if (!written) perror(path);
    return written;
}

/* One file and its line in the README. */
static bool put_file(const char *folder, const char *name, const char *about, const struct file *file) {
    char line[256], file_name[128];
    int length = snprintf(line, sizeof line, "| %s.scree | %s |\n", name, about);
    snprintf(file_name, sizeof file_name, "%s.scree", name);
    return write_file(folder, file_name, file->bytes, file->size_bytes, "wb") &&
           write_file(folder, "README.md", line, (size_t)length, "ab");
}

static const char heading[] =
    "# Streams for tests\n\n"
    "Made by `tests/make_corpus`, every byte of them; read by `tests/test_hostile.c`, `tests/fuzz_stream.c` and\n"
    "`tests/stream_doc.sh`. bad-* and unsupported-* are alterations of good-local.scree with their checksums made "
    "true,\n"
    "unless the line says otherwise; finding-* came out of fuzzing.\n\n"
    "| file | what it is |\n|---|---|\n";

int main(int argc, char **argv) {
    static struct file file, local;
    char name[128];
    if (argc != 2) {
        fprintf(stderr, "usage: make_corpus FOLDER\n");
        return 2;
    }
    bool fine = write_file(argv[1], "README.md", heading, sizeof heading - 1, "wb");
    for (size_t i = 0; i < sizeof goods / sizeof *goods && fine; i++) {
        snprintf(name, sizeof name, "good-%s", goods[i].name);
        fine = make_good(&goods[i], &file) && put_file(argv[1], name, goods[i].about, &file);
        if (strcmp(goods[i].name, "local") == 0) local = file;
    }
    for (size_t i = 0; i < sizeof altereds / sizeof *altereds && fine; i++) {
        file = local;
        alter(&altereds[i], &file);
        fine = put_file(argv[1], altereds[i].name, altereds[i].about, &file);
    }
    return fine ? 0 : 1;
}
