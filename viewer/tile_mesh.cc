#include "viewer/tile_mesh.h"

#include <algorithm>
#include <cmath>

extern "C" {
#include "stream/player.h"
}

namespace {

constexpr double PLACE_STEPS_M =
    1 << 20; // places are multiples of a 2^-20th metre: both tiles of a border say the same
constexpr double NORMAL_UNIT = 32767;

void put_place(const double place[3], TileVertex *vertex) {
    for (int i = 0; i < 3; i++) {
        double rounded = std::round(place[i] * PLACE_STEPS_M) / PLACE_STEPS_M;
        vertex->high[i] = (float)rounded;
        vertex->low[i] = (float)(rounded - (double)vertex->high[i]);
    }
}

double place_of(const TileVertex &vertex, int axis) {
    return (double)vertex.high[axis] + vertex.low[axis];
}

// A vertex whose triangles have no area keeps the normal that it had.
void put_normal(const float sum[3], int16_t normal[3]) {
    double length = std::sqrt((double)sum[0] * sum[0] + (double)sum[1] * sum[1] + (double)sum[2] * sum[2]);
    for (int i = 0; i < 3 && length > 0; i++) {
        double part = NORMAL_UNIT * sum[i] / length;
        normal[i] = (int16_t)(part < 0 ? part - 0.5 : part + 0.5);
    }
}

// MAP_SPAN times as wide as the rectangle, which lies in its middle.
uint16_t map_of(double value, double low, double high) {
    double share = high > low ? (value - low) / (high - low) : 0;
    return (uint16_t)std::lround(65535 * std::clamp(0.5 + (share - 0.5) / MAP_SPAN, 0.0, 1.0));
}

bool is_border(const scree_stream_header &header, const scree_vertex &vertex) {
    return vertex.x == 0 || vertex.y == 0 || vertex.x == header.columns || vertex.y == header.rows;
}

} // namespace

void PageVersions::mark(uint32_t first, uint32_t end, uint64_t version) {
    for (uint32_t page = first / page_items; page * page_items < end && page < pages.size(); page++)
        pages[page] = version;
}

TileMesh::TileMesh(Player taken, const MeshWorld &world) : player(std::move(taken)), world(world) {
    scree_player_seek_rung(player.get(), rungs_ready() - 1);
    scree_player_look(player.get(), &shown);
    vertices.assign(shown.vertex_count, TileVertex{});
    vertex_pages.resize(vertices.size());
    indices.assign(3 * (size_t)shown.triangle_count, 0);
    index_pages.resize(indices.size());
    place_vertices();
    find_normals();
    find_origins();
    scree_player_seek_rung(player.get(), 0);
    scree_player_look(player.get(), &shown);
    scree_player_dirty_all(player.get());
    copy_changed_slots();
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
        vertex.increment = is_border(tile, from) ? 0 : (int16_t)shown.increments[i];
    }
}

// Those inside morph from the vertex that they were split from, as it was before their increment.
void TileMesh::find_origins() {
    const progressive *all = player_playback(player.get())->progressive;
    for (uint32_t i = 0; i < shown.vertex_count; i++) {
        TileVertex &vertex = vertices[i];
        uint32_t from = i;
        if (vertex.increment > 0)
            while (shown.increments[from] >= shown.increments[i]) from = all->splits[from - all->base_vertices].parent;
        const TileVertex &origin = vertices[from];
        for (int axis = 0; axis < 3; axis++) {
            vertex.delta[axis] = (float)(place_of(origin, axis) - place_of(vertex, axis));
            vertex.origin_normal[axis] = origin.normal[axis];
        }
        vertex.origin_height_m = origin.height_m;
    }
}

// Of the finest mesh that is there, whatever is shown: so light does not change with the scale.
void TileMesh::find_normals() {
    std::vector<Sum> sums(shown.vertex_count, Sum{});
    border_places.assign(shown.vertex_count, 0);
    for (uint32_t slot = 0; slot < 3 * shown.triangle_count; slot += 3) {
        const TileVertex *corner[3];
        for (int i = 0; i < 3; i++) corner[i] = &vertices[shown.indices[slot + (uint32_t)i]];
        double u[3], v[3];
        for (int axis = 0; axis < 3; axis++) {
            u[axis] = place_of(*corner[1], axis) - place_of(*corner[0], axis);
            v[axis] = place_of(*corner[2], axis) - place_of(*corner[0], axis);
        }
        double normal[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        for (int i = 0; i < 3; i++)
            for (int axis = 0; axis < 3; axis++)
                sums[shown.indices[slot + (uint32_t)i]].normal[axis] += (float)normal[axis];
    }
    scree_frame up = frame();
    for (uint32_t i = 0; i < shown.vertex_count; i++) {
        for (int axis = 0; axis < 3; axis++)
            vertices[i].normal[axis] = (int16_t)std::lround(NORMAL_UNIT * up.axes[2][axis]);
        put_normal(sums[i].normal, vertices[i].normal);
        if (!is_border(header(), shown.vertices[i])) continue;
        border_places[i] = (uint32_t)border_sums.size();
        border_sums.push_back(sums[i]);
    }
    both_sums = border_sums;
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

bool TileMesh::is_on_data(const TileVertex &vertex) {
    auto is_within = [](uint16_t map) { return std::fabs(map / 65535.0 - 0.5) * MAP_SPAN < 0.5 - 1e-4; };
    return is_within(vertex.map[0]) && is_within(vertex.map[1]);
}

void TileMesh::base_heights(const scree_terrain &terrain, float *lowest, float *highest) const {
    scree_select_heights(&terrain, &header(), 0, shown.vertices, lowest, highest);
}

size_t TileMesh::bytes() const {
    return player_memory(player.get())->used_bytes +
           2 * (vertices.capacity() * sizeof(TileVertex) + indices.capacity() * sizeof(uint32_t) +
                seam_vertices.capacity() * sizeof(TileVertex) + seam_indices.capacity() * sizeof(uint32_t)) +
           border_places.capacity() * sizeof(uint32_t) + 2 * border_sums.capacity() * sizeof(Sum);
}

// ---- the scale ----

bool TileMesh::seek(double level, uint64_t *splits) {
    shown_level = std::clamp(level, 0.0, (double)(rungs_ready() - 1));
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

// ---- the neighbours ----

const scree_stitch_tile &TileMesh::stitch_tile() {
    if (!own_is_current) scree_stitch_look(player.get(), &own, nullptr);
    own_is_current = true;
    return own;
}

// How far a common line's vertices of this tile lie behind those of another, in steps along it.
int64_t TileMesh::steps_behind(const TileMesh &other, scree_side side) const {
    const scree_stream_header &here = header(), &there = other.header();
    bool is_north_south = side == SCREE_EAST || side == SCREE_WEST;
    return std::llround(is_north_south ? (here.south - there.south) / here.spacing_y
                                       : (here.west - there.west) / here.spacing_x);
}

// Both sides list their vertices along the common line from its low end: a walk along both finds those in common.
void TileMesh::share_normals(const std::vector<Neighbour> &neighbours) {
    const scree_stitch_tile &tile = stitch_tile();
    std::vector<Sum> now = border_sums;
    for (const Neighbour &beside : neighbours) {
        const scree_border &border = tile.borders[beside.side];
        const scree_border &other = beside.mesh->stitch_tile().borders[(beside.side + 2) % SCREE_SIDES];
        int64_t behind = steps_behind(*beside.mesh, beside.side);
        bool is_north_south = beside.side == SCREE_EAST || beside.side == SCREE_WEST;
        auto along = [is_north_south](const scree_vertex &at) { return is_north_south ? at.y : at.x; };
        for (uint32_t i = 0, k = 0; i < border.vertex_count && k < other.vertex_count;) {
            int64_t mine = behind + along(shown.vertices[border.vertices[i]]);
            int64_t its = along(beside.mesh->shown.vertices[other.vertices[k]]);
            if (mine == its) {
                const Sum &sum = beside.mesh->border_sums[beside.mesh->border_places[other.vertices[k]]];
                Sum &both = now[border_places[border.vertices[i]]];
                for (int j = 0; j < 3; j++) both.normal[j] += sum.normal[j];
            }
            i += mine <= its;
            k += its <= mine;
        }
    }
    for (const scree_border &border : tile.borders)
        for (uint32_t i = 0; i < border.vertex_count; i++) {
            uint32_t at = border.vertices[i];
            const Sum &sum = now[border_places[at]];
            Sum &before = both_sums[border_places[at]];
            if (std::equal(sum.normal, sum.normal + 3, before.normal)) continue;
            before = sum;
            put_normal(sum.normal, vertices[at].normal);
            std::copy_n(vertices[at].normal, 3, vertices[at].origin_normal);
            vertex_pages.mark(at, at + 1, ++version);
        }
}

bool TileMesh::stitch(const std::vector<Neighbour> &neighbours, std::string *error) {
    const scree_stitch_tile &tile = stitch_tile();
    version++;
    for (uint32_t triangle : replaced)
        if (triangle < shown.triangle_count) {
            std::copy_n(shown.indices + 3 * (size_t)triangle, 3, indices.begin() + 3 * (std::ptrdiff_t)triangle);
            index_pages.mark(3 * triangle, 3 * triangle + 3, version);
        }
    std::vector<scree_stitch_neighbour> beside;
    for (const Neighbour &neighbour : neighbours) beside.push_back({&neighbour.mesh->stitch_tile(), neighbour.side});
    scree_stitch_size room = scree_stitch_bound(&tile, beside.data(), (uint32_t)beside.size());
    std::vector<scree_vertex> further(room.vertices);
    std::vector<scree_stitch_source> sources(room.vertices);
    std::vector<uint32_t> fans(3 * (size_t)room.triangles);
    replaced.resize(room.replaced);
    scree_stitch stitch = {room, replaced.data(), further.data(), sources.data(), fans.data(), {}};
    scree_error failure = {};
    bool is_stitched = scree_stitch_borders(&tile, beside.data(), (uint32_t)beside.size(), shown.vertex_count, &stitch,
                                            &failure) == SCREE_OK;
    if (!is_stitched) *error = failure.text;
    replaced.resize(stitch.count.replaced);
    for (uint32_t triangle : replaced) {
        std::fill_n(indices.begin() + 3 * (std::ptrdiff_t)triangle, 3, 0u);
        index_pages.mark(3 * triangle, 3 * triangle + 3, version);
    }
    seam_version++;
    seam_vertices.clear();
    seam_indices.resize(3 * (size_t)stitch.count.triangles);
    for (size_t i = 0; i < seam_indices.size(); i++) {
        size_t before = i < 3 ? 0 : i - i % 3 - 3, known = before; // a fan's triangle shares two with the one before
        while (known < i && fans[known] != fans[i]) known++;
        seam_indices[i] = known < i ? seam_indices[known] : (uint32_t)seam_vertices.size();
        if (known < i) continue;
        if (fans[i] < shown.vertex_count) {
            seam_vertices.push_back(vertices[fans[i]]);
        } else {
            const scree_stitch_source &source = sources[fans[i] - shown.vertex_count];
            seam_vertices.push_back(neighbours[source.neighbour].mesh->vertices[source.vertex]);
        }
    }
    return is_stitched;
}
