#include "viewer/manifest_io.h"

#include "viewer/tile_file_io.h"

#include <algorithm>
#include <cmath>
#include <cpl_error.h>
#include <cpl_json.h>
#include <cpl_vsi.h>
#include <memory>

namespace {

constexpr int CELLS = 256;              // of a tile, along a side
constexpr size_t MOST_TILES = 1u << 26; // of a set
constexpr GInt64 MOST_STEPS = (GInt64)1 << 40;

// GDAL's own lines are of no use to those who run a viewer: ours say what is wrong.
struct Quiet {
    Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
    ~Quiet() { CPLPopErrorHandler(); }
};

bool refuse(std::string *error, const std::string &path, const std::string &what) {
    *error = path + ": " + what;
    return false;
}

bool is_there(const std::string &path) {
    VSIStatBufL status;
    return VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) == 0 &&
           !VSI_ISDIR(status.st_mode);
}

bool ends_in(const std::string &text, const char *end) {
    std::string tail = end;
    return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

bool number_of(const CPLJSONObject &object, double *value) {
    auto type = object.IsValid() ? object.GetType() : CPLJSONObject::Type::Unknown;
    bool is = type == CPLJSONObject::Type::Double || type == CPLJSONObject::Type::Integer ||
              type == CPLJSONObject::Type::Long;
    if (is) *value = object.ToDouble();
    return is && std::isfinite(*value);
}

bool is_number(const CPLJSONObject &object, const char *name, double *value) {
    return number_of(object.GetObj(name), value);
}

// A list of just so many.
bool are_numbers(const CPLJSONObject &object, const char *name, int count, double *values) {
    CPLJSONArray list = object.GetArray(name);
    bool are = list.IsValid() && list.Size() == count;
    for (int i = 0; i < count && are; i++) are = number_of(list[i], &values[i]);
    return are;
}

bool is_count(const CPLJSONObject &object, const char *name, GInt64 highest, GInt64 *value) {
    double number;
    if (!is_number(object, name, &number) || number < 0 || number > (double)highest || number != std::floor(number))
        return false;
    *value = (GInt64)number;
    return true;
}

bool read_lattice(const CPLJSONObject &root, Manifest *manifest) {
    CPLJSONObject lattice = root.GetObj("lattice");
    scree_terrain &terrain = manifest->terrain;
    GInt64 finest, columns, rows;
    bool is_whole =
        lattice.IsValid() && is_count(lattice, "finest_zoom", SCREE_MAX_ZOOM - 8, &finest) &&
        is_count(lattice, "columns", MOST_STEPS, &columns) && is_count(lattice, "rows", MOST_STEPS, &rows) &&
        is_number(lattice, "west", &terrain.west) && is_number(lattice, "south", &terrain.south) &&
        is_number(lattice, "spacing_x", &terrain.spacing_x) && is_number(lattice, "spacing_y", &terrain.spacing_y) &&
        is_number(lattice, "metres_x", &terrain.metres_x) && is_number(lattice, "metres_y", &terrain.metres_y);
    bool is_local = is_whole && terrain.profile == SCREE_LOCAL;
    if (!is_whole || columns < 2 || rows < 2 || !(terrain.spacing_x > 0) || !(terrain.spacing_y > 0)) return false;
    if (is_local && (!(terrain.metres_x > 0) || !(terrain.metres_y > 0))) return false;
    terrain.finest_zoom = (int32_t)finest;
    terrain.columns = columns - 1;
    terrain.rows = rows - 1;
    return true;
}

bool read_zooms(const CPLJSONObject &root, Manifest *manifest) {
    CPLJSONArray list = root.GetArray("zooms");
    if (!list.IsValid()) return false;
    manifest->zooms.assign(SCREE_MAX_ZOOM + 1, scree_zoom_scale{0, 0});
    for (int i = 0; i < list.Size(); i++) {
        GInt64 zoom;
        if (!is_count(list[i], "zoom", SCREE_MAX_ZOOM, &zoom)) return false;
        CPLJSONObject finest = list[i].GetObj("finest");
        if (!finest.IsValid()) continue;
        double svo_m[2], max_error_m[2];
        if (!are_numbers(finest, "svo_m", 2, svo_m) || !are_numbers(finest, "max_error_m", 2, max_error_m))
            return false;
        manifest->zooms[(size_t)zoom] = {svo_m[1], max_error_m[1]};
    }
    return true;
}

// Every tile that the lists of rectangles name.
bool read_tiles(const CPLJSONObject &root, Manifest *manifest) {
    CPLJSONArray zooms = root.GetArray("available");
    if (!zooms.IsValid()) return false;
    for (int zoom = 0; zoom < zooms.Size() && zoom <= manifest->terrain.finest_zoom; zoom++) {
        CPLJSONArray list = zooms[zoom].ToArray();
        GInt64 most = ((GInt64)2 << zoom) - 1;
        for (int i = 0; i < list.Size(); i++) {
            GInt64 x, y, end_x, end_y;
            if (!is_count(list[i], "startX", most, &x) || !is_count(list[i], "startY", most, &y) ||
                !is_count(list[i], "endX", most, &end_x) || !is_count(list[i], "endY", most, &end_y) || end_x < x ||
                end_y < y ||
                (uint64_t)(end_x - x + 1) * (uint64_t)(end_y - y + 1) > MOST_TILES - manifest->tiles.size())
                return false;
            for (GInt64 row = y; row <= end_y; row++)
                for (GInt64 column = x; column <= end_x; column++)
                    manifest->tiles.push_back({zoom, (uint32_t)column, (uint32_t)row});
        }
    }
    return !manifest->tiles.empty();
}

bool read_json(const std::string &path, Manifest *manifest, std::string *error) {
    CPLJSONDocument document;
    if (!document.Load(path)) return refuse(error, path, "is no JSON; make it with scree build");
    CPLJSONObject root = document.GetRoot();
    if (root.GetString("format") != "scree-stream")
        return refuse(error, path, "is no manifest of streams; make it with scree build");
    if (root.GetInteger("format_version") != SCREE_STREAM_VERSION)
        return refuse(error, path, "is of another version of the format; this viewer reads version 1");
    std::string profile = root.GetString("profile");
    if (profile != "geodetic" && profile != "local") return refuse(error, path, "names no profile that is known");
    manifest->terrain.profile = profile == "local" ? SCREE_LOCAL : SCREE_GEODETIC;
    manifest->crs_wkt = root.GetString("crs_wkt");
    if (!read_lattice(root, manifest)) return refuse(error, path, "its lattice is missing or makes no sense");
    if (!read_zooms(root, manifest)) return refuse(error, path, "its zooms are missing or incomplete");
    if (!are_numbers(root, "data_bounds", 4, manifest->bounds))
        return refuse(error, path, "its data_bounds are not four numbers");
    if (!read_tiles(root, manifest)) return refuse(error, path, "its list of available tiles is missing or wrong");
    manifest->folder = path.substr(0, path.find_last_of('/') + 1);
    return true;
}

// A tile by itself, as if it were all that there is.
bool read_single(const std::string &path, Manifest *manifest, std::string *error) {
    auto header = std::make_unique<scree_stream_header>();
    if (!tile_file_header(path, header.get(), error)) return false;
    scree_terrain &terrain = manifest->terrain;
    int64_t span = CELLS;
    int levels = 0;
    while (span < std::max(header->columns, header->rows)) span *= 2, levels++;
    terrain.profile = header->profile;
    terrain.finest_zoom = header->zoom + levels;
    terrain.spacing_x = header->spacing_x;
    terrain.spacing_y = header->spacing_y;
    terrain.metres_x = header->metres_x;
    terrain.metres_y = header->metres_y;
    terrain.west = header->west - (double)(header->tile_x * span) * header->spacing_x;
    terrain.south = header->south - (double)(header->tile_y * span) * header->spacing_y;
    terrain.columns = header->tile_x * span + header->columns;
    terrain.rows = header->tile_y * span + header->rows;
    manifest->zooms.assign(SCREE_MAX_ZOOM + 1, scree_zoom_scale{0, 0});
    manifest->tiles = {{header->zoom, header->tile_x, header->tile_y}};
    manifest->bounds[0] = header->west;
    manifest->bounds[1] = header->south;
    manifest->bounds[2] = header->west + header->columns * header->spacing_x;
    manifest->bounds[3] = header->south + header->rows * header->spacing_y;
    manifest->single_file = path;
    return true;
}

} // namespace

std::string Manifest::path_of(const scree_tile_id &id) const {
    if (!single_file.empty()) return single_file;
    return folder + std::to_string(id.zoom) + "/" + std::to_string(id.x) + "/" + std::to_string(id.y) + ".scree";
}

bool manifest_read(const std::string &path, Manifest *manifest, std::string *error) {
    Quiet quiet;
    std::string folder = path;
    while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
    if (ends_in(path, ".scree") && !ends_in(path, ".json.scree")) return read_single(path, manifest, error);
    for (const std::string &file : {path, folder + "/stream/scree.json", folder + "/scree.json"})
        if (is_there(file)) return read_json(file, manifest, error);
    return refuse(error, path, "there are no streams; scree build makes them in OUT/stream");
}
