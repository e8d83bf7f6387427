// A flight: where a camera is at which second. As text, one line a place, in the order of time:
//
//     # seconds  longitude  latitude  height_m  heading_deg  pitch_deg
//     0          -84.15     36.42     3000      0            -20
//     12.5       -84.10     36.47     1200      45           -8
//
// Between them the camera moves smoothly: cubic curves through all places, whose speed at a place is that between its
// neighbours (Catmull and Rom 1974, for uneven times). Heights are never below or above those of the two places around
// (Fritsch and Carlson 1980), so that a flight does not dive into the ground. Heading and pitch are curves of their
// own, headings and longitudes the shorter way round: the horizon stays level.
#ifndef SCREE_VIEWER_CAMERA_PATH_H
#define SCREE_VIEWER_CAMERA_PATH_H

#include "viewer/camera_place.h"

#include <string>
#include <vector>

class CameraPath {
  public:
    // has_longitudes: 360 degrees are a turn; else they are coordinates of a CRS.
    explicit CameraPath(bool has_longitudes = true) : has_longitudes(has_longitudes) {}

    // Appends what the text says; one line in `error`, and false, when it is no flight.
    bool parse(const std::string &text, std::string *error);
    std::string text() const;

    // A place after the last one; times that do not grow are left out.
    void add(double time_s, const CameraPlace &place);

    bool is_empty() const { return keys.empty(); }
    double begin_s() const { return keys.front().time_s; }
    double end_s() const { return keys.back().time_s; }
    CameraPlace at(double time_s) const; // before the beginning and after the end: as there. Not of an empty path.

  private:
    struct Key {
        double time_s;
        double values[5]; // longitude and heading without a jump from one key to the next
    };
    double slope(size_t key, int value) const;
    bool has_longitudes;
    std::vector<Key> keys;
};

#endif
