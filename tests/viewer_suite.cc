// The viewer without graphics: what it draws over a flight has no crack, moves without jumps, keeps to its memory, and
// goes on when files are damaged. Plays the streams of the folder that SCREE_STREAMS names (tests/viewer.sh makes it).
#include "viewer/terrain_set.h"
#include "viewer/terrain_words.h"
#include "viewer/terrain_world.h"

#include <CUnit/Basic.h>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace {

constexpr double FRAME_S = 1 / 60.0;

std::string streams_folder() {
    const char *folder = std::getenv("SCREE_STREAMS");
    return folder == nullptr ? "" : folder;
}

// A terrain opened, and the lines that it has logged.
struct Opened {
    explicit Opened(const std::string &folder, unsigned loaders) {
        TerrainOptions options;
        std::string error;
        options.loaders = loaders;
        is_open = manifest_read(folder, &manifest, &error);
        if (is_open)
            set.reset(new TerrainSet(manifest, options, [this](const std::string &line) { log.push_back(line); }));
        is_open = is_open && set->open(&error);
        if (!is_open) std::printf("%s\n", error.c_str());
    }
    osg::Vec3d middle() const {
        const scree_terrain &terrain = manifest.terrain;
        return osg::Vec3d(terrain.west + 0.5 * (double)terrain.columns * terrain.spacing_x,
                          terrain.south + 0.5 * (double)terrain.rows * terrain.spacing_y, 0);
    }
    double width_m() const { return (double)manifest.terrain.columns * manifest.terrain.metres_x; }

    Manifest manifest;
    std::unique_ptr<TerrainSet> set;
    std::vector<std::string> log;
    bool is_open;
};

// All around an eye, so that nothing is culled.
scree_view eye_at(const osg::Vec3d &place) {
    scree_view view;
    const double eye[3] = {place.x(), place.y(), place.z()};
    CU_ASSERT_EQUAL_FATAL(scree_view_of_eye(eye, 0.8, 800, &view, nullptr), SCREE_OK);
    return view;
}

// The eye of a flight across the terrain and down to the ground; `part` 0 .. 1.
scree_view flight_at(const Opened &opened, double part) {
    double width_m = opened.width_m();
    osg::Vec3d offset((part - 0.5) * width_m, 0.3 * width_m * std::sin(6 * part),
                      1500 + width_m * std::pow(1 - part, 3));
    return eye_at(opened.middle() + offset);
}

// ---- cracks ----

using Place = std::array<float, 6>;
using Edges = std::map<std::pair<Place, Place>, int>;

Place place_of(const TileVertex &vertex) {
    return {vertex.high[0], vertex.high[1], vertex.high[2], vertex.low[0], vertex.low[1], vertex.low[2]};
}

// Counts every edge up in one direction and down in the other.
void count_edges(const std::vector<TileVertex> &vertices, const uint32_t *indices, size_t count, Edges *edges) {
    for (size_t i = 0; i + 2 < count; i += 3) {
        if (indices[i] == indices[i + 1]) continue; // replaced by the seam
        for (size_t k = 0; k < 3; k++) {
            Place from = place_of(vertices[indices[i + k]]), to = place_of(vertices[indices[i + (k + 1) % 3]]);
            if (from < to)
                (*edges)[{from, to}]++;
            else
                (*edges)[{to, from}]--;
        }
    }
}

// Edges with a triangle on one side only, but for those around the whole terrain.
size_t open_edges(const Opened &opened) {
    const scree_terrain &terrain = opened.manifest.terrain;
    double west = terrain.west, east = west + (double)terrain.columns * terrain.spacing_x;
    double south = terrain.south, north = south + (double)terrain.rows * terrain.spacing_y;
    Edges edges;
    for (const TerrainSet::Shown &one : opened.set->shown()) {
        const TileMesh &mesh = *one.mesh;
        count_edges(mesh.vertices, mesh.indices.data(), 3 * (size_t)mesh.triangle_count(), &edges);
        count_edges(mesh.seam_vertices, mesh.seam_indices.data(), mesh.seam_indices.size(), &edges);
    }
    size_t open = 0;
    for (const auto &[edge, count] : edges) {
        auto lies = [&edge = edge](int axis, double at) {
            return std::fabs(edge.first[axis] + (double)edge.first[axis + 3] - at) < 1e-3 &&
                   std::fabs(edge.second[axis] + (double)edge.second[axis + 3] - at) < 1e-3;
        };
        if (count != 0 && !lies(0, west) && !lies(0, east) && !lies(1, south) && !lies(1, north)) open++;
    }
    return open;
}

void test_no_crack(void) {
    Opened opened(streams_folder(), 0);
    CU_ASSERT_FATAL(opened.is_open);
    TerrainSettings settings;
    settings.tolerance_px = 4;
    std::set<std::pair<int32_t, int32_t>> spans;
    size_t cracks_unstitched = 0;
    for (int frame = 0; frame < 40; frame++) {
        settings.rungs_per_second = frame % 3 == 0 ? 0 : 24; // jumps as well
        settings.stitch = true;
        opened.set->frame(flight_at(opened, frame / 39.0), settings, FRAME_S * 8);
        CU_ASSERT_EQUAL(open_edges(opened), 0);
        spans.insert({opened.set->figures().coarsest_rung, opened.set->figures().finest_rung});
        if (frame % 10 != 9) continue;
        settings.stitch = false;
        opened.set->frame(flight_at(opened, frame / 39.0), settings, 0);
        cracks_unstitched += open_edges(opened);
    }
    CU_ASSERT(spans.size() > 5);        // rungs have changed
    CU_ASSERT(cracks_unstitched > 100); // and without stitching there are cracks to be found
    CU_ASSERT_EQUAL(opened.log.size(), 0);
}

// Where a vertex is drawn, on its way from its origin.
std::array<float, 3> drawn_at(const TileMesh &mesh, const TileVertex &vertex) {
    float weight = std::clamp(mesh.levels[vertex.slot] + 1 - (float)vertex.increment, 0.f, 1.f);
    return {(1 - weight) * vertex.delta[0], (1 - weight) * vertex.delta[1], (1 - weight) * vertex.delta[2]};
}

// A vertex that several tiles draw is at the same place on its way in all of them.
void test_borders_move_together(void) {
    Opened opened(streams_folder(), 0);
    CU_ASSERT_FATAL(opened.is_open);
    TerrainSettings settings;
    size_t shared = 0, on_their_way = 0, apart = 0;
    for (int frame = 0; frame < 60; frame++) {
        opened.set->frame(flight_at(opened, frame / 59.0), settings, FRAME_S);
        std::map<Place, std::pair<const TileMesh *, std::array<float, 3>>> places;
        auto see = [&](const TileMesh &mesh, const TileVertex &vertex) {
            if (vertex.slot == SLOT_OWN) return;
            std::array<float, 3> at = drawn_at(mesh, vertex);
            auto [known, is_new] = places.emplace(place_of(vertex), std::make_pair(&mesh, at));
            if (is_new || known->second.first == &mesh) return;
            shared++;
            on_their_way += at[0] != 0 || at[1] != 0 || at[2] != 0;
            apart += at != known->second.second;
        };
        for (const TerrainSet::Shown &one : opened.set->shown()) {
            for (uint32_t i = 0; i < one.mesh->vertex_count(); i++) see(*one.mesh, one.mesh->vertices[i]);
            for (const TileVertex &vertex : one.mesh->seam_vertices) see(*one.mesh, vertex);
        }
    }
    CU_ASSERT(shared > 1000);
    CU_ASSERT(on_their_way > 100);
    CU_ASSERT_EQUAL(apart, 0);
}

// Vertices that two tiles share have the same normal in both.
void test_light_has_no_seam(void) {
    Opened opened(streams_folder(), 0);
    CU_ASSERT_FATAL(opened.is_open);
    TerrainSettings settings;
    settings.rungs_per_second = 0;
    settings.manual_svo_m = 0.7 * opened.set->svo_range_m().first + 0.3 * opened.set->svo_range_m().second;
    std::map<Place, std::array<int, 3>> normals;
    size_t shared = 0, different = 0;
    for (int frame = 0; frame < 8; frame++) opened.set->frame(flight_at(opened, 0), settings, FRAME_S);
    for (const TerrainSet::Shown &one : opened.set->shown())
        for (uint32_t i = 0; i < one.mesh->vertex_count(); i++) {
            const TileVertex &vertex = one.mesh->vertices[i];
            std::array<int, 3> normal = {vertex.normal[0], vertex.normal[1], vertex.normal[2]};
            auto [known, is_new] = normals.emplace(place_of(vertex), normal);
            if (is_new) continue;
            shared++;
            for (int axis = 0; axis < 3; axis++) // rounding of sums in another order
                if (std::abs(known->second[(size_t)axis] - normal[(size_t)axis]) > 1) {
                    different++;
                    break;
                }
        }
    CU_ASSERT(opened.set->shown().size() >= 4);
    CU_ASSERT(shared > 50);
    CU_ASSERT(different <= 4 * opened.set->shown().size()); // corners know three of their four tiles
}

// ---- no jumps ----

// Levels never move faster than they may, and a tile changes places with its children only where both show the same.
void test_moves_smoothly(void) {
    Opened opened(streams_folder(), 0);
    CU_ASSERT_FATAL(opened.is_open);
    TerrainSettings settings;
    settings.tolerance_px = 1.5;
    std::map<uint32_t, std::pair<double, double>> before; // level and finest, by tile
    size_t changes = 0, jumps = 0;
    for (int frame = 0; frame < 240; frame++) {
        double part = frame < 120 ? frame / 119.0 : (239 - frame) / 119.0; // there and back
        opened.set->frame(flight_at(opened, part), settings, FRAME_S);
        std::map<uint32_t, std::pair<double, double>> now;
        for (const TerrainSet::Shown &one : opened.set->shown())
            now[one.tile] = {one.mesh->level(), one.mesh->header().rung_count - 1.0};
        for (const auto &[tile, level] : now) {
            auto was = before.find(tile);
            if (was != before.end() && std::fabs(was->second.first - level.first) > 24 * FRAME_S + 1e-9) jumps++;
            if (was != before.end() || frame == 0) continue;
            changes++; // a child begins at its base, a parent at its finest, but for this frame's step
            if (level.first > 24 * FRAME_S + 1e-9 && level.first < level.second - 24 * FRAME_S - 1e-9) jumps++;
            for (const auto &[other, its] : before) { // and what it takes the place of had come there
                const scree_tile_id &id = opened.set->id(tile), &old = opened.set->id(other);
                int up = id.zoom - old.zoom, down = old.zoom - id.zoom;
                bool was_above = up > 0 && id.x >> up == old.x && id.y >> up == old.y;
                bool was_below = down > 0 && old.x >> down == id.x && old.y >> down == id.y;
                if (was_above && its.first < its.second - 1e-9) jumps++;
                if (was_below && its.first > 1e-9) jumps++;
            }
        }
        before = now;
    }
    CU_ASSERT(changes > 8);
    CU_ASSERT_EQUAL(jumps, 0);
}

// ---- limits ----

void test_keeps_to_its_memory(void) {
    Opened opened(streams_folder(), 0);
    CU_ASSERT_FATAL(opened.is_open);
    TerrainSettings settings;
    settings.tolerance_px = 0.05; // far more than there is room for
    settings.rungs_per_second = 0;
    settings.memory_bytes = 12u << 20;
    uint64_t most = 0;
    for (int frame = 0; frame < 60; frame++) {
        opened.set->frame(flight_at(opened, frame / 59.0), settings, FRAME_S);
        most = std::max(most, opened.set->figures().bytes_held);
    }
    CU_ASSERT(most <= settings.memory_bytes);
    CU_ASSERT(most > settings.memory_bytes / 4);
    CU_ASSERT(opened.set->figures().tolerance_px > settings.tolerance_px);
}

// Loading in the background ends with the same tiles at the same levels as loading at once.
void test_threads_do_not_show(void) {
    Opened alone(streams_folder(), 0), helped(streams_folder(), 3);
    CU_ASSERT_FATAL(alone.is_open && helped.is_open);
    TerrainSettings settings;
    settings.rungs_per_second = 0;
    for (Opened *one : {&alone, &helped})
        for (int frame = 0; frame < 100000 && (frame < 20 || !one->set->is_settled()); frame++)
            one->set->frame(flight_at(*one, 0.8), settings, FRAME_S);
    CU_ASSERT(helped.set->is_settled());
    CU_ASSERT_EQUAL_FATAL(alone.set->shown().size(), helped.set->shown().size());
    for (size_t i = 0; i < alone.set->shown().size(); i++) {
        CU_ASSERT_EQUAL(alone.set->shown()[i].tile, helped.set->shown()[i].tile);
        CU_ASSERT_EQUAL(alone.set->shown()[i].mesh->level(), helped.set->shown()[i].mesh->level());
    }
}

// ---- damage ----

void test_damaged_in_flight(void) {
    namespace files = std::filesystem;
    files::path copy = files::path(streams_folder() + "_damaged");
    files::remove_all(copy);
    files::copy(streams_folder(), copy, files::copy_options::recursive);
    Opened opened(copy.string(), 0);
    CU_ASSERT_FATAL(opened.is_open);
    TerrainSettings settings;
    settings.tolerance_px = 1;
    size_t number = 0;
    std::vector<files::path> tiles;
    for (const auto &entry : files::recursive_directory_iterator(copy))
        if (entry.path().extension() == ".scree") tiles.push_back(entry.path());
    std::sort(tiles.begin(), tiles.end());
    for (const files::path &tile : tiles) { // after the roots have been read
        uintmax_t size = files::file_size(tile);
        number++;
        if (number % 4 == 0) files::remove(tile);
        if (number % 4 == 1) files::resize_file(tile, size / 2);
        if (number % 4 == 2) {
            std::fstream file(tile, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp((std::streamoff)(size / 3));
            file.write("\xff\xfe\xfd", 3);
        }
    }
    for (int frame = 0; frame < 200; frame++) {
        opened.set->frame(flight_at(opened, frame / 199.0), settings, FRAME_S);
        CU_ASSERT(opened.set->shown().size() > 0);
        if (frame % 40 == 39) CU_ASSERT_EQUAL(open_edges(opened), 0);
    }
    std::set<std::string> lines(opened.log.begin(), opened.log.end());
    CU_ASSERT(lines.size() > 0);
    CU_ASSERT_EQUAL(lines.size(), opened.log.size()); // each is said once
    for (const std::string &line : lines)
        CU_ASSERT(line.find(".scree") != std::string::npos && line.find('\n') == std::string::npos);
    files::remove_all(copy);
}

void test_manifest_is_refused(void) {
    namespace files = std::filesystem;
    files::path folder = files::path(streams_folder() + "_refused");
    files::create_directories(folder);
    const char *const texts[] = {"",
                                 "{",
                                 "[]",
                                 "{\"format\": \"quantized-mesh-1.0\"}",
                                 "{\"format\": \"scree-stream\", \"format_version\": 2}",
                                 "{\"format\": \"scree-stream\", \"format_version\": 1, \"profile\": \"local\"}"};
    for (const char *text : texts) {
        std::ofstream(folder / "scree.json") << text;
        Manifest manifest;
        std::string error;
        CU_ASSERT_FALSE(manifest_read(folder.string(), &manifest, &error));
        CU_ASSERT(error.find("scree.json: ") != std::string::npos);
    }
    Manifest manifest;
    std::string error;
    files::remove_all(folder);
    CU_ASSERT_FALSE(manifest_read(folder.string(), &manifest, &error));
    CU_ASSERT(error.find("there are no streams") != std::string::npos);
}

// A manifest whose members are spoilt one by one is refused or read, and never more than that.
void test_manifest_is_not_believed(void) {
    namespace files = std::filesystem;
    std::ifstream file(streams_folder() + "/stream/scree.json");
    std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    files::path folder = files::path(streams_folder() + "_spoilt");
    files::create_directories(folder);
    CU_ASSERT_FATAL(text.size() > 1000);
    for (const char *list : {"\"svo_m\": [", "\"max_error_m\": [", "\"data_bounds\": ["})
        for (const char *number : {"\"5\", ", "NaN, ", "[], ", "7, 8, "}) { // in its first place
            std::string spoilt = text;
            size_t at = text.rfind(list);
            CU_ASSERT_FATAL(at != std::string::npos);
            spoilt.replace(at + std::strlen(list), text.find(',', at) + 1 - at - std::strlen(list), number);
            std::ofstream(folder / "scree.json") << spoilt;
            Manifest manifest;
            std::string error;
            CU_ASSERT_FALSE(manifest_read(folder.string(), &manifest, &error));
        }
    for (size_t at = 7; at < text.size(); at += 23) {
        std::string spoilt = text;
        spoilt[at] = spoilt[at] == '9' ? '-' : '9';
        std::ofstream(folder / "scree.json") << spoilt;
        Manifest manifest;
        std::string error;
        if (!manifest_read(folder.string(), &manifest, &error)) CU_ASSERT(!error.empty());
    }
    files::remove_all(folder);
}

// ---- small things ----

void test_words(void) {
    TerrainOptions options;
    std::string error;
    CU_ASSERT(terrain_words_read("tolerance=2.5 other mode=error colour=rung x=1 memory=64", &options, &error));
    CU_ASSERT_EQUAL(options.settings.tolerance_px, 2.5);
    CU_ASSERT_EQUAL(options.settings.measure, SCREE_BY_MAX_ERROR);
    CU_ASSERT(options.settings.colour == TerrainColour::RUNG);
    CU_ASSERT_EQUAL(options.settings.memory_bytes, 64u << 20);
    for (const char *wrong : {"tolerance=0", "tolerance=much", "tolerance=", "mode=both", "colour=blue", "memory=1",
                              "morph=perhaps", "glsl=100", "contours=-5", "triangles=nan", "texture="}) {
        error.clear();
        CU_ASSERT_FALSE(terrain_words_read(wrong, &options, &error));
        CU_ASSERT(error.find(wrong) == 0);
    }
}

void test_world(void) {
    scree_terrain terrain = {};
    const double bounds[4] = {-84.4, 36.4, -84.0, 36.8};
    terrain.profile = SCREE_GEODETIC;
    TerrainWorld globe(terrain, "", bounds);
    globe.set_heights(100, 900);
    osg::Vec3d place = globe.place(-84.2, 36.6, 500);
    osg::Vec3d back = globe.lon_lat_height(place);
    CU_ASSERT_DOUBLE_EQUAL(back.x(), -84.2, 1e-9);
    CU_ASSERT_DOUBLE_EQUAL(back.y(), 36.6, 1e-9);
    CU_ASSERT_DOUBLE_EQUAL(back.z(), 500, 1e-3);
    CU_ASSERT((globe.middle() - place).length() < 1);
    CU_ASSERT(globe.radius_m() > 25000 && globe.radius_m() < 35000);
    osg::Matrixd frame = globe.local_frame(place);
    osg::Vec3d above = osg::Vec3d(0, 0, 1000) * frame;
    CU_ASSERT_DOUBLE_EQUAL(globe.lon_lat_height(above).z(), 1500, 1e-3);
    CU_ASSERT(globe.lon_lat_height(osg::Vec3d(1000, 0, 0) * frame).x() > -84.2);
    CU_ASSERT(globe.lon_lat_height(osg::Vec3d(0, 1000, 0) * frame).y() > 36.6);
    terrain.profile = SCREE_LOCAL;
    terrain.spacing_x = terrain.spacing_y = terrain.metres_x = terrain.metres_y = 30;
    const double metres[4] = {400000, 3800000, 410000, 3810000};
    TerrainWorld utm(terrain, "EPSG:32611", metres), unknown(terrain, "", metres);
    CU_ASSERT(utm.knows_longitudes() && !unknown.knows_longitudes());
    CU_ASSERT_DOUBLE_EQUAL(utm.place(-117, 34.5, 0).x(), 500000, 0.01);
    CU_ASSERT_DOUBLE_EQUAL(utm.lon_lat_height(osg::Vec3d(500000, 3817393, 7)).x(), -117, 1e-6);
    CU_ASSERT_EQUAL(unknown.place(400000, 3800000, 5).x(), 400000);
}

} // namespace

int main(int argc, char **argv) {
    const struct {
        const char *name;
        void (*run)(void);
    } tests[] = {{"no crack over a flight", test_no_crack},
                 {"borders move together", test_borders_move_together},
                 {"light has no seam", test_light_has_no_seam},
                 {"moves smoothly", test_moves_smoothly},
                 {"keeps to its memory", test_keeps_to_its_memory},
                 {"threads do not show", test_threads_do_not_show},
                 {"damaged in flight", test_damaged_in_flight},
                 {"a manifest is refused", test_manifest_is_refused},
                 {"a manifest is not believed", test_manifest_is_not_believed},
                 {"words", test_words},
                 {"the world", test_world}};
    if (streams_folder().empty()) {
        std::fprintf(stderr, "tests/viewer_suite: SCREE_STREAMS names no folder; tests/viewer.sh makes one\n");
        return 99;
    }
    if (CU_initialize_registry() != CUE_SUCCESS) return 99;
    CU_pSuite suite = CU_add_suite("viewer", nullptr, nullptr);
    for (const auto &test : tests)
        if (argc < 2 || std::strstr(test.name, argv[1]) != nullptr) CU_add_test(suite, test.name, test.run);
    CU_basic_set_mode(CU_BRM_VERBOSE);
    CU_basic_run_tests();
    unsigned failures = CU_get_number_of_failures();
    CU_cleanup_registry();
    return failures == 0 ? 0 : 1;
}
