// All tiles of a terrain: which are held, which are drawn and how, what is to be loaded and what has to go. Knows no
// graphics; frames never wait for a file.
#ifndef SCREE_VIEWER_TERRAIN_SET_H
#define SCREE_VIEWER_TERRAIN_SET_H

#include "viewer/loaders.h"
#include "viewer/manifest_io.h"
#include "viewer/moving_cut.h"
#include "viewer/terrain_settings.h"

#include <functional>

class TerrainSet {
  public:
    using Log = std::function<void(const std::string &)>;

    // `log` gets one line for each tile that cannot be had.
    TerrainSet(Manifest manifest, const TerrainOptions &options, Log log);

    // Loads the roots. False, and one line in `error`, when they cannot be had.
    bool open(std::string *error);

    // Lowest and highest height of the data, from the coarsest meshes that show more than a corner of them.
    std::pair<double, double> data_heights_m();

    // One frame: takes what has been loaded, chooses, moves what is drawn towards it, stitches, asks for more.
    void frame(const scree_view &view, const TerrainSettings &settings, double seconds);

    struct Shown {
        uint32_t tile;
        std::shared_ptr<TileMesh> mesh; // at its scale
    };
    const std::vector<Shown> &shown() const { return drawn; }
    const scree_tile_id &id(uint32_t tile) const { return tiles[tile].id; }
    uint32_t tile_count() const { return (uint32_t)tiles.size(); }
    const scree_terrain &terrain() const { return manifest.terrain; }
    const TerrainFigures &figures() const { return told; }
    std::pair<double, double> svo_range_m() const; // the finest and the coarsest of all
    bool is_settled() const;                       // nothing of what the last frame wanted is on its way

  private:
    struct Held {
        std::shared_ptr<TileMesh> mesh;
        uint64_t last_frame = 0; // in which it was drawn or above what was drawn
        size_t bytes = 0;
    };
    void take(LoadedTile loaded);
    void bury_retired();
    size_t bytes_to_send(const LoadedTile &loaded) const;
    void take_arrivals();
    void keep_heights(uint32_t tile, const TileMesh &mesh);
    void choose(const scree_view &view, const TerrainSettings &settings);
    void spread();
    void seek();
    void find_neighbours(const std::vector<size_t> &old_places);
    void stitch_changed(bool stitched);
    float side_level(uint32_t at, scree_side side) const;
    void agree_on_levels(bool stitched);
    uint64_t bytes_held() const;
    void tell_drawn();
    void request(const TerrainSettings &settings);
    void make_room(uint64_t memory_bytes);
    void drop(uint32_t tile);

    Manifest manifest;
    const MeshWorld world;
    const unsigned loader_count;
    Log log;
    std::vector<scree_select_tile> tiles;
    std::vector<uint32_t> parents;
    std::vector<Held> held;
    std::vector<char> is_final;    // nothing more will come: all of it is there, or the rest is broken
    std::vector<uint32_t> denied;  // final only because there is no room for more of them now
    std::vector<uint32_t> holding; // tiles with a mesh
    std::unique_ptr<MovingCut> cut;
    scree_selection selection = {};
    std::vector<scree_select_drawn> selected;
    std::vector<scree_select_wanted> wanted;
    std::vector<double> workspace;
    std::vector<Shown> drawn;
    std::vector<std::vector<TileMesh::Neighbour>> neighbours; // of each drawn
    std::vector<std::vector<uint32_t>> beside;                // the same, as places among the drawn
    std::vector<char> changed, is_due, is_moved; // for each drawn: its triangles are others; it has to be stitched;
                                                 // its neighbours are others
    bool was_stitched = true, is_first = true;
    uint64_t frame_number = 0;
    size_t asked = 0; // requests of the last frame
    TerrainFigures told;
    std::vector<std::shared_ptr<TileMesh>> retired; // replaced or dropped, but perhaps still drawn
    std::deque<LoadedTile> arrived;
    std::unique_ptr<Loaders> loaders; // the last member: its threads end first
};

#endif
