/* bench_stream: what streams cost. Bits a vertex of a crop of 513 x 513 posts, increment by increment and by what they
 * are spent on; speed of encoding, decoding and playing; bytes beside those of other formats and of static tiles.
 *
 * Real DEMs are found by SCREE_TEST_DATA; those that are absent are left out, the fractal is always there. The last
 * section starts ./scree: run it where that is. */
#include "tests/bench_stream.h"
#include "stream/decode.h"
#include "tests/bench_rivals.h"
#include "tests/fractal.h"
#include "tests/stream_maker.h"
#include <scree/player.h>

#include <gdal.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { RUNS = 7, QUARTERS = 4, TILE_STEPS = 256, CROP_POSTS = 2 * TILE_STEPS + 1 };

#define TARGET_BITS           18.0
#define TARGET_DECODED_A_S    1e6
#define TARGET_SPLITS_A_S     1e7
#define TARGET_OF_QUANTIZED   0.6
#define CROP_FINEST_M         2.5 /* gives some 63,000 vertices */
#define CROP_RUNGS            22  /* down to some 500 */
#define FINER_RUNGS           8   /* two octaves below the static tile, as `scree build` has it */
#define RUNGS_OF_A_ZOOM       4
#define STEPS_IN_TOLERANCE    16 /* heights are written so much finer than the tolerance, as in src/ladder.c */
#define DEFAULT_SPACING_SHARE 0.125

struct crop {
    const char *name, *file; /* file: below the folder of test data; NULL: the fractal */
    int column, row;
    double spacing_m;
};

static const struct crop crops[] = {
    {"Big Tujunga 30 m", "bigtujunga_srtm30m_utm11.tif", 342, 65, 30},
    {"Mount St Helens 10 m", "sthelens_2000_10m_utm10.tif", 23, 92, 10},
    {"Sagehen 10 m", "large/sagehen_10m_745x690.tif", 116, 88, 10},
    {"fractal", NULL, 0, 0, 30},
};

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double values[RUNS]) {
    qsort(values, RUNS, sizeof *values, compare_doubles);
    return values[RUNS / 2];
}

static void judge(bool kept, const char *promise) {
    printf("%s: %s\n", kept ? "kept" : "missed", promise);
}

/* ---- posts ---- */

/* A crop with a margin of one post; row 0 in the south. NULL with a printed line when it cannot be had. */
static float *read_crop(const struct crop *crop, const char *folder, int columns, int rows) {
    size_t count = (size_t)columns * (size_t)rows;
    float *heights_m = malloc(count * sizeof *heights_m);
    char path[1024];
    if (heights_m == NULL) return NULL;
    if (crop->file == NULL) {
        struct fractal fractal = {.seed = 1, .whole_metres = true};
        fractal_window(&fractal, 4899, -4901, columns, rows, heights_m, columns);
        return heights_m;
    }
    snprintf(path, sizeof path, "%s/%s", folder, crop->file);
    GDALDatasetH raster = GDALOpen(path, GA_ReadOnly);
    float *northern = heights_m + count - (size_t)columns;
    bool fine = raster != NULL &&
                GDALRasterIO(GDALGetRasterBand(raster, 1), GF_Read, crop->column - 1, crop->row - 1, columns, rows,
                             northern, columns, rows, GDT_Float32, 0, -columns * (int)sizeof *heights_m) == CE_None;
    if (raster != NULL) GDALClose(raster);
    if (fine) return heights_m;
    printf("%s: left out, %s is not there (SCREE_TEST_DATA names the folder)\n", crop->name, path);
    free(heights_m);
    return NULL;
}

/* ---- streams of several tiles ---- */

struct stream {
    unsigned char *bytes;
    size_t size_bytes;
    struct scree_stream_header header;
    struct encode_bits bits;
};

/* Encodes several times over; the median CPU time is added to `cpu_s`. */
static enum scree_status encode(struct scree_memory *memory, const struct made_recording *made, struct stream *stream,
                                double *cpu_s, struct scree_error *error) {
    double times_s[RUNS];
    const struct encode_options options = {.bits = &stream->bits};
    for (int run = 0; run < RUNS; run++) {
        scree_release(memory, stream->bytes);
        stream->bytes = NULL;
        stream->bits = (struct encode_bits){0};
        double start_s = cpu_seconds();
        enum scree_status status = stream_encode_new(memory, &made->place, &made->recorder.recording, &options,
                                                     &stream->bytes, &stream->size_bytes, error);
        if (status != SCREE_OK) return status;
        times_s[run] = cpu_seconds() - start_s;
    }
    *cpu_s += median(times_s);
    return scree_stream_header_read(stream->bytes, stream->size_bytes, &stream->header, error);
}

static enum scree_status decode_once(struct scree_memory *memory, const struct stream *stream,
                                     struct scree_error *error) {
    struct stream_decoder *decoder;
    enum scree_status status = stream_decoder_new(memory, &stream->header, &decoder, error);
    if (status != SCREE_OK) return status;
    for (uint32_t i = 0; i < stream->header.rung_count && status == SCREE_OK; i++) {
        const struct scree_rung *rung = &stream->header.rungs[i];
        status = stream_decode_block(decoder, stream->bytes + rung->offset_bytes, rung->size_bytes, error);
    }
    stream_decoder_free(decoder);
    return status;
}

static enum scree_status decode(struct scree_memory *memory, const struct stream *stream, double *cpu_s,
                                struct scree_error *error) {
    double times_s[RUNS];
    for (int run = 0; run < RUNS; run++) {
        double start_s = cpu_seconds();
        enum scree_status status = decode_once(memory, stream, error);
        if (status != SCREE_OK) return status;
        times_s[run] = cpu_seconds() - start_s;
    }
    *cpu_s += median(times_s);
    return SCREE_OK;
}

/* CPU time of indices alone: from the base mesh to the finest rung and back. */
static enum scree_status play(const struct stream *stream, double *up_s, double *down_s, struct scree_error *error) {
    enum { JOURNEYS = 20 };
    double ups_s[RUNS], downs_s[RUNS];
    struct scree_player *player;
    const struct scree_player_options options = {.without_positions = true};
    enum scree_status status = scree_player_new(&options, &player, error);
    if (status == SCREE_OK) status = scree_player_push(player, stream->bytes, stream->size_bytes, error);
    for (int run = 0; run < RUNS && status == SCREE_OK; run++) {
        ups_s[run] = downs_s[run] = 0;
        for (int journey = 0; journey < JOURNEYS; journey++) {
            double start_s = cpu_seconds();
            scree_player_seek_rung(player, stream->header.rung_count - 1);
            double middle_s = cpu_seconds();
            scree_player_seek_rung(player, 0);
            ups_s[run] += (middle_s - start_s) / JOURNEYS;
            downs_s[run] += (cpu_seconds() - middle_s) / JOURNEYS;
        }
    }
    scree_player_free(player);
    if (status != SCREE_OK) return status;
    *up_s += median(ups_s);
    *down_s += median(downs_s);
    return SCREE_OK;
}

/* ---- bits a vertex of a crop ---- */

/* One line an increment, summed over the tiles: what has been paid so far for the vertices that are there. */
static double print_increments(const struct stream streams[QUARTERS]) {
    uint64_t bytes = 0, vertices_before = 0;
    double all_bits = 0;
    printf("%6s %9s %9s %9s %11s %11s\n", "rung", "vertices", "bytes", "so far", "bits/added", "bits/vertex");
    for (int q = 0; q < QUARTERS; q++) bytes += streams[q].header.size_bytes;
    printf("%6s %9s %9llu %9llu\n", "header", "", (unsigned long long)bytes, (unsigned long long)bytes);
    for (uint32_t i = 0; i < streams[0].header.rung_count; i++) {
        uint64_t block_bytes = 0, vertices = 0;
        for (int q = 0; q < QUARTERS; q++) {
            block_bytes += streams[q].header.rungs[i].size_bytes;
            vertices += streams[q].header.rungs[i].vertex_count;
        }
        bytes += block_bytes;
        all_bits = 8 * (double)bytes / (double)vertices;
        printf("%6d %9llu %9llu %9llu %11.2f %11.2f\n", (int)streams[0].header.rungs[i].rung,
               (unsigned long long)vertices, (unsigned long long)block_bytes, (unsigned long long)bytes,
               8 * (double)block_bytes / (double)(vertices - vertices_before), all_bits);
        vertices_before = vertices;
    }
    return all_bits;
}

static void print_spent(const struct stream streams[QUARTERS], double vertices) {
    struct encode_bits sum = {0};
    double header_bits = 0;
    for (int q = 0; q < QUARTERS; q++) {
        sum.connectivity += streams[q].bits.connectivity;
        sum.position += streams[q].bits.position;
        sum.height += streams[q].bits.height;
        header_bits += 8 * (double)streams[q].header.size_bytes;
    }
    printf("bits a vertex: connectivity %.2f, position %.2f, height %.2f, headers %.2f\n", sum.connectivity / vertices,
           sum.position / vertices, sum.height / vertices, header_bits / vertices);
}

static void print_speeds(const struct stream streams[QUARTERS], const double times_s[4]) {
    double vertices = 0, splits = 0;
    for (int q = 0; q < QUARTERS; q++) {
        const struct scree_stream_header *header = &streams[q].header;
        vertices += header->rungs[header->rung_count - 1].vertex_count;
        splits += header->rungs[header->rung_count - 1].vertex_count - header->rungs[0].vertex_count;
    }
    printf("a CPU second: %.2f million vertices encoded, %.2f decoded; played %.1f million splits up, %.1f down\n",
           1e-6 * vertices / times_s[0], 1e-6 * vertices / times_s[1], 1e-6 * splits / times_s[2],
           1e-6 * splits / times_s[3]);
    judge(vertices / times_s[1] >= TARGET_DECODED_A_S, "decoding at least 1 million vertices a CPU second");
    judge(splits / times_s[2] >= TARGET_SPLITS_A_S && splits / times_s[3] >= TARGET_SPLITS_A_S,
          "playing at least 10 million splits a CPU second, both ways");
}

/* The other formats on the same finest meshes and posts, whatever is at hand. */
static void print_rivals(const char *folder, const struct scree_mesh meshes[QUARTERS], const float *posts_m, int stride,
                         double vertices, double stream_bytes) {
    size_t size_bytes, draco_bytes = 0;
    struct scree_error error = {0};
    printf("%-44s %9.0f bytes %7.2f bits a vertex\n", "streams, all rungs", stream_bytes, 8 * stream_bytes / vertices);
    for (int q = 0; q < QUARTERS && error.status == SCREE_OK; q++) {
        rival_draco(folder, &meshes[q], &size_bytes, &error);
        draco_bytes += size_bytes;
    }
    if (error.status == SCREE_OK)
        printf("%-44s %9zu bytes %7.2f bits a vertex\n", "Draco -cl 10, whole numbers, finest rung only", draco_bytes,
               8 * (double)draco_bytes / vertices);
    else
        printf("Draco: left out, %s\n", error.text);
    error = (struct scree_error){0};
    if (rival_jpeg2000(folder, posts_m, stride, CROP_POSTS, CROP_POSTS, &size_bytes, &error) == SCREE_OK)
        printf("%-44s %9zu bytes %7.2f bits a vertex, %.2f a post\n", "JPEG 2000, lossless, every post", size_bytes,
               8 * (double)size_bytes / vertices, 8 * (double)size_bytes / (CROP_POSTS * CROP_POSTS));
    else
        printf("JPEG 2000: left out, %s\n", error.text);
}

/* Records, encodes, decodes and plays a quarter of the crop; its finest mesh goes to `mesh`. */
static enum scree_status run_quarter(struct scree_memory *memory, const struct stream_wish *wish, struct stream *stream,
                                     struct scree_mesh *mesh, double times_s[4], struct scree_error *error) {
    static struct made_recording made;
    enum scree_status status = stream_make_recording(memory, wish, &made, error);
    if (status == SCREE_OK) status = encode(memory, &made, stream, &times_s[0], error);
    if (status == SCREE_OK) status = decode(memory, stream, &times_s[1], error);
    if (status == SCREE_OK) status = play(stream, &times_s[2], &times_s[3], error);
    *mesh = made.finest; /* moves */
    made.finest = (struct scree_mesh){0};
    stream_release_recording(&made);
    return status;
}

static bool run_bits(const struct crop *crop, const char *data, const char *folder) {
    enum { STRIDE = CROP_POSTS + 2 };
    static struct stream streams[QUARTERS];
    struct scree_mesh meshes[QUARTERS] = {{0}};
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    double times_s[4] = {0}, bytes = 0, vertices = 0;
    float *heights_m = read_crop(crop, data, STRIDE, STRIDE);
    if (heights_m == NULL) return true;
    printf("\n%s, %d x %d posts in four tiles, heights in whole metres, tolerance of the finest rung %g m\n",
           crop->name, CROP_POSTS, CROP_POSTS, CROP_FINEST_M);
    const float *corner = heights_m + STRIDE + 1;
    for (int q = 0; q < QUARTERS && error.status == SCREE_OK; q++) {
        const struct stream_wish wish = {.heights_m = corner + q / 2 * TILE_STEPS * STRIDE + q % 2 * TILE_STEPS,
                                         .stride = STRIDE,
                                         .columns = TILE_STEPS,
                                         .rows = TILE_STEPS,
                                         .spacing_m = crop->spacing_m,
                                         .profile = SCREE_LOCAL,
                                         .finest_m = CROP_FINEST_M,
                                         .rungs = CROP_RUNGS};
        run_quarter(&memory, &wish, &streams[q], &meshes[q], times_s, &error);
        bytes += (double)streams[q].size_bytes;
        vertices += meshes[q].vertex_count;
    }
    if (error.status == SCREE_OK) {
        double bits = print_increments(streams);
        print_spent(streams, vertices);
        judge(bits <= TARGET_BITS, "at most 18 bits a vertex");
        print_speeds(streams, times_s);
        print_rivals(folder, meshes, corner, STRIDE, vertices, bytes);
    } else {
        printf("%s: %s\n", crop->name, error.text);
    }
    for (int q = 0; q < QUARTERS; q++) {
        scree_release(&memory, streams[q].bytes);
        scree_release(&memory, meshes[q].corners);
        scree_release(&memory, meshes[q].vertices);
        streams[q] = (struct stream){0};
    }
    free(heights_m);
    return error.status == SCREE_OK;
}

/* ---- against static tiles ---- */

/* A tile as a build makes it: from twice the default tolerance down to a quarter of it. */
static bool run_tile(const struct crop *crop, const char *data) {
    enum { STRIDE = TILE_STEPS + 3 };
    static struct made_recording made;
    struct stream stream = {0};
    struct scree_memory memory = {0};
    struct scree_error error = {0};
    size_t plain_bytes = 0, normal_bytes = 0;
    double cpu_s = 0, static_m = DEFAULT_SPACING_SHARE * crop->spacing_m;
    float *heights_m = read_crop(crop, data, STRIDE, STRIDE);
    if (heights_m == NULL) return true;
    const struct stream_wish wish = {.heights_m = heights_m + STRIDE + 1,
                                     .stride = STRIDE,
                                     .columns = TILE_STEPS,
                                     .rows = TILE_STEPS,
                                     .spacing_m = crop->spacing_m,
                                     .height_exponent = (int)floor(log2(static_m / STEPS_IN_TOLERANCE)),
                                     .profile = SCREE_LOCAL,
                                     .finest_m = ldexp(static_m, -FINER_RUNGS / RUNGS_OF_A_ZOOM),
                                     .rungs = FINER_RUNGS + RUNGS_OF_A_ZOOM + 1};
    stream_make_recording(&memory, &wish, &made, &error);
    if (error.status == SCREE_OK) encode(&memory, &made, &stream, &cpu_s, &error);
    for (int normals = 0; normals < 2 && error.status == SCREE_OK; normals++)
        rival_quantized_mesh(&memory, &made.finest, wish.columns, wish.rows, wish.height_exponent, wish.spacing_m,
                             normals ? &made.tile.slopes : NULL, normals ? &normal_bytes : &plain_bytes, &error);
    if (error.status == SCREE_OK) {
        double ratio = (double)stream.size_bytes / (double)plain_bytes;
        printf("%-22s %8u %9zu %9zu %9zu %7.3f %7.3f  %s\n", crop->name, (unsigned)made.finest.vertex_count,
               stream.size_bytes, plain_bytes, normal_bytes, ratio, (double)stream.size_bytes / (double)normal_bytes,
               ratio <= TARGET_OF_QUANTIZED ? "kept" : "missed");
    } else {
        printf("%s: %s\n", crop->name, error.text);
    }
    scree_release(&memory, stream.bytes);
    stream_release_recording(&made);
    free(heights_m);
    return error.status == SCREE_OK;
}

int main(void) {
    char folder[] = "bench_stream_XXXXXX";
    const char *data = getenv("SCREE_TEST_DATA");
    if (data == NULL) data = TEST_DATA_DEFAULT;
    if (mkdtemp(folder) == NULL) {
        perror("bench_stream: a folder to work in");
        return 1;
    }
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    printf("Streams: CPU times are medians of %d runs.\n", RUNS);
    bool fine = run_bits(&crops[0], data, folder);
    printf("\nA tile of 257 x 257 posts, all rungs, against the gzipped quantized-mesh of its finest rung alone\n"
           "%-22s %8s %9s %9s %9s %7s %7s\n",
           "", "vertices", "stream", "static", "+normals", "ratio", "ratio");
    for (size_t i = 0; i < sizeof crops / sizeof *crops; i++) fine = run_tile(&crops[i], data) && fine;
    fine = bench_products(folder, data) && fine;
    rmdir(folder);
    return fine ? 0 : 1;
}
