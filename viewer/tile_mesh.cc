#include "viewer/tile_mesh.h"

#include <algorithm>
#include <cmath>

extern "C" {
#include "stream/player.h"
}

static bool is_border(const scree_stream_header &header, const scree_vertex &vertex) {
    return vertex.x == 0 || vertex.y == 0 || vertex.x == header.columns || vertex.y == header.rows;
}

void PageVersions::mark(uint32_t first, uint32_t end, uint64_t version) {
    for (uint32_t page = first / page_items; page * page_items < end && page < pages.size(); page++)
        pages[page] = version;
}

TileMesh::TileMesh(Player taken, bool is_final, const MeshWorld &world) : player(std::move(taken)), world(world) {
    const scree_stream_header &tile = header();
    uint32_t last = tile.rung_count - 1, ready = scree_player_rungs_ready(player.get()) - 1;
    while (octave < last && tile.rungs[octave].rung - tile.rungs[0].rung < OCTAVE_RUNGS) octave++;
    finest = is_final || ready == last ? ready : ready - ready % octave;
    look_at(finest);
    vertices.assign(shown.vertex_count, TileVertex{});
    vertex_pages.resize(vertices.size());
    indices.assign(3 * (size_t)shown.triangle_count, 0);
    index_pages.resize(indices.size());
    place_vertices();
    find_normals();
    list_borders();
    find_origins();
    look_at(0);
    scree_player_dirty_all(player.get());
    copy_changed_slots();
}

void TileMesh::look_at(uint32_t rung) {
    scree_player_seek_rung(player.get(), rung);
    scree_player_look(player.get(), &shown);
}

// ---- the vertices ----

scree_frame TileMesh::frame() const {
    scree_frame frame;
    scree_stream_frame(&header(), &frame);
    if (header().profile == SCREE_LOCAL) {
        double unit_m[3] = {world.metres_x, world.metres_y, 1};
        for (int i = 0; i < 3; i++) {
            frame.origin[i] *= unit_m[i];
            for (int axis = 0; axis < 3; axis++) frame.axes[axis][i] = axis == i;
        }
    }
    return frame;
}

void TileMesh::place_vertices() {
    const scree_stream_header &tile = header();
    scree_frame own_frame, world_frame = frame();
    scree_stream_frame(&tile, &own_frame);
    std::fill_n(box[0], 3, HUGE_VAL);
    std::fill_n(box[1], 3, -HUGE_VAL);
    lowest_m = HUGE_VALF;
    highest_m = -HUGE_VALF;
    for (uint32_t i = 0; i < shown.vertex_count; i++) {
        const scree_vertex &from = shown.vertices[i];
        TileVertex &vertex = vertices[i];
        double height_m = std::ldexp(from.height, tile.height_exponent), at[3], place[3];
        scree_stream_position(&tile, &own_frame, from.x, from.y, height_m, at);
        for (int axis = 0; axis < 3; axis++) {
            place[axis] = world_frame.origin[axis];
            for (int k = 0; k < 3; k++) place[axis] += at[k] * world_frame.axes[k][axis];
            box[0][axis] = std::min(box[0][axis], at[axis]);
            box[1][axis] = std::max(box[1][axis], at[axis]);
        }
        put_place(place, &vertex);
        vertex.height_m = vertex.origin_height_m = (float)height_m;
        lowest_m = std::min(lowest_m, vertex.height_m);
        highest_m = std::max(highest_m, vertex.height_m);
        vertex.map[0] = map_of(tile.west + from.x * tile.spacing_x, world.bounds[0], world.bounds[2]);
        vertex.map[1] = map_of(tile.south + from.y * tile.spacing_y, world.bounds[1], world.bounds[3]);
        vertex.increment = (int16_t)shown.increments[i];
        vertex.slot = SLOT_OWN;
    }
}

// Those inside morph from the vertex that they were split from, as it was before their increment; border vertices have
// got theirs.
void TileMesh::find_origins() {
    const progressive *all = player_playback(player.get())->progressive;
    for (uint32_t i = 0; i < shown.vertex_count; i++) {
        TileVertex &vertex = vertices[i];
        uint32_t from = i;
        if (vertex.increment == 0 || vertex.slot != SLOT_OWN) continue;
        while (shown.increments[from] >= shown.increments[i]) from = all->splits[from - all->base_vertices].parent;
        float normal[3];
        normal_at(from, vertex.increment - 1, normal);
        put_normal(normal, vertex.origin_normal);
        put_edge_origin(vertices[from], vertices[from], 0, &vertex);
    }
}

// ---- light ----

// The end of the octave in which an increment's vertices appear: 4 rungs of the ladder, a whole tile but at the finest
// zoom. The base's turn into those of the first.
uint32_t TileMesh::octave_end(uint32_t increment) const {
    uint32_t end = increment == 0 ? octave : (increment + octave - 1) / octave * octave;
    return std::min(end, finest);
}

// Adds areas times normals of what is shown to its corners.
void TileMesh::add_normals(std::vector<std::array<float, 3>> *sums) const {
    for (uint32_t slot = 0; slot < 3 * shown.triangle_count; slot += 3) {
        const TileVertex *corner[3];
        for (int i = 0; i < 3; i++) corner[i] = &vertices[shown.indices[slot + (uint32_t)i]];
        double u[3], v[3];
        for (int axis = 0; axis < 3; axis++) {
            u[axis] = place_of(*corner[1], axis) - place_of(*corner[0], axis);
            v[axis] = place_of(*corner[2], axis) - place_of(*corner[0], axis);
        }
        double normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        for (uint32_t i = 0; i < 3; i++)
            for (size_t axis = 0; axis < 3; axis++) (*sums)[shown.indices[slot + i]][axis] += (float)normal[axis];
    }
}

// A vertex turns from the normal that it has when it appears to that of the mesh at the end of its octave. The base
// begins with the normals of its own mesh, with which the zoom above ends: so nothing that loads or changes places
// shows in the light.
void TileMesh::find_normals() {
    uint32_t count = shown.vertex_count;
    std::vector<Sum> sums(count, Sum{});
    for (uint32_t end = 0;; end = std::min(end + octave, finest)) {
        look_at(end);
        std::vector<std::array<float, 3>> now(shown.vertex_count, std::array<float, 3>{});
        add_normals(&now);
        for (uint32_t i = 0; i < shown.vertex_count; i++) {
            if (end == 0) std::copy_n(now[i].data(), 3, sums[i].start);
            if (octave_end(shown.increments[i]) == end) std::copy_n(now[i].data(), 3, sums[i].end);
        }
        if (end == finest) break;
    }
    scree_frame up = frame();
    const float upward[3] = {(float)up.axes[2][0], (float)up.axes[2][1], (float)up.axes[2][2]};
    border_places.assign(count, 0);
    for (uint32_t i = 0; i < count; i++) {
        TileVertex &vertex = vertices[i];
        for (int16_t *normal : {vertex.normal, vertex.origin_normal}) put_normal(upward, normal); // as at a pole
        put_normal(sums[i].end, vertex.normal);
        put_normal(sums[i].start, vertex.origin_normal);
        if (!is_border(header(), shown.vertices[i])) continue;
        border_places[i] = (uint32_t)border_sums.size();
        border_sums.push_back(sums[i]);
    }
    both_sums = border_sums;
}

// As the shader has it.
void TileMesh::normal_at(uint32_t vertex, double level, float normal[3]) const {
    const TileVertex &at = vertices[vertex];
    double from = std::max(at.increment - 1, 0);
    double to = std::ceil(std::max<double>(at.increment, 1) / octave) * octave;
    double weight = std::clamp((level - from) / (to - from), 0.0, 1.0);
    for (int axis = 0; axis < 3; axis++)
        normal[axis] = (float)(at.origin_normal[axis] + weight * (at.normal[axis] - at.origin_normal[axis]));
}

void TileMesh::positions(std::vector<float> *place) const {
    scree_frame own = frame();
    place->resize(3 * (size_t)shown.vertex_count);
    for (uint32_t i = 0; i < shown.vertex_count; i++)
        for (int axis = 0; axis < 3; axis++) {
            double along = 0;
            for (int k = 0; k < 3; k++) along += (place_of(vertices[i], k) - own.origin[k]) * own.axes[axis][k];
            (*place)[3 * (size_t)i + (size_t)axis] = (float)along;
        }
}

void TileMesh::base_heights(const scree_terrain &terrain, float *lowest, float *highest) const {
    scree_select_heights(&terrain, &header(), 0, shown.vertices, lowest, highest);
}

size_t TileMesh::bytes() const {
    return player_memory(player.get())->used_bytes +
           2 * (vertices.capacity() * sizeof(TileVertex) + indices.capacity() * sizeof(uint32_t) +
                seam_vertices.capacity() * sizeof(TileVertex) + seam_indices.capacity() * sizeof(uint32_t)) +
           border_places.capacity() * sizeof(uint32_t) +
           border_sums.capacity() * (2 * sizeof(Sum) + sizeof(BorderVertex));
}

// ---- the scale ----

bool TileMesh::seek(double level, uint64_t *splits) {
    shown_level = std::clamp(level, 0.0, (double)finest);
    uint32_t wanted = (uint32_t)std::ceil(shown_level), before = shown.vertex_count;
    if (wanted == shown_rung) return false;
    shown_rung = wanted;
    scree_player_seek_rung(player.get(), wanted);
    scree_player_look(player.get(), &shown);
    *splits += shown.vertex_count > before ? shown.vertex_count - before : before - shown.vertex_count;
    copy_changed_slots();
    own_is_current = false;
    return true;
}

// Triangles that the seam replaces become what they are again at the next stitch, which a change of scale asks for.
void TileMesh::copy_changed_slots() {
    version++;
    scree_range range;
    while (scree_player_dirty_slots(player.get(), &range)) {
        std::copy(shown.indices + range.first, shown.indices + range.end, indices.begin() + range.first);
        index_pages.mark(range.first, range.end, version);
    }
}
