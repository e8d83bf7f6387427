/* Plays a tile of a stream: coarse to fine as its bytes arrive, and back to the mesh that it began with.
 *
 *     cc play.c -o play $(pkg-config --cflags --libs scree-stream)
 *     ./play OUT/stream/0/0/0.scree */
#include <scree/player.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A line for the rung that is shown. */
static void show(struct scree_player *player, uint32_t rung) {
    const struct scree_rung *at = &scree_player_header(player)->rungs[rung];
    struct scree_arrays arrays;
    scree_player_seek_rung(player, rung);
    scree_player_look(player, &arrays); /* here a viewer draws arrays.indices */
    uint32_t slots = 0;
    struct scree_range range;
    while (scree_player_dirty_slots(player, &range)) slots += range.end - range.first; /* and sends these only */
    printf("%5d %11.3f %10.3f %9u %9u %10llu %12u\n", (int)at->rung, at->svo_m, at->max_error_m,
           (unsigned)arrays.vertex_count, (unsigned)arrays.triangle_count,
           (unsigned long long)(at->offset_bytes + at->size_bytes), (unsigned)slots);
}

struct mesh {
    uint32_t *indices;
    size_t size_bytes;
};

/* What is shown, to be compared later; without indices when memory lacks. */
static struct mesh copy(struct scree_player *player) {
    struct scree_arrays arrays;
    scree_player_look(player, &arrays);
    struct mesh mesh = {.size_bytes = 3 * sizeof *arrays.indices * arrays.triangle_count};
    mesh.indices = malloc(mesh.size_bytes);
    if (mesh.indices != NULL) memcpy(mesh.indices, arrays.indices, mesh.size_bytes);
    return mesh;
}

/* Pushes a file piece by piece, as a network would bring it, and shows each rung as soon as it is there. */
static enum scree_status refine(struct scree_player *player, FILE *file, struct mesh *coarse,
                                struct scree_error *error) {
    unsigned char piece[4096];
    size_t size_bytes;
    uint32_t shown = 0;
    enum scree_status status = SCREE_MORE;
    while (status == SCREE_MORE && (size_bytes = fread(piece, 1, sizeof piece, file)) > 0) {
        status = scree_player_push(player, piece, size_bytes, error);
        if (shown == 0 && scree_player_rungs_ready(player) > 0) *coarse = copy(player);
        while (shown < scree_player_rungs_ready(player)) show(player, shown++);
    }
    if (status == SCREE_MORE) status = scree_fail(error, SCREE_E_CORRUPT, "the stream is cut off");
    return status;
}

static int play(struct scree_player *player, FILE *file, struct scree_error *error) {
    struct mesh coarse = {0}, again = {0};
    bool same = false;
    printf(" rung       SVO m  max error  vertices triangles      bytes  index slots sent\n");
    if (refine(player, file, &coarse, error) == SCREE_OK) {
        for (uint32_t rung = scree_player_rungs_ready(player); rung-- > 0;) show(player, rung);
        again = copy(player);
        same = coarse.indices != NULL && again.indices != NULL && coarse.size_bytes == again.size_bytes &&
               memcmp(coarse.indices, again.indices, coarse.size_bytes) == 0;
        printf("back at the coarsest mesh: %s\n", same ? "identical" : "DIFFERENT");
    }
    free(again.indices);
    free(coarse.indices);
    return same ? 0 : 1;
}

int main(int argc, char **argv) {
    struct scree_error error = {0};
    struct scree_player *player = NULL;
    int code = 1;
    if (argc != 2) return fprintf(stderr, "usage: play FILE.scree\n"), 2;
    FILE *file = fopen(argv[1], "rb");
    if (file == NULL)
        scree_fail(&error, SCREE_E_IO, "%s cannot be opened", argv[1]);
    else if (scree_player_new(NULL, &player, &error) == SCREE_OK)
        code = play(player, file, &error);
    if (error.status < 0) fprintf(stderr, "play: %s\n", error.text);
    scree_player_free(player);
    if (file != NULL) fclose(file);
    return code;
}
