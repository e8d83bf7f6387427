// A tile as it is drawn: its vertices in the world, the triangles of the scale shown, and the seam to its neighbours.
// Plain arrays with a note of what has changed; no graphics.
#ifndef SCREE_VIEWER_TILE_MESH_H
#define SCREE_VIEWER_TILE_MESH_H

#include "viewer/tile_file_io.h"
#include "viewer/tile_vertex.h"

#include <array>
#include <scree/select.h>
#include <scree/stitch.h>
#include <vector>

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

constexpr int32_t OCTAVE_RUNGS = 4; // of the ladder

class TileMesh {
  public:
    // The player has a mesh at least, and no normals. `is_final`: nothing more will come. Any thread.
    TileMesh(Player player, bool is_final, const MeshWorld &world);

    const scree_stream_header &header() const { return *scree_player_header(player.get()); }
    // What can be shown: whole octaves of the ladder, because light goes by them (or all that there will be).
    uint32_t rungs_ready() const { return finest + 1; }
    float octave_increments() const { return (float)octave; }
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

    // Gives the vertices of the border the normals that they have with the triangles of both sides, at the finest
    // meshes that are there: to be called when neighbours are others, not when scales change.
    void share_normals(const std::vector<Neighbour> &neighbours);
    // Makes the seam; no neighbours: none. False, and one line in `error`, when the tiles are not of one build.
    bool stitch(const std::vector<Neighbour> &neighbours, std::string *error);

    // What to send. `indices` has the shown triangles first, those that the seam replaces as empty ones.
    std::vector<TileVertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<TileVertex> seam_vertices; // those of neighbour k have slot SLOT_NEIGHBOURS + k
    std::vector<uint32_t> seam_indices;
    float levels[SLOT_COUNT] = {};                    // to be set for every frame
    PageVersions vertex_pages{64}, index_pages{1024}; // of 4 KiB
    uint64_t version = 1, seam_version = 1;           // of the latest change

    scree_frame frame() const;                       // of the tile, in the world's metres
    void positions(std::vector<float> *place) const; // of the shown vertices, in that frame
    // Bounds of the tile and all below it, from its base mesh (scree_select_heights).
    void base_heights(const scree_terrain &terrain, float *lowest, float *highest) const;
    double box[2][3]; // of all vertices, in that frame
    float lowest_m, highest_m;

  private:
    struct Sum {
        float start[3], end[3]; // areas times normals, of the base mesh and at the end of the vertex's octave
    };
    struct BorderVertex {
        int32_t place; // lattice steps along the side, from the west or south
        uint32_t vertex;
        uint32_t from, to; // vertices of the edge that it rises from; itself on the base mesh
        float share;       // of the way between them
    };
    void look_at(uint32_t rung);
    void place_vertices();
    uint32_t octave_end(uint32_t increment) const;
    void add_normals(std::vector<std::array<float, 3>> *sums) const;
    void find_normals();
    void normal_at(uint32_t vertex, double level, float normal[3]) const;
    void find_origins();
    void list_borders();
    void find_border_origins(std::vector<BorderVertex> *border);
    void turn_border_origins();
    void copy_changed_slots();
    const scree_stitch_tile &stitch_tile();
    int64_t steps_behind(const TileMesh &other, scree_side side) const;
    void put_seam(const std::vector<uint32_t> &fans, const std::vector<scree_stitch_source> &sources,
                  const std::vector<Neighbour> &neighbours);

    Player player;
    MeshWorld world;
    scree_arrays shown = {};
    uint32_t octave = 1; // increments
    uint32_t finest = 0; // rung that can be shown
    double shown_level = 0;
    uint32_t shown_rung = 0;
    scree_stitch_tile own = {};
    bool own_is_current = false;
    std::vector<uint32_t> replaced;               // triangles
    std::vector<BorderVertex> sides[SCREE_SIDES]; // all that are there, in order
    std::vector<Sum> border_sums, both_sums;      // of the vertices of the border: of this tile, and of both
    std::vector<uint32_t> border_places;          // of every vertex: where it is among those
};

#endif
