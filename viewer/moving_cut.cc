#include "viewer/moving_cut.h"

#include <algorithm>

namespace {
constexpr double NEAR = 1e-9; // levels as far apart are the same
}

MovingCut::MovingCut(const std::vector<scree_select_tile> &tiles, const std::vector<char> &is_final)
    : all(tiles), is_final(is_final), parents(tiles.size(), NOWHERE), place(tiles.size(), NOWHERE) {
    for (uint32_t i = 0; i < all.size(); i++)
        for (uint32_t child = 0; child < all[i].child_count; child++) parents[all[i].first_child + child] = i;
}

// As fine as it can be shown by now.
double MovingCut::finest(uint32_t tile) const {
    return all[tile].rungs_ready == 0 ? 0 : all[tile].rungs_ready - 1.0;
}

bool MovingCut::is_whole(uint32_t tile) {
    bool is = is_final[tile] || (all[tile].header != nullptr && all[tile].rungs_ready == all[tile].header->rung_count);
    if (!is) wanted_whole.push_back(tile);
    return is;
}

double MovingCut::moved(double level, double target) const {
    return level < target ? std::min(level + most, target) : std::max(level - most, target);
}

uint32_t MovingCut::shown_ancestor(uint32_t tile) const {
    for (uint32_t at = parents[tile]; at != NOWHERE; at = parents[at])
        if (is_shown(at)) return at;
    return NOWHERE;
}

bool MovingCut::shows_below(uint32_t tile) const {
    auto first = std::lower_bound(shown.begin(), shown.end(), tile, [this](const CutTile &a, uint32_t b) {
        return scree_tile_compare(&all[a.tile].id, &all[b].id) <= 0;
    });
    if (first == shown.end()) return false;
    const scree_tile_id &below = all[first->tile].id, &id = all[tile].id;
    int levels = below.zoom - id.zoom;
    return levels > 0 && below.x >> levels == id.x && below.y >> levels == id.y;
}

void MovingCut::put(uint32_t tile, double level, double target) {
    level = std::min(level, finest(tile));
    next.push_back({tile, level});
    if (level < target - NEAR || level > target + NEAR) still = false;
}

// A shown tile gives way to its children once it shows what they begin with.
void MovingCut::refine(uint32_t ancestor, const scree_select_drawn *wanted, uint32_t count) {
    const scree_select_tile &tile = all[ancestor];
    double level = shown[place[ancestor]].level;
    still = false;
    if (!is_whole(ancestor) || level < finest(ancestor) - NEAR)
        return put(ancestor, moved(level, finest(ancestor)), finest(ancestor));
    for (uint32_t child = tile.first_child; child < tile.first_child + tile.child_count; child++) {
        const scree_select_drawn *found = std::find_if(wanted, wanted + count, [&](const scree_select_drawn &one) {
            uint32_t at = one.tile;
            while (at != NOWHERE && at != child) at = parents[at];
            return at == child;
        });
        if (found == wanted + count) continue; // out of sight
        double target = found->tile == child ? found->level : finest(child);
        put(child, std::min(moved(0, target), target), target);
    }
}

// All that is shown below a tile is at its base, and its children are.
bool MovingCut::all_at_base(uint32_t tile) const {
    for (uint32_t child = all[tile].first_child; child < all[tile].first_child + all[tile].child_count; child++)
        if (is_shown(child) ? shown[place[child]].level > NEAR : shows_below(child)) return false;
    return true;
}

// Takes what is shown below a tile down; false when something that is to be seen there cannot be drawn.
bool MovingCut::coarsen(uint32_t tile) {
    if (is_shown(tile)) {
        put(tile, moved(shown[place[tile]].level, 0), 0);
        return true;
    }
    if (!shows_below(tile)) {
        if (all[tile].rungs_ready == 0) return false;
        put(tile, 0, 0);
        return true;
    }
    if (all_at_base(tile) && is_whole(tile)) {
        put(tile, moved(finest(tile), 0), 0);
        return true;
    }
    for (uint32_t child = all[tile].first_child; child < all[tile].first_child + all[tile].child_count; child++)
        if (!coarsen(child)) return false;
    return true;
}

void MovingCut::step(const scree_select_drawn *wanted, uint32_t count, double most_rungs) {
    most = most_rungs;
    still = true;
    next.clear();
    wanted_whole.clear();
    for (uint32_t i = 0; i < count; i++) {
        const scree_select_drawn &one = wanted[i];
        uint32_t ancestor = NOWHERE;
        if (is_shown(one.tile)) {
            put(one.tile, moved(shown[place[one.tile]].level, one.level), one.level);
        } else if ((ancestor = shown_ancestor(one.tile)) != NOWHERE) {
            uint32_t end = i;
            while (end < count && shown_ancestor(wanted[end].tile) == ancestor) end++;
            refine(ancestor, wanted + i, end - i);
            i = end - 1;
        } else if (shows_below(one.tile) && (!all_at_base(one.tile) || !is_whole(one.tile))) {
            size_t before = next.size();
            still = false;
            uint32_t first = all[one.tile].first_child;
            bool is_covered = true;
            for (uint32_t child = first; child < first + all[one.tile].child_count && is_covered; child++)
                is_covered = coarsen(child);
            if (!is_covered) {
                next.resize(before);
                put(one.tile, one.level, one.level);
            }
        } else if (shows_below(one.tile)) {
            put(one.tile, moved(finest(one.tile), one.level), one.level);
        } else {
            put(one.tile, one.level, one.level);
        }
    }
    for (const CutTile &old : shown) place[old.tile] = NOWHERE;
    shown.swap(next);
    for (uint32_t i = 0; i < shown.size(); i++) place[shown[i].tile] = i;
}

void MovingCut::hold(uint32_t at, double level) {
    shown[at].level = level;
    still = false;
}

void MovingCut::jump(const scree_select_drawn *wanted, uint32_t count) {
    for (const CutTile &old : shown) place[old.tile] = NOWHERE;
    shown.clear();
    wanted_whole.clear();
    still = true;
    for (uint32_t i = 0; i < count; i++) {
        shown.push_back({wanted[i].tile, std::min(wanted[i].level, finest(wanted[i].tile))});
        place[wanted[i].tile] = i;
    }
}
