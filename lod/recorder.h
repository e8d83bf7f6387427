/* The recorder: watches a simplification from the finest rung down and leaves what the encoder of streams wants. Pure.
 *
 *     recorder_start(memory, &tile.mesh, &recorder, error);           the mesh is at its finest rung
 *     tile.simplifier.options.observer = &recorder.observer;
 *     recorder_mark(&recorder, rung, mmqe_m2, max_error_m, error);    at every rung, the finest and the base included
 *     recorder_finish(&recorder, error);                              strips the mesh: what is to be kept of it is kept
 *     stream_encode_new(memory, place, &recorder.recording, ...);
 *     recorder_release(&recorder); */
#ifndef SCREE_LOD_RECORDER_H
#define SCREE_LOD_RECORDER_H

#include "lod/simplify.h"
#include "stream/recording.h"

struct recorder {
    struct scree_memory *memory;
    struct mesh *mesh;
    struct simplify_observer observer;
    int32_t live_at_start; /* vertices */
    uint32_t removal_capacity, ring_count, ring_capacity, rung_capacity, stage_capacity;
    struct recording_removal *removals;
    uint32_t *ring;
    struct recording_rung *rungs;
    uint32_t *stages;
    struct scree_vertex *vertices;
    struct recording recording; /* whole after recorder_finish; its arrays are those above */
    struct scree_error error;   /* of a callback, told by the next mark */
};

/* `mesh` is borrowed until recorder_release; the recorder must not move while it is observed. */
enum scree_status recorder_start(struct scree_memory *memory, struct mesh *mesh, struct recorder *recorder,
                                 struct scree_error *error);

/* The mesh has come to a rung. */
enum scree_status recorder_mark(struct recorder *recorder, const struct recording_rung *rung,
                                struct scree_error *error);

/* Takes the mesh down to two triangles between its four corners, in stages, so that the base mesh can be told by
 * insertions too. The mesh must cover a rectangle. */
enum scree_status recorder_finish(struct recorder *recorder, struct scree_error *error);

/* Fine on a zeroed struct. */
void recorder_release(struct recorder *recorder);

#endif
