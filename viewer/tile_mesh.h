// A tile as it is drawn: its vertices in the world, the triangles of the scale shown, and the seam to its neighbours.
// Plain arrays with a note of what has changed; no graphics.
//
// A vertex is the same bytes in every tile that has it, so that tiles meet exactly on the screen: its place in the
// world is kept as two floats a coordinate, and drawn less the eye's (high parts, low parts), which leaves no error
// that shows even on the ground of a globe.
#ifndef SCREE_VIEWER_TILE_MESH_H
#define SCREE_VIEWER_TILE_MESH_H

#include "viewer/tile_file_io.h"

#include <scree/select.h>
#include <scree/stitch.h>
#include <vector>

constexpr double MAP_SPAN = 2; // beyond the data there are places, too

struct TileVertex {
    float high[3], low[3]; // their sum is the place in the world
    float delta[3];        // from there to where it morphs from
    float height_m, origin_height_m;
    uint16_t map[2]; // 0 .. 65535 from the south-west, over MAP_SPAN times the rectangle of the data
    int16_t normal[3];
    int16_t increment; // scree_morph_weight; 0 on the border, which does not morph
    int16_t origin_normal[3];
    int16_t spare;
};
static_assert(sizeof(TileVertex) == 64, "what the shaders are told");

// What is the same for all tiles.
struct MeshWorld {
    double metres_x = 1, metres_y = 1; // of a CRS unit; local profile
    double bounds[4] = {0, 0, 1, 1};   // of the data: degrees or CRS units
};

// Which pages of an array have changed since when: whoever sends it on remembers the version that it has sent.
class PageVersions {
  public:
    explicit PageVersions(uint32_t page_items) : page_items(page_items) {}
    const uint32_t page_items;
    void resize(size_t items) { pages.resize((items + page_items - 1) / page_items, 0); }
    void mark(uint32_t first, uint32_t end, uint64_t version);
    size_t count() const { return pages.size(); }
    uint64_t operator[](size_t page) const { return pages[page]; }

  private:
    std::vector<uint64_t> pages;
};

class TileMesh {
  public:
    // The player has a mesh at least, and no normals. Any thread.
    TileMesh(Player player, const MeshWorld &world);

    const scree_stream_header &header() const { return *scree_player_header(player.get()); }
    uint32_t rungs_ready() const { return scree_player_rungs_ready(player.get()); }
    size_t bytes() const; // of memory, twice what is sent to the graphics card included

    // Shows a level; between two rungs the finer one's triangles, on their way. True: other triangles than before.
    // `splits` grows by the vertices that came or went.
    bool seek(double level, uint64_t *splits);
    double level() const { return shown_level; }
    uint32_t rung() const { return shown_rung; }

    uint32_t vertex_count() const { return shown.vertex_count; }
    uint32_t triangle_count() const { return shown.triangle_count; }

    struct Neighbour {
        TileMesh *mesh;
        scree_side side; // of this tile
        bool operator==(const Neighbour &other) const { return mesh == other.mesh && side == other.side; }
    };

    // Gives the vertices of the border the normals that both sides have at their scales.
    void share_normals(const std::vector<Neighbour> &neighbours);
    // Makes the seam; no neighbours: none. False, and one line in `error`, when the tiles are not of one build.
    bool stitch(const std::vector<Neighbour> &neighbours, std::string *error);

    // What to send. `indices` has the shown triangles first, those that the seam replaces as empty ones.
    std::vector<TileVertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<TileVertex> seam_vertices;
    std::vector<uint32_t> seam_indices;
    PageVersions vertex_pages{64}, index_pages{1024}; // of 4 KiB
    uint64_t version = 1, seam_version = 1;           // of the latest change

    scree_frame frame() const;                        // of the tile, in the world's metres
    void positions(std::vector<float> *place) const;  // of the shown vertices, in that frame
    static bool is_on_data(const TileVertex &vertex); // within their rectangle
    // Bounds of the tile and all below it, from its base mesh (scree_select_heights).
    void base_heights(const scree_terrain &terrain, float *lowest, float *highest) const;
    double box[2][3]; // of all vertices, in that frame
    float lowest_m, highest_m;

  private:
    void place_vertices();
    void find_origins();
    void find_normals();
    void copy_changed_slots();
    const scree_stitch_tile &stitch_tile();
    int64_t steps_behind(const TileMesh &other, scree_side side) const;

    Player player;
    MeshWorld world;
    scree_arrays shown = {};
    double shown_level = 0;
    uint32_t shown_rung = 0;
    scree_stitch_tile own = {};
    bool own_is_current = false;
    std::vector<uint32_t> replaced; // triangles
    struct Sum {
        float normal[3];
    };
    // Of the vertices of the border, areas times normals of this tile's own triangles; and where they stand in it.
    std::vector<Sum> border_sums, both_sums;
    std::vector<uint32_t> border_places; // of every vertex
};

#endif
