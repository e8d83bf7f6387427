// A vertex as the graphics card gets it: the same bytes in every tile that has it, so that tiles meet exactly on the
// screen. Its place in the world is kept as two floats a coordinate, and drawn less the eye's (high parts, low parts),
// which leaves no error that shows even on the ground of a globe.
#ifndef SCREE_VIEWER_TILE_VERTEX_H
#define SCREE_VIEWER_TILE_VERTEX_H

#include <cstdint>

constexpr double MAP_SPAN = 2; // beyond the data there are places, too

struct TileVertex {
    float high[3], low[3]; // their sum is the place in the world
    float delta[3];        // from there to where it morphs from
    float height_m, origin_height_m;
    uint16_t map[2]; // 0 .. 65535 from the south-west, over MAP_SPAN times the rectangle of the data
    int16_t normal[3];
    int16_t increment;        // scree_morph_weight, by the level of
    int16_t origin_normal[3]; // when it appears; it turns more slowly than it moves
    int16_t slot;             // this one of the tile's levels
};
static_assert(sizeof(TileVertex) == 64, "what the shaders are told");

// Levels that a tile draws with: its own; one for each of its sides, on which both tiles have to agree; and those of
// its neighbours' sides, for the vertices that the seam has from them.
constexpr int SLOT_OWN = 0, SLOT_SIDES = 1, SLOT_NEIGHBOURS = 5, SLOT_COUNT = 64;
constexpr float LEVEL_FULL = 1e6f; // all vertices are where they belong

// Rounded to a multiple of a 2^-20th metre, so that both tiles of a border say the same.
void put_place(const double place[3], TileVertex *vertex);

inline double place_of(const TileVertex &vertex, int axis) {
    return (double)vertex.high[axis] + vertex.low[axis];
}

// The direction of a sum of normals; where it has none, the normal stays what it was.
void put_normal(const float sum[3], int16_t normal[3]);

// A coordinate between `low` and `high`, as `map` has it.
uint16_t map_of(double value, double low, double high);
bool is_on_data(const TileVertex &vertex); // within their rectangle

// Where a vertex morphs from: a share of the way from one vertex to another.
void put_edge_origin(const TileVertex &from, const TileVertex &to, double share, TileVertex *vertex);

#endif
