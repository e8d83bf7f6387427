// The border of a tile as it is drawn: where its vertices come from, the light that both sides share, and the seam.
#include "viewer/tile_mesh.h"

#include <algorithm>
#include <cmath>

// ---- where vertices of the border come from ----

// Those of the corners belong to two sides, and are on every base mesh.
void TileMesh::list_borders() {
    const scree_stream_header &tile = header();
    for (uint32_t i = 0; i < shown.vertex_count; i++) {
        const scree_vertex &at = shown.vertices[i];
        auto list = [&](scree_side side, int32_t place) {
            sides[side].push_back({place, i, i, i, 0});
            vertices[i].slot = (int16_t)(SLOT_SIDES + side);
        };
        if (at.y == 0) list(SCREE_SOUTH, at.x);
        if (at.y == tile.rows) list(SCREE_NORTH, at.x);
        if (at.x == 0) list(SCREE_WEST, at.y);
        if (at.x == tile.columns) list(SCREE_EAST, at.y);
    }
    for (std::vector<BorderVertex> &side : sides) {
        std::sort(side.begin(), side.end(),
                  [](const BorderVertex &a, const BorderVertex &b) { return a.place < b.place; });
        find_border_origins(&side);
    }
    turn_border_origins();
}

// Each rises from the straight edge that the rung before has at its place: always told from the lower end, so that
// both tiles compute the same.
void TileMesh::find_border_origins(std::vector<BorderVertex> *border) {
    for (size_t i = 1; i + 1 < border->size(); i++) {
        BorderVertex &at = (*border)[i];
        int increment = shown.increments[at.vertex];
        if (increment == 0) continue;
        size_t before = i - 1, after = i + 1; // both ends are of the base mesh
        while (before > 0 && shown.increments[(*border)[before].vertex] >= increment) before--;
        while (after + 1 < border->size() && shown.increments[(*border)[after].vertex] >= increment) after++;
        const BorderVertex &from = (*border)[before], &to = (*border)[after];
        at.from = from.vertex;
        at.to = to.vertex;
        at.share = (float)((double)(at.place - from.place) / (to.place - from.place));
    }
}

// From coarse to fine: each is told by vertices that were there before.
void TileMesh::turn_border_origins() {
    std::vector<const BorderVertex *> order;
    for (const std::vector<BorderVertex> &side : sides)
        for (const BorderVertex &at : side)
            if (at.from != at.to) order.push_back(&at);
    std::sort(order.begin(), order.end(),
              [](const BorderVertex *a, const BorderVertex *b) { return a->vertex < b->vertex; });
    for (const BorderVertex *at : order) {
        TileVertex &vertex = vertices[at->vertex];
        float from[3], to[3], between[3];
        normal_at(at->from, vertex.increment - 1, from);
        normal_at(at->to, vertex.increment - 1, to);
        for (int axis = 0; axis < 3; axis++) between[axis] = from[axis] + at->share * (to[axis] - from[axis]);
        put_normal(between, vertex.origin_normal);
        put_edge_origin(vertices[at->from], vertices[at->to], at->share, &vertex);
    }
}

// ---- light ----

// How far a common line's vertices of this tile lie behind those of another, in steps along it.
int64_t TileMesh::steps_behind(const TileMesh &other, scree_side side) const {
    const scree_stream_header &here = header(), &there = other.header();
    bool is_north_south = side == SCREE_EAST || side == SCREE_WEST;
    return std::llround(is_north_south ? (here.south - there.south) / here.spacing_y
                                       : (here.west - there.west) / here.spacing_x);
}

// Both sides list their vertices along the common line from its low end: a walk along both finds those in common. What
// a zoom ends with is what the next begins with.
void TileMesh::share_normals(const std::vector<Neighbour> &neighbours) {
    std::vector<Sum> now = border_sums;
    for (const Neighbour &beside : neighbours) {
        const std::vector<BorderVertex> &mine = sides[beside.side];
        const std::vector<BorderVertex> &its = beside.mesh->sides[(beside.side + 2) % SCREE_SIDES];
        int64_t behind = steps_behind(*beside.mesh, beside.side);
        int zooms = beside.mesh->header().zoom - header().zoom;
        for (size_t i = 0, k = 0; i < mine.size() && k < its.size();) {
            int64_t place = behind + mine[i].place;
            if (place == its[k].place) {
                const Sum &sum = beside.mesh->border_sums[beside.mesh->border_places[its[k].vertex]];
                Sum &both = now[border_places[mine[i].vertex]];
                for (int axis = 0; axis < 3; axis++) {
                    both.start[axis] += zooms < 0 ? sum.end[axis] : sum.start[axis];
                    both.end[axis] += zooms > 0 ? sum.start[axis] : sum.end[axis];
                }
            }
            bool is_behind = place <= its[k].place, is_ahead = place >= its[k].place;
            i += is_behind;
            k += is_ahead;
        }
    }
    bool is_other = false;
    for (const std::vector<BorderVertex> &side : sides)
        for (const BorderVertex &at : side) {
            const Sum &sum = now[border_places[at.vertex]], &before = both_sums[border_places[at.vertex]];
            if (std::equal(sum.start, sum.start + 3, before.start) && std::equal(sum.end, sum.end + 3, before.end))
                continue;
            put_normal(sum.end, vertices[at.vertex].normal);
            if (vertices[at.vertex].increment == 0) put_normal(sum.start, vertices[at.vertex].origin_normal);
            is_other = true;
        }
    both_sums = std::move(now);
    if (!is_other) return;
    turn_border_origins();
    version++;
    for (const std::vector<BorderVertex> &side : sides)
        for (const BorderVertex &at : side) vertex_pages.mark(at.vertex, at.vertex + 1, version);
}

// ---- the seam ----

const scree_stitch_tile &TileMesh::stitch_tile() {
    if (!own_is_current) scree_stitch_look(player.get(), &own, nullptr);
    own_is_current = true;
    return own;
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
    fans.resize(3 * (size_t)stitch.count.triangles);
    put_seam(fans, sources, neighbours);
    return is_stitched;
}

void TileMesh::put_seam(const std::vector<uint32_t> &fans, const std::vector<scree_stitch_source> &sources,
                        const std::vector<Neighbour> &neighbours) {
    seam_version++;
    seam_vertices.clear();
    seam_indices.resize(fans.size());
    for (size_t i = 0; i < fans.size(); i++) {
        size_t before = i < 3 ? 0 : i - i % 3 - 3, known = before; // a fan's triangle shares two with the one before
        while (known < i && fans[known] != fans[i]) known++;
        seam_indices[i] = known < i ? seam_indices[known] : (uint32_t)seam_vertices.size();
        if (known < i) continue;
        if (fans[i] < shown.vertex_count) {
            seam_vertices.push_back(vertices[fans[i]]);
        } else {
            const scree_stitch_source &source = sources[fans[i] - shown.vertex_count];
            seam_vertices.push_back(neighbours[source.neighbour].mesh->vertices[source.vertex]);
            // a tile with more neighbours than slots has all of its borders at full weight
            seam_vertices.back().slot = (int16_t)std::min(SLOT_NEIGHBOURS + (int)source.neighbour, SLOT_COUNT - 1);
        }
    }
}
