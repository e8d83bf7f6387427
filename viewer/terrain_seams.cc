// What the drawn tiles of a terrain have to agree on with their neighbours: light, seams, and levels along borders.
#include "viewer/terrain_set.h"

#include <algorithm>
#include <unordered_set>

static const size_t MOST_NEIGHBOURS = SLOT_COUNT - SLOT_NEIGHBOURS;

// A tile whose neighbours are others has to be stitched anew.
void TerrainSet::find_neighbours(const std::vector<size_t> &old_places) {
    std::vector<scree_tile_id> ids;
    for (const Shown &one : drawn) ids.push_back(tiles[one.tile].id);
    uint32_t count = (uint32_t)ids.size();
    std::vector<uint32_t> at_side(count);
    std::vector<std::vector<TileMesh::Neighbour>> found(count);
    beside.assign(count, {});
    for (uint32_t i = 0; i < count; i++) {
        for (int side = 0; side < SCREE_SIDES; side++) {
            uint32_t found_there = scree_cut_neighbours(ids.data(), count, manifest.terrain.profile, &ids[i],
                                                        (scree_side)side, at_side.data(), count);
            for (uint32_t k = 0; k < found_there; k++) {
                found[i].push_back({drawn[at_side[k]].mesh.get(), (scree_side)side});
                beside[i].push_back(at_side[k]);
            }
        }
        if (old_places[i] == SIZE_MAX || neighbours[old_places[i]] != found[i]) is_due[i] = is_moved[i] = 1;
    }
    neighbours = std::move(found);
}

void TerrainSet::stitch_changed(bool stitched) {
    std::unordered_set<const TileMesh *> others;
    for (size_t i = 0; i < drawn.size(); i++)
        if (changed[i]) others.insert(drawn[i].mesh.get());
    for (size_t i = 0; i < drawn.size(); i++)
        for (const TileMesh::Neighbour &beside : neighbours[i])
            if (stitched != was_stitched || others.count(beside.mesh) != 0) is_due[i] = 1;
    was_stitched = stitched;
    for (size_t i = 0; i < drawn.size(); i++)
        if (is_moved[i]) drawn[i].mesh->share_normals(neighbours[i]);
    for (size_t i = 0; i < drawn.size(); i++) {
        std::string error;
        if (is_due[i] && !drawn[i].mesh->stitch(stitched ? neighbours[i] : std::vector<TileMesh::Neighbour>{}, &error))
            log(manifest.path_of(tiles[drawn[i].tile].id) + ": " + error);
    }
}

// By which level the vertices of a side morph, so that both tiles agree: by the finer tile's, whose vertices are drawn
// on both sides. Beside tiles of a finer zoom, all that this one has are where they belong.
float TerrainSet::side_level(uint32_t at, scree_side side) const {
    const TileMesh &mesh = *drawn[at].mesh;
    float level = (float)mesh.level();
    for (size_t k = 0; k < beside[at].size(); k++) {
        if (neighbours[at][k].side != side) continue;
        const TileMesh &other = *neighbours[at][k].mesh;
        int zooms = other.header().zoom - mesh.header().zoom;
        bool is_same_ladder = zooms != 0 || other.header().rungs[0].rung == mesh.header().rungs[0].rung;
        bool is_crowded = beside[at].size() > MOST_NEIGHBOURS || beside[beside[at][k]].size() > MOST_NEIGHBOURS;
        if (zooms > 0 || !is_same_ladder || is_crowded) return LEVEL_FULL;
        if (zooms == 0) level = std::max(level, (float)other.level());
    }
    return level;
}

void TerrainSet::agree_on_levels(bool stitched) {
    for (uint32_t i = 0; i < drawn.size(); i++) {
        TileMesh &mesh = *drawn[i].mesh;
        std::fill_n(mesh.levels, SLOT_COUNT, (float)mesh.level());
        for (int side = 0; side < SCREE_SIDES && stitched; side++)
            mesh.levels[SLOT_SIDES + side] = side_level(i, (scree_side)side);
        for (size_t k = 0; k < beside[i].size() && stitched; k++)
            mesh.levels[std::min<size_t>(SLOT_NEIGHBOURS + k, SLOT_COUNT - 1)] =
                beside[i].size() > MOST_NEIGHBOURS
                    ? LEVEL_FULL
                    : side_level(beside[i][k], (scree_side)((neighbours[i][k].side + 2) % SCREE_SIDES));
    }
}
