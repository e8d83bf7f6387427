#include "tests/scene_maker.h"

#include "stream/ellipsoid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define ROOT_ERROR_M 8000.0 /* geodetic */
#define CELLS        256

static void make_header(struct scene *scene, int zoom, int finest_zoom, double root_error_m) {
    struct scree_stream_header *header = &scene->headers[zoom];
    uint64_t offset_bytes = 400;
    int last = zoom == finest_zoom ? 4 * zoom + 8 : 4 * zoom;
    *header = (struct scree_stream_header){.profile = scene->terrain.profile, .zoom = zoom, .size_bytes = 400};
    for (int rung = 4 * (zoom - 1); rung <= last; rung++) {
        struct scree_rung *mesh = &header->rungs[header->rung_count++];
        mesh->rung = rung;
        mesh->max_error_m = (float)(root_error_m * exp2(-rung / 4.0));
        mesh->svo_m = mesh->max_error_m / 3;
        mesh->triangle_count = (uint32_t)(300 * exp2((rung - 4 * (zoom - 1)) / 2.0));
        mesh->vertex_count = mesh->triangle_count / 2;
        mesh->size_bytes = 3 * mesh->triangle_count;
        mesh->offset_bytes = offset_bytes;
        offset_bytes += mesh->size_bytes;
    }
    scene->zooms[zoom].finest_max_error_m = header->rungs[header->rung_count - 1].max_error_m;
    scene->zooms[zoom].finest_svo_m = header->rungs[header->rung_count - 1].svo_m;
}

static void add_tile(struct scene *scene, struct scree_tile_id id, double lowest_m, double highest_m) {
    if (scene->tile_count == SCENE_MOST_TILES) {
        fprintf(stderr, "a scene of the test has too many tiles\n");
        exit(2);
    }
    scene->tiles[scene->tile_count++] = (struct scree_select_tile){.id = id,
                                                                   .rungs_ready = scene->headers[id.zoom].rung_count,
                                                                   .header = &scene->headers[id.zoom],
                                                                   .lowest_m = (float)lowest_m,
                                                                   .highest_m = (float)highest_m};
}

static void divide(struct scene *scene, int whole_zoom, int finest_zoom, double x, double y, struct scree_tile_id id,
                   double lowest_m, double highest_m) {
    double span = ldexp(1, -id.zoom);
    if (scene->terrain.profile == SCREE_LOCAL &&
        (ldexp(id.x, finest_zoom - id.zoom) * CELLS >= (double)scene->terrain.columns ||
         ldexp(id.y, finest_zoom - id.zoom) * CELLS >= (double)scene->terrain.rows))
        return;
    add_tile(scene, id, lowest_m, highest_m);
    bool around = x >= id.x * span && x < (id.x + 1) * span && y >= id.y * span && y < (id.y + 1) * span;
    if (id.zoom == finest_zoom || (id.zoom >= whole_zoom && !around)) return;
    for (uint32_t child = 0; child < 4; child++) {
        struct scree_tile_id below = {id.zoom + 1, 2 * id.x + child % 2, 2 * id.y + child / 2};
        double part = (highest_m - lowest_m) / 8;
        divide(scene, whole_zoom, finest_zoom, x, y, below, lowest_m + part * (below.x % 3),
               highest_m - part * (below.y % 3));
    }
}

void scene_make(struct scene *scene, enum scree_profile profile, int whole_zoom, int finest_zoom, double x, double y,
                double highest_m) {
    double root_error_m = ROOT_ERROR_M;
    scene->terrain =
        (struct scree_terrain){.profile = profile, .lowest_m = 0, .highest_m = highest_m, .zooms = scene->zooms};
    if (profile == SCREE_LOCAL) {
        scene->terrain.finest_zoom = finest_zoom;
        scene->terrain.columns = (CELLS << finest_zoom) - 100;
        scene->terrain.rows = (CELLS << finest_zoom) * 3 / 4 + 1;
        scene->terrain.west = 1400000; /* feet */
        scene->terrain.south = 12500000;
        scene->terrain.spacing_x = scene->terrain.spacing_y = 100;
        scene->terrain.metres_x = scene->terrain.metres_y = 30.48;
        root_error_m = 30.48 / 4 * exp2(finest_zoom);
    }
    for (int zoom = 0; zoom <= finest_zoom; zoom++) make_header(scene, zoom, finest_zoom, root_error_m);
    scene->tile_count = 0;
    for (uint32_t root = 0; root < (profile == SCREE_GEODETIC ? 2u : 1u); root++)
        divide(scene, whole_zoom, finest_zoom, x, y, (struct scree_tile_id){0, root, 0}, 0, highest_m);
    scene->selection = (struct scree_selection){.capacity = SCENE_MOST_TILES,
                                                .drawn = scene->drawn,
                                                .wanted = scene->wanted,
                                                .workspace = scene->workspace,
                                                .workspace_bytes = sizeof scene->workspace};
}

uint32_t scene_drawn_at(const struct scene *scene, double x, double y) {
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < scene->selection.drawn_count; i++) {
        const struct scree_tile_id *id = &scene->tiles[scene->drawn[i].tile].id;
        if (floor(ldexp(x, id->zoom)) != id->x || floor(ldexp(y, id->zoom)) != id->y) continue;
        if (found != UINT32_MAX) {
            fprintf(stderr, "two of the tiles drawn hold the same place\n");
            exit(2);
        }
        found = i;
    }
    return found;
}

void scene_place(const struct scene *scene, double x, double y, double height_m, double place[3]) {
    const struct scree_terrain *terrain = &scene->terrain;
    if (terrain->profile == SCREE_GEODETIC) {
        struct vector3 at = ellipsoid_point(ellipsoid_frame(x * 180 - 180, y * 180 - 90).up, height_m);
        place[0] = at.x, place[1] = at.y, place[2] = at.z;
    } else {
        double steps = ldexp(CELLS, terrain->finest_zoom);
        place[0] = (terrain->west + x * steps * terrain->spacing_x) * 0.3048;
        place[1] = (terrain->south + y * steps * terrain->spacing_y) * 0.3048;
        place[2] = height_m;
    }
}

static void normalise(double a[3]) {
    double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int i = 0; i < 3; i++) a[i] /= length;
}

static void cross(const double a[3], const double b[3], double product[3]) {
    for (int i = 0; i < 3; i++) product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

void scene_matrix(const struct scene_camera *camera, double matrix[16]) {
    double away[3], right[3], up[3], near_m = 1, far_m = 1e8, tops[3] = {0.1, 0.2, 0.9};
    for (int i = 0; i < 3; i++) away[i] = camera->target[i] - camera->eye[i];
    normalise(away);
    cross(away, tops, right);
    normalise(right);
    cross(right, away, up);
    double half = camera->orthogonal ? camera->height / 2 : tan(camera->height / 2);
    double aspect = camera->width_px / camera->height_px * (1 + camera->stretch);
    double rows[4][3] = {{0}}, depth_scale, depth_offset; /* z = scale * distance along `away` + offset */
    if (camera->orthogonal) {
        depth_scale = (camera->depth == SCREE_DEPTH_ZERO ? 1 : 2) / (far_m - near_m);
        depth_offset = (camera->depth == SCREE_DEPTH_ZERO ? 0 : -1) - near_m * depth_scale;
    } else if (camera->depth == SCREE_DEPTH_ZERO) { /* infinite, and the other way round */
        depth_scale = 0;
        depth_offset = near_m;
    } else {
        depth_scale = (far_m + near_m) / (far_m - near_m);
        depth_offset = -2 * far_m * near_m / (far_m - near_m);
    }
    for (int i = 0; i < 3; i++) {
        rows[0][i] = right[i] / (half * aspect);
        rows[1][i] = up[i] / half;
        rows[2][i] = away[i] * depth_scale;
        rows[3][i] = camera->orthogonal ? 0 : away[i];
    }
    for (int r = 0; r < 4; r++) {
        double offset = r == 2 ? depth_offset : r == 3 && camera->orthogonal ? 1 : 0;
        for (int i = 0; i < 3; i++) {
            matrix[4 * i + r] = rows[r][i];
            offset -= rows[r][i] * camera->eye[i];
        }
        matrix[12 + r] = offset;
    }
    for (int i = 0; i < 4; i++) matrix[4 * i] += camera->shift * matrix[4 * i + 3];
}

bool scene_project(const struct scene_camera *camera, const double matrix[16], const double place[3],
                   double pixels[2]) {
    double clip[4];
    for (int r = 0; r < 4; r++) {
        clip[r] = matrix[12 + r];
        for (int i = 0; i < 3; i++) clip[r] += matrix[4 * i + r] * place[i];
    }
    double near_z = camera->depth == SCREE_DEPTH_ZERO ? 0 : -clip[3];
    pixels[0] = clip[0] / clip[3] * camera->width_px / 2;
    pixels[1] = clip[1] / clip[3] * camera->height_px / 2;
    return clip[3] > 0 && (camera->depth == SCREE_DEPTH_ANY || (clip[2] >= near_z && clip[2] <= clip[3]));
}
