#include "lod/recorder.h"

#include "lod/strip.h"

#include <string.h>

/* Room for one more group of `count` items; doubles. */
static void *grow(struct recorder *recorder, void *block, uint32_t used, uint32_t count, size_t size_bytes,
                  uint32_t *capacity, struct scree_error *error) {
    uint64_t wanted = (uint64_t)used + count, doubled = 2 * (uint64_t)*capacity;
    if (block != NULL && wanted <= *capacity) return block;
    if (doubled > wanted) wanted = doubled;
    if (wanted < 64) wanted = 64;
    if (wanted > UINT32_MAX) {
        scree_fail(error, SCREE_E_LIMIT, "a tile's simplification is too long to be recorded");
        return NULL;
    }
    void *larger = scree_reallocate(recorder->memory, block, (size_t)wanted, size_bytes, "a tile's record", error);
    if (larger != NULL) *capacity = (uint32_t)wanted;
    return larger;
}

/* Flips may narrow a star before its vertex goes: then the vertex comes twice, and the first star is the one. */
static void record_removal(void *context, const struct star *star) {
    struct recorder *recorder = context;
    struct recording *recording = &recorder->recording;
    uint32_t count = (uint32_t)star->degree + (star->open ? 1 : 0);
    if (recorder->error.status != SCREE_OK) return;
    if (recording->removal_count > 0 &&
        recorder->removals[recording->removal_count - 1].vertex == (uint32_t)star->vertex)
        return;
    struct recording_removal *removals = grow(recorder, recorder->removals, recording->removal_count, 1,
                                              sizeof *removals, &recorder->removal_capacity, &recorder->error);
    if (removals == NULL) return;
    recording->removals = recorder->removals = removals;
    uint32_t *ring = grow(recorder, recorder->ring, recorder->ring_count, count, sizeof *ring, &recorder->ring_capacity,
                          &recorder->error);
    if (ring == NULL) return;
    recording->ring = recorder->ring = ring;
    removals[recording->removal_count++] =
        (struct recording_removal){(uint32_t)star->vertex, recorder->ring_count, count, star->open};
    for (uint32_t i = 0; i < count; i++) ring[recorder->ring_count++] = (uint32_t)star->ring[i];
}

/* What the callbacks could not tell. */
static enum scree_status check(const struct recorder *recorder, struct scree_error *error) {
    if (recorder->error.status != SCREE_OK) {
        if (error != NULL && error->status == SCREE_OK) *error = recorder->error;
        return recorder->error.status;
    }
    int64_t removed = (int64_t)recorder->live_at_start - recorder->mesh->live_vertices;
    if (removed == recorder->recording.removal_count) return SCREE_OK;
    return scree_fail(error, SCREE_E_CORRUPT, "the record of a tile does not tell all that happened to it");
}

enum scree_status recorder_start(struct scree_memory *memory, struct mesh *mesh, struct recorder *recorder,
                                 struct scree_error *error) {
    memset(recorder, 0, sizeof *recorder);
    recorder->memory = memory;
    recorder->mesh = mesh;
    recorder->observer = (struct simplify_observer){recorder, record_removal};
    recorder->live_at_start = mesh->live_vertices;
    recorder->removals = grow(recorder, NULL, 0, (uint32_t)mesh->live_vertices, sizeof *recorder->removals,
                              &recorder->removal_capacity, error);
    recorder->ring = grow(recorder, NULL, 0, 6 * (uint32_t)mesh->live_vertices, sizeof *recorder->ring,
                          &recorder->ring_capacity, error);
    recorder->recording.removals = recorder->removals;
    recorder->recording.ring = recorder->ring;
    if (recorder->removals != NULL && recorder->ring != NULL) return SCREE_OK;
    recorder_release(recorder);
    return SCREE_E_MEMORY;
}

enum scree_status recorder_mark(struct recorder *recorder, const struct recording_rung *rung,
                                struct scree_error *error) {
    struct recording *recording = &recorder->recording;
    enum scree_status status = check(recorder, error);
    if (status != SCREE_OK) return status;
    struct recording_rung *rungs =
        grow(recorder, recorder->rungs, recording->rung_count, 1, sizeof *rungs, &recorder->rung_capacity, error);
    if (rungs == NULL) return SCREE_E_MEMORY;
    recording->rungs = recorder->rungs = rungs;
    rungs[recording->rung_count] = *rung;
    rungs[recording->rung_count++].removals = recording->removal_count;
    return SCREE_OK;
}

/* ---- below the base ---- */

static enum scree_status strip(struct recorder *recorder, unsigned char *taken, struct scree_error *error) {
    struct recording *recording = &recorder->recording;
    while (strip_layer(recorder->mesh, taken, &recorder->observer) > 0) {
        enum scree_status status = check(recorder, error);
        if (status != SCREE_OK) return status;
        uint32_t *stages = grow(recorder, recorder->stages, recording->stage_count, 1, sizeof *stages,
                                &recorder->stage_capacity, error);
        if (stages == NULL) return SCREE_E_MEMORY;
        recording->stage_removals = recorder->stages = stages;
        stages[recording->stage_count++] = recording->removal_count;
    }
    return SCREE_OK;
}

/* Names the corners of what is left, and its diagonal. */
static enum scree_status name_corners(struct recorder *recorder, struct scree_error *error) {
    const struct mesh *mesh = recorder->mesh;
    int32_t right = 0, top = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (mesh->vertices[v].edge == MESH_NONE) continue;
        if (mesh->vertices[v].at.x > right) right = mesh->vertices[v].at.x;
        if (mesh->vertices[v].at.y > top) top = mesh->vertices[v].at.y;
    }
    unsigned found = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        const struct mesh_vertex *vertex = &mesh->vertices[v];
        if (vertex->edge == MESH_NONE) continue;
        bool on_corner = (vertex->at.x == 0 || vertex->at.x == right) && (vertex->at.y == 0 || vertex->at.y == top);
        if (!on_corner) break;
        int corner = (vertex->at.x > 0 ? 1 : 0) + (vertex->at.y > 0 ? 2 : 0);
        recorder->recording.corners[corner] = (uint32_t)v;
        if (corner == 0) recorder->recording.rising = mesh_degree(mesh, v) == 2;
        found |= 1U << corner;
    }
    if (found == 15 && mesh->live_vertices == 4 && mesh->live_triangles == 2) return SCREE_OK;
    return scree_fail(error, SCREE_E_ARGUMENT, "only a mesh that covers a rectangle can be streamed");
}

enum scree_status recorder_finish(struct recorder *recorder, struct scree_error *error) {
    const struct mesh *mesh = recorder->mesh;
    enum scree_status status = SCREE_E_MEMORY;
    size_t count = (size_t)mesh->vertex_count;
    unsigned char *taken = scree_allocate(recorder->memory, count, 1, "a tile's layers", error);
    recorder->vertices =
        scree_allocate(recorder->memory, count, sizeof *recorder->vertices, "a tile's vertices", error);
    if (taken == NULL || recorder->vertices == NULL) goto cleanup;
    for (size_t v = 0; v < count; v++)
        recorder->vertices[v] = (struct scree_vertex){mesh->vertices[v].at.x, mesh->vertices[v].at.y, mesh->heights[v]};
    recorder->recording.vertices = recorder->vertices;
    recorder->recording.vertex_count = (uint32_t)count;
    status = strip(recorder, taken, error);
    if (status == SCREE_OK) status = name_corners(recorder, error);
cleanup:
    scree_release(recorder->memory, taken);
    return status;
}

void recorder_release(struct recorder *recorder) {
    if (recorder == NULL || recorder->memory == NULL) return;
    scree_release(recorder->memory, recorder->vertices);
    scree_release(recorder->memory, recorder->stages);
    scree_release(recorder->memory, recorder->rungs);
    scree_release(recorder->memory, recorder->ring);
    scree_release(recorder->memory, recorder->removals);
    memset(recorder, 0, sizeof *recorder);
}
