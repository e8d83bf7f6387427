#include "viewer/frame_log_io.h"

#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sys/resource.h>

namespace {

std::string because(const std::string &path) {
    return path + ": " + strerror(errno);
}

} // namespace

bool read_camera_path(const std::string &path, CameraPath *flight, std::string *error) {
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!file.is_open() || file.bad()) {
        *error = because(path);
        return false;
    }
    if (flight->parse(text, error)) return true;
    *error = path + ": " + *error;
    return false;
}

bool write_camera_path(const std::string &path, const CameraPath &flight, std::string *error) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file << flight.text();
    file.close();
    if (file.good()) return true;
    *error = because(path);
    return false;
}

bool FrameLog::open(const std::string &frames_path, const std::string &tiles_path, std::string *error) {
    frames_name = frames_path;
    tiles_name = tiles_path;
    if (!frames_path.empty()) {
        frames.reset(fopen(frames_path.c_str(), "w"));
        if (frames == nullptr) {
            *error = because(frames_path);
            return false;
        }
        fputs("frame,time_s,frame_ms,outside_ms,select_ms,seek_ms,stitch_ms,send_ms,tiles_drawn,tiles_held,"
              "tiles_loading,triangles,splits,bytes_loaded,bytes_held,bytes_sent,coarsest_rung,finest_rung,"
              "coarsest_svo_m,finest_svo_m,tolerance_px,manual_svo_m,lon_deg,lat_deg,height_m,heading_deg,pitch_deg\n",
              frames.get());
    }
    if (!tiles_path.empty()) {
        tiles.reset(fopen(tiles_path.c_str(), "w"));
        if (tiles == nullptr) {
            *error = because(tiles_path);
            return false;
        }
        fputs("frame,time_s,z,x,y,rung,level,svo_m,max_error_m,distance_m,triangles,vertices,simplifications\n",
              tiles.get());
    }
    return true;
}

void FrameLog::add(size_t number, const Frame &frame, const std::vector<TerrainTileFigures> &drawn) {
    const TerrainFigures &told = frame.figures;
    if (frames != nullptr) {
        fprintf(frames.get(), "%zu,%.4f,%.3f,%.4f,%.4f,%.4f,%.4f,%.4f,%" PRIu32 ",%" PRIu32 ",%" PRIu32 ",", number,
                frame.time_s, frame.frame_ms, outside_ms(told), told.select_ms, told.seek_ms, told.stitch_ms,
                told.send_ms, told.tiles_drawn, told.tiles_held, told.tiles_loading);
        fprintf(frames.get(), "%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRId32 ",%" PRId32 ",",
                told.triangles, told.splits, told.bytes_loaded, told.bytes_held, told.bytes_sent, told.coarsest_rung,
                told.finest_rung);
        fprintf(frames.get(), "%.6g,%.6g,%.6g,%.6g,%.9f,%.9f,%.3f,%.4f,%.4f\n", told.coarsest_svo_m, told.finest_svo_m,
                told.tolerance_px, frame.manual_svo_m, frame.camera.lon_deg, frame.camera.lat_deg,
                frame.camera.height_m, frame.camera.heading_deg, frame.camera.pitch_deg);
    }
    if (tiles == nullptr) return;
    for (const TerrainTileFigures &tile : drawn)
        fprintf(tiles.get(),
                "%zu,%.4f,%" PRId32 ",%" PRIu32 ",%" PRIu32 ",%" PRId32 ",%.4f,%.6g,%.6g,%.2f,%" PRIu32 ",%" PRIu32
                ",%" PRIu32 "\n",
                number, frame.time_s, tile.id.zoom, tile.id.x, tile.id.y, tile.rung, tile.level, tile.svo_m,
                tile.max_error_m, tile.distance_m, tile.triangles, tile.vertices, tile.finest_vertices - tile.vertices);
}

bool FrameLog::close(std::string *error) {
    errno = 0;
    for (auto table : {&frames, &tiles}) {
        FILE *file = table->release();
        if (file == nullptr) continue;
        const bool failed = ferror(file) != 0;
        if (fclose(file) == 0 && !failed) continue;
        *error = because(table == &frames ? frames_name : tiles_name);
        return false;
    }
    return true;
}

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

uint64_t peak_memory_bytes() {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}
