#include "stream/quadtree.h"

#include <math.h>
#include <string.h>

enum { SIDES = 4, MOST_CORNERS = 2 * SIDES }; /* of a leaf with a vertex in the middle of each side */

/* ---- the hierarchy ---- */

enum scree_status quadtree_make(struct scree_memory *memory, const struct curvature_posts *posts, struct quadtree *tree,
                                struct scree_error *error) {
    *tree = (struct quadtree){0};
    enum scree_status status = curvature_pyramid_make(memory, posts, &tree->pyramid, error);
    if (status != SCREE_OK) return status;
    tree->posts = *posts;
    for (int32_t k = 1; k <= tree->pyramid.top; k++) {
        const struct curvature_level *level = &tree->pyramid.level[k];
        tree->split[k] = scree_allocate(memory, (size_t)level->columns * (size_t)level->rows, 1,
                                        "the marks of a quadtree's nodes", error);
        if (tree->split[k] == NULL) status = SCREE_E_MEMORY;
    }
    tree->number = scree_allocate(memory, (size_t)posts->columns * (size_t)posts->rows, sizeof *tree->number,
                                  "the numbers of a quadtree's vertices", error);
    if (tree->number == NULL) status = SCREE_E_MEMORY;
    if (status != SCREE_OK) quadtree_release(memory, tree);
    return status;
}

void quadtree_release(struct scree_memory *memory, struct quadtree *tree) {
    scree_release(memory, tree->number);
    for (int32_t k = 1; k <= tree->pyramid.top; k++) scree_release(memory, tree->split[k]);
    curvature_pyramid_release(memory, &tree->pyramid);
    *tree = (struct quadtree){0};
}

/* ---- which nodes are split ---- */

struct walk {
    struct quadtree *tree;
    double everywhere_2;  /* the largest sum of a node that stays whole, squared, where there is no observer */
    double observer_m[3]; /* east, north, up of post (0, 0) at height 0 */
    double per_m_2;       /* the largest sum per metre of distance, squared; 0: there is no observer, or no distance is
                             enough */
};

static double gap_m(double low_m, double at_m, double high_m) {
    return at_m < low_m ? low_m - at_m : at_m > high_m ? at_m - high_m : 0;
}

/* More curvature than its distance allows? The box around a node holds those of its children, so that a node which may
 * stay whole has no child that may not. */
static bool wants_split(const struct walk *walk, const struct curvature_node *node, int32_t level, int32_t column,
                        int32_t row) {
    double sum_2 = (double)node->sum * node->sum, allowed_2 = walk->everywhere_2;
    if (walk->per_m_2 > 0) {
        const struct curvature_posts *posts = &walk->tree->posts;
        double side = (double)(1 << level);
        double east_m = fmin((column + 1) * side, posts->columns - 1.0) * posts->east_m;
        double north_m = fmin((row + 1) * side, posts->rows - 1.0) * posts->north_m;
        double x_m = gap_m(column * side * posts->east_m, walk->observer_m[0], east_m);
        double y_m = gap_m(row * side * posts->north_m, walk->observer_m[1], north_m);
        double z_m = gap_m(node->low_m, walk->observer_m[2], node->high_m);
        allowed_2 = walk->per_m_2 * (x_m * x_m + y_m * y_m + z_m * z_m);
    }
    return sum_2 > allowed_2;
}

static bool is_split(const struct quadtree *tree, int32_t level, int32_t column, int32_t row) {
    const struct curvature_level *nodes = &tree->pyramid.level[level];
    if (level < 1 || column < 0 || row < 0 || column >= nodes->columns || row >= nodes->rows) return false;
    return tree->split[level][(int64_t)row * nodes->columns + column] != 0;
}

/* Splits a node and whatever else has to be, so that it exists and has no neighbour more than a level above its
 * children: each call is for a node of the level above. */
static void split(struct quadtree *tree, int32_t level, int32_t column, int32_t row) {
    const struct curvature_level *nodes = &tree->pyramid.level[level];
    if (level > tree->pyramid.top || is_split(tree, level, column, row)) return;
    tree->split[level][(int64_t)row * nodes->columns + column] = 1;
    split(tree, level + 1, column / 2, row / 2);
    if (column > 0) split(tree, level + 1, (column - 1) / 2, row / 2);
    if (column + 1 < nodes->columns) split(tree, level + 1, (column + 1) / 2, row / 2);
    if (row > 0) split(tree, level + 1, column / 2, (row - 1) / 2);
    if (row + 1 < nodes->rows) split(tree, level + 1, column / 2, (row + 1) / 2);
}

static void refine(const struct walk *walk, int32_t level, int32_t column, int32_t row) {
    const struct curvature_level *nodes = &walk->tree->pyramid.level[level];
    if (column >= nodes->columns || row >= nodes->rows) return;
    if (!wants_split(walk, &nodes->nodes[(int64_t)row * nodes->columns + column], level, column, row)) return;
    split(walk->tree, level, column, row);
    if (level == 1) return;
    for (int32_t child = 0; child < SIDES; child++)
        refine(walk, level - 1, 2 * column + (child & 1), 2 * row + (child >> 1));
}

int32_t quadtree_leaf_level(const struct quadtree *tree, int32_t x, int32_t y) {
    int32_t level = tree->pyramid.top;
    while (level > 0 && is_split(tree, level, x >> level, y >> level)) level--;
    return level;
}

/* ---- the mesh of the leaves ---- */

struct build {
    struct scree_memory *memory;
    struct quadtree *tree;
    struct quadtree_mesh *made;
    struct scree_error *error;
    enum scree_status status;
};

struct post {
    int32_t x, y;
};

/* Room for one more leaf. */
static bool reserve(struct build *build) {
    struct quadtree_mesh *made = build->made;
    if (made->vertex_room - made->mesh.vertex_count < MOST_CORNERS) {
        size_t room = made->vertex_room < 1024 ? 1024 : 2 * (size_t)made->vertex_room;
        void *grown = scree_reallocate(build->memory, made->mesh.vertices, room, sizeof *made->mesh.vertices,
                                       "the vertices of a quadtree's mesh", build->error);
        if (grown == NULL) return false;
        made->mesh.vertices = grown;
        made->vertex_room = (uint32_t)room;
    }
    if (made->triangle_room - made->mesh.triangle_count < MOST_CORNERS) {
        size_t room = made->triangle_room < 2048 ? 2048 : 2 * (size_t)made->triangle_room;
        void *grown = scree_reallocate(build->memory, made->mesh.corners, room, 3 * sizeof *made->mesh.corners,
                                       "the triangles of a quadtree's mesh", build->error);
        if (grown == NULL) return false;
        made->mesh.corners = grown;
        made->triangle_room = (uint32_t)room;
    }
    return true;
}

static uint32_t number_of(struct build *build, struct post at) {
    struct scree_mesh *mesh = &build->made->mesh;
    uint32_t *number = &build->tree->number[(int64_t)at.y * build->tree->posts.columns + at.x];
    if (*number == 0) {
        mesh->vertices[mesh->vertex_count++] = (struct scree_vertex){at.x, at.y, 0};
        *number = mesh->vertex_count;
    }
    return *number - 1;
}

static double height_at(const struct quadtree *tree, int32_t x, int32_t y) {
    return tree->posts.heights_m[(int64_t)y * tree->posts.stride + x];
}

/* Does the diagonal from the south-east pass the leaf's middle more closely than that from the south-west? */
static bool leans_west(const struct quadtree *tree, struct post low, struct post high) {
    double middle_m = height_at(tree, (low.x + high.x) / 2, (low.y + high.y) / 2);
    double rising_m = (height_at(tree, low.x, low.y) + height_at(tree, high.x, high.y)) / 2;
    double falling_m = (height_at(tree, high.x, low.y) + height_at(tree, low.x, high.y)) / 2;
    return fabs(falling_m - middle_m) < fabs(rising_m - middle_m);
}

/* The template: a fan from the middle of a side, or a diagonal where no neighbour is finer. Corners are counted from
 * the south-west, counter-clockwise, the middles of sides being the odd ones; `finer` has a bit for each side from the
 * southern one. */
static void add_leaf(struct build *build, struct post low, struct post high, struct post middle, unsigned finer) {
    /* By `finer`: with three middles the one between the others. */
    static const uint8_t first[1 << SIDES] = {0, 1, 3, 1, 5, 1, 3, 3, 7, 7, 3, 1, 5, 7, 5, 1};
    const struct post at[MOST_CORNERS] = {low,  {middle.x, low.y},  {high.x, low.y}, {high.x, middle.y},
                                          high, {middle.x, high.y}, {low.x, high.y}, {low.x, middle.y}};
    uint32_t ring[MOST_CORNERS];
    int count = 0, apex = finer != 0 ? first[finer] : leans_west(build->tree, low, high) ? 2 : 0;
    if (!reserve(build)) {
        build->status = SCREE_E_MEMORY;
        return;
    }
    for (int i = 0; i < MOST_CORNERS; i++) {
        int corner = (apex + i) % MOST_CORNERS;
        if (corner % 2 == 0 || finer & 1U << corner / 2) ring[count++] = number_of(build, at[corner]);
    }
    struct scree_mesh *mesh = &build->made->mesh;
    for (int i = 1; i + 1 < count; i++)
        memcpy(mesh->corners + 3 * (size_t)mesh->triangle_count++, (uint32_t[3]){ring[0], ring[i], ring[i + 1]},
               3 * sizeof *mesh->corners);
}

/* Leaves in the order of the tree: south-west, south-east, north-west, north-east. */
static void add_node(struct build *build, int32_t level, int32_t column, int32_t row) {
    const struct quadtree *tree = build->tree;
    const struct post low = {column << level, row << level}, last = {tree->posts.columns - 1, tree->posts.rows - 1};
    if (low.x >= last.x || low.y >= last.y || build->status != SCREE_OK) return;
    if (is_split(tree, level, column, row)) {
        for (int32_t child = 0; child < SIDES; child++)
            add_node(build, level - 1, 2 * column + (child & 1), 2 * row + (child >> 1));
        return;
    }
    const int32_t side = 1 << level;
    const struct post middle = {low.x + side / 2, low.y + side / 2};
    struct post high = {low.x + side, low.y + side};
    if (high.x > last.x) high.x = last.x;
    if (high.y > last.y) high.y = last.y;
    unsigned finer = 0; /* a side that the border cuts before its middle has no vertex there */
    if (middle.x < high.x && is_split(tree, level, column, row - 1)) finer |= 1;
    if (middle.y < high.y && is_split(tree, level, column + 1, row)) finer |= 2;
    if (middle.x < high.x && is_split(tree, level, column, row + 1)) finer |= 4;
    if (middle.y < high.y && is_split(tree, level, column - 1, row)) finer |= 8;
    add_leaf(build, low, high, middle, finer);
}

/* ---- a view ---- */

static enum scree_status make_walk(struct quadtree *tree, const struct quadtree_view *view, struct walk *walk,
                                   struct scree_error *error) {
    *walk = (struct walk){.tree = tree, .everywhere_2 = view->threshold * view->threshold};
    if (!(view->threshold >= 0) || !isfinite(walk->everywhere_2))
        return scree_fail(error, SCREE_E_ARGUMENT, "a quadtree's threshold is a number from 0, not %g",
                          view->threshold);
    if (!view->has_observer) return SCREE_OK;
    double per_m = view->threshold / view->reach_m;
    walk->per_m_2 = per_m * per_m;
    walk->observer_m[0] = view->x * tree->posts.east_m;
    walk->observer_m[1] = view->y * tree->posts.north_m;
    walk->observer_m[2] = view->height_m;
    if (!(view->reach_m > 0) || !isfinite(walk->per_m_2))
        return scree_fail(error, SCREE_E_ARGUMENT, "the reach of a threshold is a distance above 0, not %g m",
                          view->reach_m);
    if (!isfinite(walk->observer_m[0]) || !isfinite(walk->observer_m[1]) || !isfinite(walk->observer_m[2]))
        return scree_fail(error, SCREE_E_ARGUMENT, "the observer's place makes no sense");
    return SCREE_OK;
}

enum scree_status quadtree_extract(struct scree_memory *memory, struct quadtree *tree, const struct quadtree_view *view,
                                   struct quadtree_mesh *made, struct scree_error *error) {
    struct walk walk;
    struct scree_mesh *mesh = &made->mesh;
    struct build build = {memory, tree, made, error, SCREE_OK};
    const int32_t top = tree->pyramid.top;
    mesh->vertex_count = mesh->triangle_count = 0;
    build.status = make_walk(tree, view, &walk, error);
    if (build.status != SCREE_OK) goto cleanup;
    for (int32_t k = 1; k <= top; k++) {
        const struct curvature_level *level = &tree->pyramid.level[k];
        memset(tree->split[k], 0, (size_t)level->columns * (size_t)level->rows);
    }
    refine(&walk, top, 0, 0);
    add_node(&build, top, 0, 0);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const struct scree_vertex *at = &mesh->vertices[i];
        tree->number[(int64_t)at->y * tree->posts.columns + at->x] = 0;
    }
cleanup:
    if (build.status != SCREE_OK) quadtree_mesh_release(memory, made);
    return build.status;
}

void quadtree_mesh_release(struct scree_memory *memory, struct quadtree_mesh *made) {
    scree_release(memory, made->mesh.vertices);
    scree_release(memory, made->mesh.corners);
    *made = (struct quadtree_mesh){0};
}
