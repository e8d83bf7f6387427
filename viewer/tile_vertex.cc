#include "viewer/tile_vertex.h"

#include <algorithm>
#include <cmath>

static const double PLACE_STEPS_M = 1 << 20; // a metre
static const double NORMAL_UNIT = 32767;

void put_place(const double place[3], TileVertex *vertex) {
    for (int i = 0; i < 3; i++) {
        double rounded = std::round(place[i] * PLACE_STEPS_M) / PLACE_STEPS_M;
        vertex->high[i] = (float)rounded;
        vertex->low[i] = (float)(rounded - (double)vertex->high[i]);
    }
}

void put_normal(const float sum[3], int16_t normal[3]) {
    double length = std::sqrt((double)sum[0] * sum[0] + (double)sum[1] * sum[1] + (double)sum[2] * sum[2]);
    for (int i = 0; i < 3 && length > 0; i++) {
        double part = NORMAL_UNIT * sum[i] / length;
        normal[i] = (int16_t)(part < 0 ? part - 0.5 : part + 0.5);
    }
}

uint16_t map_of(double value, double low, double high) {
    double share = high > low ? (value - low) / (high - low) : 0;
    return (uint16_t)std::lround(65535 * std::clamp(0.5 + (share - 0.5) / MAP_SPAN, 0.0, 1.0));
}

bool is_on_data(const TileVertex &vertex) {
    auto is_within = [](uint16_t map) { return std::fabs(map / 65535.0 - 0.5) * MAP_SPAN < 0.5 - 1e-4; };
    return is_within(vertex.map[0]) && is_within(vertex.map[1]);
}

void put_edge_origin(const TileVertex &from, const TileVertex &to, double share, TileVertex *vertex) {
    for (int axis = 0; axis < 3; axis++) {
        double begin = place_of(from, axis), way = place_of(to, axis) - begin;
        vertex->delta[axis] = (float)(begin + share * way - place_of(*vertex, axis));
    }
    vertex->origin_height_m = (float)(from.height_m + share * ((double)to.height_m - from.height_m));
}
