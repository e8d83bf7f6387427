#include "src/pyramid.h"

#include "src/method_build.h"
#include "src/tin_source_io.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define JOBS_A_THREAD 8 /* subtrees, so that threads end together */

/* What a tile leaves to its parent: one of these, or none in case of a root. */
struct handed {
    struct coarse_tile *mesh;
    struct post_tile *posts; /* where a method of the literature makes the meshes */
};

/* A tile at or above the zoom where the work is cut into jobs. Its memory belongs to whoever works on it: first its
 * own worker, then, by way of `handed`, that of its parent. */
struct node {
    struct tile_id id;
    uint32_t waiting; /* children that are not done yet; under the lock */
    struct scree_memory memory;
    struct handed handed;
};

struct work {
    const struct pyramid_options *options;
    struct pyramid *pyramid;
    struct tile_plan plan;
    int job_zoom;
    struct node *nodes[MAX_ZOOM + 1]; /* by zoom up to job_zoom, parallel to the pyramid's lists */
    uint32_t *order;                  /* the jobs along a Z-curve */
    pthread_mutex_t lock;             /* of what follows */
    uint32_t next_job, tiles_done;
    bool failed;
    struct scree_error error;
};

struct worker {
    struct work *work;
    struct raster_reader *reader;
    pthread_t thread;
    bool started;
};

/* ---- which tiles there are ---- */

/* What the data touch: one or two windows. */
static int data_windows(const struct pyramid_options *options, struct lattice_window windows[2]) {
    if (options->tin == NULL) return raster_windows(options->raster, windows);
    windows[0] = options->tin->window;
    return 1;
}

static enum scree_status list_tiles(const struct pyramid_options *options, struct pyramid *pyramid, int zoom,
                                    struct scree_error *error) {
    struct pyramid_zoom *level = &pyramid->zooms[zoom];
    struct lattice_window windows[2];
    int window_count = data_windows(options, windows);
    enum scree_status status = SCREE_OK;
    for (int i = 0; i < window_count && status == SCREE_OK; i++) {
        struct tile_range range = lattice_tiles_touching(options->lattice, zoom, windows[i]);
        for (uint32_t y = range.y_first; y <= range.y_last; y++)
            for (uint32_t x = range.x_first; x <= range.x_last && status == SCREE_OK; x++)
                status = tile_list_add(&pyramid->memory, &level->tiles, (struct tile_id){zoom, x, y}, error);
    }
    for (uint32_t x = 0; zoom == 0 && x < lattice_tiles_x(options->lattice, 0) && status == SCREE_OK; x++)
        status = tile_list_add(&pyramid->memory, &level->tiles, (struct tile_id){0, x, 0}, error);
    if (status != SCREE_OK) return status;
    tile_list_sort(&level->tiles);
    uint32_t kept = 0; /* the windows may touch the same tiles */
    for (uint32_t i = 0; i < level->tiles.count; i++) {
        struct tile_id id = level->tiles.ids[i];
        if (kept > 0 && level->tiles.ids[kept - 1].x == id.x && level->tiles.ids[kept - 1].y == id.y) continue;
        level->tiles.ids[kept++] = id;
    }
    level->tiles.count = kept;
    level->statistics =
        scree_allocate(&pyramid->memory, kept, sizeof *level->statistics, "figures of all tiles", error);
    if (level->statistics == NULL) return SCREE_E_MEMORY;
    if (options->census == CENSUS_NONE) return SCREE_OK;
    level->counts = scree_allocate(&pyramid->memory, (size_t)kept * TILE_MOST_RUNGS, sizeof *level->counts,
                                   "sizes of all meshes", error);
    return level->counts != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

/* A root may be on the list without being touched by data. */
static bool touched(const struct pyramid_options *options, struct tile_id id) {
    struct lattice_window windows[2];
    int window_count = data_windows(options, windows);
    for (int i = 0; i < window_count; i++) {
        struct tile_range range = lattice_tiles_touching(options->lattice, id.zoom, windows[i]);
        if (id.x >= range.x_first && id.x <= range.x_last && id.y >= range.y_first && id.y <= range.y_last) return true;
    }
    return false;
}

static struct tile_id child_of(struct tile_id id, int child) {
    return (struct tile_id){id.zoom + 1, 2 * id.x + (uint32_t)(child % 2), 2 * id.y + (uint32_t)(child / 2)};
}

static bool in_lattice(const struct pyramid_options *options, struct tile_id id) {
    return lattice_tile_window(options->lattice, id).columns > 0;
}

/* All roots, and all children of tiles that data touch; the zoom above is listed. */
static enum scree_status list_streams(const struct pyramid_options *options, struct pyramid *pyramid, int zoom,
                                      struct scree_error *error) {
    struct pyramid_zoom *level = &pyramid->zooms[zoom];
    const struct tile_list *above = zoom > 0 ? &pyramid->zooms[zoom - 1].tiles : &level->tiles;
    enum scree_status status = SCREE_OK;
    for (uint32_t i = 0; i < above->count && status == SCREE_OK; i++) {
        if (zoom == 0) {
            status = tile_list_add(&pyramid->memory, &level->stream_tiles, above->ids[i], error);
            continue;
        }
        for (int child = 0; child < 4 && touched(options, above->ids[i]) && status == SCREE_OK; child++)
            if (in_lattice(options, child_of(above->ids[i], child)))
                status = tile_list_add(&pyramid->memory, &level->stream_tiles, child_of(above->ids[i], child), error);
    }
    if (status != SCREE_OK) return status;
    tile_list_sort(&level->stream_tiles);
    level->streams = scree_allocate(&pyramid->memory, level->stream_tiles.count, sizeof *level->streams,
                                    "figures of all tiles", error);
    return level->streams != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

/* ---- tiles ---- */

static void handed_free(struct scree_memory *memory, struct handed *handed) {
    coarse_tile_free(memory, handed->mesh);
    post_tile_free(handed->posts);
    *handed = (struct handed){NULL, NULL};
}

static bool stopped(struct work *work) {
    pthread_mutex_lock(&work->lock);
    bool stop = work->failed;
    pthread_mutex_unlock(&work->lock);
    return stop || (work->options->stop != NULL && *work->options->stop != 0);
}

static void tell_progress(struct work *work) {
    const struct pyramid_options *options = work->options;
    pthread_mutex_lock(&work->lock);
    work->tiles_done++;
    if (options->progress != NULL)
        options->progress(options->progress_context, work->tiles_done,
                          work->pyramid->zooms[options->ladder->finest_zoom].tiles.count);
    pthread_mutex_unlock(&work->lock);
}

static bool is_written(const struct work *work, struct tile_id id) {
    return id.zoom >= work->options->min_zoom && id.zoom <= work->options->max_zoom;
}

/* Writes the stream of a tile that has come to its coarsest rung. */
static enum scree_status finish_stream(struct work *work, struct tile_walk *walk, struct scree_error *error) {
    struct pyramid_zoom *level = &work->pyramid->zooms[walk->id.zoom];
    uint32_t index = tile_list_find(&level->stream_tiles, walk->id);
    return tile_build_write_stream(&work->plan, walk, work->options->stream, &level->streams[index], error);
}

/* Writes what is wanted of a tile that has come to the rung of its zoom, takes it on and hands it up. */
static enum scree_status finish_tile(struct work *work, struct tile_walk *walk, struct handed *handed,
                                     struct scree_error *error) {
    const struct pyramid_options *options = work->options;
    struct pyramid_zoom *level = &work->pyramid->zooms[walk->id.zoom];
    uint32_t index = tile_list_find(&level->tiles, walk->id);
    enum scree_status status = SCREE_OK;
    if (is_written(work, walk->id) && options->terrain != NULL)
        status = tile_build_write(&work->plan, walk, options->terrain, &level->statistics[index], error);
    if (status == SCREE_OK) status = tile_build_hand_up(&work->plan, walk, &handed->mesh, error);
    if (status == SCREE_OK && walk->is_recorded) status = finish_stream(work, walk, error);
    if (level->counts != NULL)
        memcpy(level->counts + (size_t)index * TILE_MOST_RUNGS, walk->counts, sizeof walk->counts);
    tile_walk_release(walk);
    return status;
}

/* Streams of zooms whose finest rung is beyond the base would have nothing in them. */
static bool is_recorded(const struct work *work, struct tile_id id) {
    return work->options->stream != NULL && is_written(work, id) &&
           (!work->options->has_base || id.zoom == work->options->ladder->finest_zoom ||
            RUNGS_A_ZOOM * id.zoom > work->options->base_rung);
}

/* The same of a tile that a method triangulates. */
static enum scree_status finish_posts(struct work *work, struct tile_id id, struct post_tile *tile,
                                      struct handed *handed, struct scree_error *error) {
    const struct pyramid_options *options = work->options;
    struct pyramid_zoom *level = &work->pyramid->zooms[id.zoom];
    enum scree_status status = SCREE_OK;
    if (is_written(work, id) && options->terrain != NULL)
        status = method_build_write(&work->plan, id, tile, options->terrain,
                                    &level->statistics[tile_list_find(&level->tiles, id)], error);
    if (status == SCREE_OK && id.zoom > 0) status = method_build_hand_up(&work->plan, id, tile, &handed->posts, error);
    post_tile_release(tile);
    return status;
}

static enum scree_status parent_from(struct work *work, struct tile_id id, const struct handed children[4],
                                     struct scree_memory *memory, struct handed *handed, struct scree_error *error) {
    enum scree_status status;
    if (work->plan.method != NULL) {
        struct post_tile tile;
        const struct post_tile *views[4];
        for (int child = 0; child < 4; child++) views[child] = children[child].posts;
        status = method_build_parent(&work->plan, id, views, memory, &tile, error);
        return status == SCREE_OK ? finish_posts(work, id, &tile, handed, error) : status;
    }
    struct tile_walk walk;
    const struct coarse_tile *views[4];
    for (int child = 0; child < 4; child++) views[child] = children[child].mesh;
    status = tile_build_parent(&work->plan, id, views, is_recorded(work, id), memory, &walk, error);
    return status == SCREE_OK ? finish_tile(work, &walk, handed, error) : status;
}

static enum scree_status make_finest(struct worker *worker, struct tile_id id, struct scree_memory *memory,
                                     struct handed *handed, struct scree_error *error) {
    struct work *work = worker->work;
    enum scree_status status;
    if (work->plan.method != NULL) {
        struct post_tile tile;
        status = method_build_finest(&work->plan, id, worker->reader, memory, &tile, error);
        return status == SCREE_OK ? finish_posts(work, id, &tile, handed, error) : status;
    }
    struct tile_walk walk;
    status = tile_build_finest(&work->plan, id, worker->reader, is_recorded(work, id), memory, &walk, error);
    return status == SCREE_OK ? finish_tile(work, &walk, handed, error) : status;
}

static enum scree_status finest_tile(struct worker *worker, struct tile_id id, struct scree_memory *memory,
                                     struct handed *handed, struct scree_error *error) {
    enum scree_status status = make_finest(worker, id, memory, handed, error);
    tell_progress(worker->work);
    return status;
}

static enum scree_status level_posts(struct work *work, struct tile_id id, struct scree_memory *memory,
                                     struct handed *handed, struct scree_error *error) {
    struct post_tile tile;
    enum scree_status status = method_build_level(&work->plan, id, memory, &tile, error);
    if (status != SCREE_OK || id.zoom == 0)
        return status == SCREE_OK ? finish_posts(work, id, &tile, handed, error) : status;
    status = method_build_hand_up(&work->plan, id, &tile, &handed->posts, error);
    post_tile_release(&tile);
    return status;
}

/* A tile that no data touch: a stream for its parent's sake, and static only as a root. */
static enum scree_status level_tile(struct work *work, struct tile_id id, struct scree_memory *memory,
                                    struct handed *handed, struct scree_error *error) {
    struct tile_walk walk;
    if (work->plan.method != NULL) return level_posts(work, id, memory, handed, error);
    enum scree_status status = tile_build_level(&work->plan, id, is_recorded(work, id), memory, &walk, error);
    if (status != SCREE_OK) return status;
    if (id.zoom == 0) return finish_tile(work, &walk, handed, error);
    status = tile_build_hand_up(&work->plan, &walk, &handed->mesh, error);
    if (status == SCREE_OK && walk.is_recorded) status = finish_stream(work, &walk, error);
    tile_walk_release(&walk);
    return status;
}

/* A tile with all that lies below it. */
static enum scree_status subtree(struct worker *worker, struct tile_id id, struct scree_memory *memory,
                                 struct handed *handed, struct scree_error *error) {
    struct work *work = worker->work;
    enum scree_status status = SCREE_OK;
    struct handed children[4] = {{NULL, NULL}};
    if (stopped(work)) return scree_fail(error, SCREE_E_INTERRUPTED, "interrupted");
    if (!touched(work->options, id)) return level_tile(work, id, memory, handed, error);
    if (id.zoom == work->options->ladder->finest_zoom) return finest_tile(worker, id, memory, handed, error);
    for (int child = 0; child < 4 && status == SCREE_OK; child++)
        if (in_lattice(work->options, child_of(id, child)))
            status = subtree(worker, child_of(id, child), memory, &children[child], error);
    if (status == SCREE_OK) status = parent_from(work, id, children, memory, handed, error);
    for (int child = 0; child < 4; child++) handed_free(memory, &children[child]);
    return status;
}

/* ---- jobs ---- */

static struct node *node_of(const struct work *work, struct tile_id id) {
    uint32_t index = tile_list_find(&work->pyramid->zooms[id.zoom].tiles, id);
    return index == TILE_NOT_LISTED ? NULL : &work->nodes[id.zoom][index];
}

/* A tile above the jobs whose children are all done; those without data are made here. */
static enum scree_status upper_tile(struct work *work, struct node *node, struct scree_error *error) {
    struct handed children[4] = {{NULL, NULL}};
    struct node *owners[4] = {NULL, NULL, NULL, NULL};
    enum scree_status status = SCREE_OK;
    for (int child = 0; child < 4 && status == SCREE_OK; child++) {
        struct tile_id id = child_of(node->id, child);
        if (!in_lattice(work->options, id)) continue;
        owners[child] = node_of(work, id);
        if (owners[child] != NULL)
            children[child] = owners[child]->handed;
        else
            status = level_tile(work, id, &node->memory, &children[child], error);
    }
    if (status == SCREE_OK) status = parent_from(work, node->id, children, &node->memory, &node->handed, error);
    for (int child = 0; child < 4; child++) {
        handed_free(owners[child] != NULL ? &owners[child]->memory : &node->memory, &children[child]);
        if (owners[child] != NULL) owners[child]->handed = (struct handed){NULL, NULL};
    }
    return status;
}

/* Counts a tile as done; returns its parent when that was the last child. */
static struct node *parent_that_is_ready(struct work *work, const struct node *node) {
    if (node->id.zoom == 0) return NULL;
    struct node *parent = node_of(work, (struct tile_id){node->id.zoom - 1, node->id.x / 2, node->id.y / 2});
    pthread_mutex_lock(&work->lock);
    bool ready = --parent->waiting == 0;
    pthread_mutex_unlock(&work->lock);
    return ready ? parent : NULL;
}

static void fail(struct work *work, const struct scree_error *error) {
    pthread_mutex_lock(&work->lock);
    if (!work->failed) work->error = *error;
    work->failed = true;
    pthread_mutex_unlock(&work->lock);
}

static struct node *next_job(struct work *work) {
    struct node *job = NULL;
    pthread_mutex_lock(&work->lock);
    if (!work->failed && work->next_job < work->pyramid->zooms[work->job_zoom].tiles.count)
        job = &work->nodes[work->job_zoom][work->order[work->next_job++]];
    pthread_mutex_unlock(&work->lock);
    return job;
}

static void *run_worker(void *argument) {
    struct worker *worker = argument;
    for (struct node *job = next_job(worker->work); job != NULL; job = next_job(worker->work)) {
        struct scree_error error = {0};
        enum scree_status status = subtree(worker, job->id, &job->memory, &job->handed, &error);
        for (struct node *node = job; status == SCREE_OK;) {
            if ((node = parent_that_is_ready(worker->work, node)) == NULL) break;
            status = upper_tile(worker->work, node, &error);
        }
        if (status != SCREE_OK) fail(worker->work, &error);
    }
    return NULL;
}

static uint64_t z_curve(struct tile_id id) {
    uint64_t key = 0;
    for (int bit = 31; bit >= 0; bit--) key = key << 2 | (uint64_t)(id.y >> bit & 1) << 1 | (id.x >> bit & 1);
    return key;
}

struct ranked {
    uint64_t key;
    uint32_t index;
};

static int by_key(const void *left, const void *right) {
    const struct ranked *a = left, *b = right;
    return a->key < b->key ? -1 : 1; /* keys differ */
}

static enum scree_status order_jobs(struct work *work, struct scree_error *error) {
    const struct tile_list *jobs = &work->pyramid->zooms[work->job_zoom].tiles;
    struct scree_memory *memory = &work->pyramid->memory;
    struct ranked *ranked = scree_allocate(memory, jobs->count, sizeof *ranked, "jobs", error);
    work->order = scree_allocate(memory, jobs->count, sizeof *work->order, "jobs", error);
    if (ranked != NULL && work->order != NULL) {
        for (uint32_t i = 0; i < jobs->count; i++) ranked[i] = (struct ranked){z_curve(jobs->ids[i]), i};
        qsort(ranked, jobs->count, sizeof *ranked, by_key);
        for (uint32_t i = 0; i < jobs->count; i++) work->order[i] = ranked[i].index;
    }
    scree_release(memory, ranked);
    return ranked != NULL && work->order != NULL ? SCREE_OK : SCREE_E_MEMORY;
}

static enum scree_status make_nodes(struct work *work, struct scree_error *error) {
    int finest = work->options->ladder->finest_zoom;
    uint32_t wanted = (uint32_t)work->options->threads * JOBS_A_THREAD;
    while (work->job_zoom < finest && work->pyramid->zooms[work->job_zoom].tiles.count < wanted) work->job_zoom++;
    for (int zoom = 0; zoom <= work->job_zoom; zoom++) {
        const struct tile_list *tiles = &work->pyramid->zooms[zoom].tiles;
        work->nodes[zoom] =
            scree_allocate(&work->pyramid->memory, tiles->count, sizeof *work->nodes[zoom], "jobs", error);
        if (work->nodes[zoom] == NULL) return SCREE_E_MEMORY;
        for (uint32_t i = 0; i < tiles->count; i++) {
            work->nodes[zoom][i].id = tiles->ids[i];
            if (zoom > 0)
                node_of(work, (struct tile_id){zoom - 1, tiles->ids[i].x / 2, tiles->ids[i].y / 2})->waiting++;
        }
    }
    return order_jobs(work, error);
}

/* Roots that no data touch have no children to wait for, unless they are jobs themselves. */
static enum scree_status level_roots(struct work *work, struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    for (uint32_t i = 0; work->job_zoom > 0 && i < work->pyramid->zooms[0].tiles.count && status == SCREE_OK; i++) {
        struct node *node = &work->nodes[0][i];
        if (!touched(work->options, node->id)) status = level_tile(work, node->id, &node->memory, &node->handed, error);
    }
    return status;
}

static enum scree_status run_workers(struct work *work, struct scree_error *error) {
    int threads = work->options->threads;
    struct scree_memory *memory = &work->pyramid->memory;
    struct worker *workers = scree_allocate(memory, (size_t)threads, sizeof *workers, "workers", error);
    enum scree_status status = workers != NULL ? SCREE_OK : SCREE_E_MEMORY;
    for (int i = 0; i < threads && status == SCREE_OK; i++) {
        workers[i].work = work;
        if (work->options->tin == NULL) status = raster_reader_new(work->options->raster, &workers[i].reader, error);
    }
    for (int i = 0; i < threads && status == SCREE_OK; i++) {
        workers[i].started = pthread_create(&workers[i].thread, NULL, run_worker, &workers[i]) == 0;
        if (i == 0 && !workers[i].started)
            status = scree_fail(error, SCREE_E_LIMIT, "no thread can be started; the system's limit is reached");
    }
    for (int i = 0; workers != NULL && i < threads; i++) {
        if (workers[i].started) pthread_join(workers[i].thread, NULL);
        raster_reader_free(workers[i].reader);
    }
    scree_release(memory, workers);
    return status;
}

static void release_work(struct work *work) {
    struct scree_memory *memory = &work->pyramid->memory;
    for (int zoom = 0; zoom <= work->job_zoom; zoom++) {
        for (uint32_t i = 0; work->nodes[zoom] != NULL && i < work->pyramid->zooms[zoom].tiles.count; i++)
            handed_free(&work->nodes[zoom][i].memory, &work->nodes[zoom][i].handed);
        scree_release(memory, work->nodes[zoom]);
    }
    scree_release(memory, work->order);
    pthread_mutex_destroy(&work->lock);
}

enum scree_status pyramid_build(const struct pyramid_options *options, struct pyramid *pyramid,
                                struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    struct work work = {.options = options,
                        .pyramid = pyramid,
                        .plan = {options->lattice, options->ladder, options->nodata_height_m, options->no_normals,
                                 options->plain, options->fits, options->rungs_per_increment, options->method,
                                 options->tin, options->census, options->has_base, options->base_rung}};
    memset(pyramid, 0, sizeof *pyramid);
    if (pthread_mutex_init(&work.lock, NULL) != 0) return scree_fail(error, SCREE_E_LIMIT, "no lock can be made");
    for (int zoom = 0; zoom <= options->ladder->finest_zoom && status == SCREE_OK; zoom++)
        status = list_tiles(options, pyramid, zoom, error);
    for (int zoom = 0; zoom <= options->ladder->finest_zoom && status == SCREE_OK; zoom++)
        status = list_streams(options, pyramid, zoom, error);
    if (status == SCREE_OK) status = make_nodes(&work, error);
    if (status == SCREE_OK) status = level_roots(&work, error);
    if (status == SCREE_OK) status = run_workers(&work, error);
    if (status == SCREE_OK && work.failed) {
        if (error != NULL) *error = work.error;
        status = work.error.status;
    }
    release_work(&work);
    return status;
}

void pyramid_free(struct pyramid *pyramid) {
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        scree_release(&pyramid->memory, pyramid->zooms[zoom].streams);
        scree_release(&pyramid->memory, pyramid->zooms[zoom].statistics);
        scree_release(&pyramid->memory, pyramid->zooms[zoom].counts);
        tile_list_free(&pyramid->memory, &pyramid->zooms[zoom].stream_tiles);
        tile_list_free(&pyramid->memory, &pyramid->zooms[zoom].tiles);
    }
}
