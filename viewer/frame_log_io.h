// Files and clocks of a flight: camera paths, and figures of frames and tiles as CSV.
#ifndef SCREE_VIEWER_FRAME_LOG_IO_H
#define SCREE_VIEWER_FRAME_LOG_IO_H

#include "viewer/camera_path.h"
#include "viewer/frame_summary.h"
#include "viewer/terrain_node.h"

#include <cstdio>
#include <memory>
#include <string>

// All of these put one line into `error`, which names the file, and return false when it did not work.

bool read_camera_path(const std::string &path, CameraPath *flight, std::string *error);
bool write_camera_path(const std::string &path, const CameraPath &flight, std::string *error);

// Tables that grow by a frame at a time.
class FrameLog {
  public:
    // "": no such table.
    bool open(const std::string &frames_path, const std::string &tiles_path, std::string *error);
    bool wants_tiles() const { return tiles != nullptr; }
    void add(size_t number, const Frame &frame, const std::vector<TerrainTileFigures> &drawn);
    bool close(std::string *error); // all rows are written

  private:
    struct Closer {
        void operator()(FILE *file) const { fclose(file); }
    };
    std::unique_ptr<FILE, Closer> frames, tiles;
    std::string frames_name, tiles_name;
};

double now_s();               // a clock that never goes back
uint64_t peak_memory_bytes(); // of this process

#endif
