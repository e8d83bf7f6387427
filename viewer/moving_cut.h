// From what was drawn in the last frame to what the selection asks for, without a jump: levels move no faster than the
// eye bears, and a tile changes places with its children only where both show the same surface. Pure.
#ifndef SCREE_VIEWER_MOVING_CUT_H
#define SCREE_VIEWER_MOVING_CUT_H

#include <scree/select.h>
#include <vector>

struct CutTile {
    uint32_t tile; // index into the tiles
    double level;
};

class MovingCut {
  public:
    // The tiles that scree_select is called with, linked; and for each whether nothing more of it will ever come. Both
    // stay the caller's.
    MovingCut(const std::vector<scree_select_tile> &tiles, const std::vector<char> &is_final);

    // What is drawn now, in the order of scree/cut.h.
    const std::vector<CutTile> &tiles() const { return shown; }

    // One frame on: every level moves by at most so many rungs. Tiles that come into sight begin where they are wanted.
    void step(const scree_select_drawn *wanted, uint32_t count, double most_rungs);

    // At once.
    void jump(const scree_select_drawn *wanted, uint32_t count);

    // The tile at that place among them stays at another level for now.
    void hold(uint32_t at, double level);

    // Tiles that have to be loaded to their finest rung before they can change places with others.
    const std::vector<uint32_t> &awaited() const { return wanted_whole; }

    // It has arrived at what was wanted last.
    bool is_still() const { return still; }

  private:
    double finest(uint32_t tile) const;
    bool is_whole(uint32_t tile);
    double moved(double level, double target) const;
    bool is_shown(uint32_t tile) const { return place[tile] != NOWHERE; }
    uint32_t shown_ancestor(uint32_t tile) const;
    bool shows_below(uint32_t tile) const;
    bool all_at_base(uint32_t tile) const;
    void refine(uint32_t ancestor, const scree_select_drawn *wanted, uint32_t count);
    bool coarsen(uint32_t tile);
    void put(uint32_t tile, double level, double target);

    static constexpr uint32_t NOWHERE = UINT32_MAX;
    const std::vector<scree_select_tile> &all;
    const std::vector<char> &is_final;
    std::vector<uint32_t> parents; // NOWHERE: a root
    std::vector<CutTile> shown, next;
    std::vector<uint32_t> wanted_whole;
    std::vector<uint32_t> place; // of a tile in `shown`, or NOWHERE
    double most = 0;
    bool still = true;
};

#endif
