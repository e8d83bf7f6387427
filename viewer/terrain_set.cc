#include "viewer/terrain_set.h"

#include "viewer/stopwatch_io.h"

#include <algorithm>
#include <cmath>

namespace {

constexpr uint64_t BYTES_A_TRIANGLE = 256;            // of memory: 225 to 253 were measured
constexpr uint64_t BYTES_A_BASE = 2u << 20;           // of a tile of which nothing is known yet
constexpr size_t BYTES_A_FRAME = 1u << 20;            // to the graphics card, for tiles that have come
constexpr int64_t SPLITS_A_FRAME = 12000;             // while levels move
constexpr int64_t SPLITS_A_STITCH = 1500;             // what stitching a tile and its neighbours takes, in splits
constexpr double SLIGHT = 1e-6;                       // of a rung: nobody sees it
constexpr std::ptrdiff_t DATA_TILES = 16;             // so many are read to learn the heights
constexpr double LOWEST_M = -12000, HIGHEST_M = 9000; // until the roots have told

MeshWorld world_of(const Manifest &manifest) {
    MeshWorld world;
    if (manifest.terrain.profile == SCREE_LOCAL) {
        world.metres_x = manifest.terrain.metres_x / manifest.terrain.spacing_x;
        world.metres_y = manifest.terrain.metres_y / manifest.terrain.spacing_y;
    }
    std::copy_n(manifest.bounds, 4, world.bounds);
    return world;
}

// A view that sees everything, a metre being a pixel: the tolerance is then in metres.
scree_view view_of_scale() {
    scree_view view = {};
    view.depth[3] = 1;
    view.pixels = 1;
    return view;
}

} // namespace

TerrainSet::TerrainSet(Manifest taken, const TerrainOptions &options, Log log)
    : manifest(std::move(taken)), world(world_of(manifest)), loader_count(options.loaders), log(std::move(log)) {
    manifest.terrain.zooms = manifest.single_file.empty() ? manifest.zooms.data() : nullptr;
    manifest.terrain.lowest_m = LOWEST_M;
    manifest.terrain.highest_m = HIGHEST_M;
    for (const scree_tile_id &id : manifest.tiles) {
        scree_select_tile tile = {};
        tile.id = id;
        tile.lowest_m = 1; // above the highest: not known
        tiles.push_back(tile);
    }
    held.resize(tiles.size());
    is_final.resize(tiles.size(), 0);
}

bool TerrainSet::open(std::string *error) {
    scree_error failure = {};
    uint32_t count = tile_count();
    if (scree_select_link(&manifest.terrain, tiles.data(), count, &failure) != SCREE_OK) {
        *error = "the list of available tiles: " + std::string(failure.text);
        return false;
    }
    parents.assign(count, UINT32_MAX);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t child = 0; child < tiles[i].child_count; child++) parents[tiles[i].first_child + child] = i;
    cut = std::make_unique<MovingCut>(tiles, is_final);
    selected.resize(count);
    wanted.resize(count);
    workspace.resize(scree_select_workspace(count) / sizeof(double) + 1);
    double lowest_m = HUGE_VAL, highest_m = -HUGE_VAL;
    for (uint32_t i = 0; i < count && parents[i] == UINT32_MAX; i++) {
        LoadedTile root = load_tile({i, 1, 0, manifest.path_of(tiles[i].id)}, world);
        if (root.mesh == nullptr) {
            *error = root.error;
            return false;
        }
        take(std::move(root));
        lowest_m = std::min(lowest_m, (double)tiles[i].lowest_m);
        highest_m = std::max(highest_m, (double)tiles[i].highest_m);
    }
    manifest.terrain.lowest_m = lowest_m;
    manifest.terrain.highest_m = highest_m;
    if (loader_count > 0) loaders = std::make_unique<Loaders>(loader_count, world);
    return true;
}

std::pair<double, double> TerrainSet::data_heights_m() {
    int32_t zoom = tiles.front().id.zoom;
    auto count_of = [this](int32_t at) {
        return std::count_if(tiles.begin(), tiles.end(),
                             [at](const scree_select_tile &one) { return one.id.zoom == at; });
    };
    while (zoom < tiles.back().id.zoom && count_of(zoom + 1) <= DATA_TILES) zoom++;
    double lowest_m = HUGE_VAL, highest_m = -HUGE_VAL;
    for (uint32_t i = 0; i < tile_count(); i++) {
        if (tiles[i].id.zoom != zoom) continue;
        LoadedTile tile = load_tile({i, 1, 0, manifest.path_of(tiles[i].id)}, world);
        if (tile.mesh == nullptr) continue;
        for (const TileVertex &vertex : tile.mesh->vertices) {
            if (!is_on_data(vertex)) continue;
            lowest_m = std::min(lowest_m, (double)vertex.height_m);
            highest_m = std::max(highest_m, (double)vertex.height_m);
        }
    }
    if (lowest_m > highest_m) return {manifest.terrain.lowest_m, manifest.terrain.highest_m};
    return {lowest_m, highest_m};
}

// ---- what has come ----

void TerrainSet::keep_heights(uint32_t tile, const TileMesh &mesh) {
    scree_select_tile &place = tiles[tile];
    if (place.lowest_m <= place.highest_m) return;
    // the base mesh's bounds hold for all finer ones
    mesh.base_heights(manifest.terrain, &place.lowest_m, &place.highest_m);
}

void TerrainSet::take(LoadedTile loaded) {
    uint32_t tile = loaded.tile;
    told.bytes_loaded += loaded.bytes_read;
    if (loaded.is_broken) {
        log(loaded.error);
        is_final[tile] = 1;
    }
    if (loaded.mesh == nullptr || (held[tile].mesh != nullptr && loaded.mesh->rungs_ready() <= tiles[tile].rungs_ready))
        return;
    if (held[tile].mesh == nullptr)
        holding.push_back(tile);
    else
        retired.push_back(held[tile].mesh);
    held[tile] = {std::move(loaded.mesh), frame_number, 0};
    held[tile].bytes = held[tile].mesh->bytes();
    tiles[tile].header = &held[tile].mesh->header();
    tiles[tile].rungs_ready = held[tile].mesh->rungs_ready();
    keep_heights(tile, *held[tile].mesh);
}

void TerrainSet::bury_retired() {
    auto still_used = std::partition(retired.begin(), retired.end(),
                                     [](const std::shared_ptr<TileMesh> &mesh) { return mesh.use_count() > 1; });
    std::vector<std::shared_ptr<TileMesh>> unused(std::make_move_iterator(still_used),
                                                  std::make_move_iterator(retired.end()));
    retired.erase(still_used, retired.end());
    if (loaders != nullptr && !unused.empty()) loaders->bury(std::move(unused));
}

// What the frame that takes it sends to the graphics card: as much as is drawn of the tile now.
size_t TerrainSet::bytes_to_send(const LoadedTile &loaded) const {
    const TileMesh *now = held[loaded.tile].mesh.get();
    if (now == nullptr || loaded.mesh == nullptr || held[loaded.tile].last_frame + 1 < frame_number) return 0;
    return now->vertex_count() * sizeof(TileVertex) + 3 * sizeof(uint32_t) * now->triangle_count();
}

void TerrainSet::take_arrivals() {
    if (loaders == nullptr) return;
    for (LoadedTile &loaded : loaders->take()) arrived.push_back(std::move(loaded));
    for (size_t bytes = 0; !arrived.empty() && bytes < BYTES_A_FRAME; arrived.pop_front()) {
        bytes += bytes_to_send(arrived.front());
        take(std::move(arrived.front()));
    }
}

// ---- what is drawn ----

void TerrainSet::choose(const scree_view &view, const TerrainSettings &settings) {
    bool is_manual = settings.manual_svo_m > 0;
    scree_view scale = view_of_scale();
    scree_select_options options = {};
    options.measure = is_manual ? SCREE_BY_SVO : settings.measure;
    options.tolerance_px = is_manual ? settings.manual_svo_m : settings.tolerance_px;
    uint64_t room = std::max<uint64_t>(settings.memory_bytes / (2 * BYTES_A_TRIANGLE), 1);
    options.triangle_budget = settings.triangle_budget == 0 ? room : std::min(room, settings.triangle_budget);
    selection.capacity = tile_count();
    selection.drawn = selected.data();
    selection.wanted = wanted.data();
    selection.workspace = workspace.data();
    selection.workspace_bytes = workspace.size() * sizeof(double);
    scree_error failure = {};
    if (scree_select(&manifest.terrain, tiles.data(), tile_count(), is_manual ? &scale : &view, &options, &selection,
                     &failure) != SCREE_OK) {
        log(std::string("the selection: ") + failure.text);
        selection.drawn_count = selection.wanted_count = 0;
    }
    told.tolerance_px = selection.tolerance_px;
    if (!settings.morph) // whole rungs
        for (uint32_t i = 0; i < selection.drawn_count; i++) selected[i].level = selected[i].rung;
}

// How much may change in a frame: those tiles first that are farthest behind; the others wait at the end of the rung
// that they show.
void TerrainSet::spread() {
    std::vector<std::pair<double, uint32_t>> due;
    const std::vector<CutTile> &tiles_now = cut->tiles();
    for (uint32_t i = 0; i < tiles_now.size(); i++) {
        const Held &tile = held[tiles_now[i].tile];
        double ahead = tiles_now[i].level - tile.mesh->rung();
        bool was_drawn = tile.last_frame + 1 == frame_number;
        if (was_drawn && (ahead > 0 || ahead <= -1)) due.emplace_back(-std::fabs(ahead), i);
    }
    std::sort(due.begin(), due.end());
    int64_t left = SPLITS_A_FRAME;
    for (const auto &[order, i] : due) {
        const TileMesh &mesh = *held[tiles_now[i].tile].mesh;
        const scree_rung *rungs = mesh.header().rungs;
        uint32_t from = mesh.rung(), to = (uint32_t)std::ceil(tiles_now[i].level);
        if (left <= 0) cut->hold(i, to > from ? from : from - 1 + SLIGHT);
        left -= SPLITS_A_STITCH + std::abs((int64_t)rungs[to].vertex_count - (int64_t)rungs[from].vertex_count);
    }
}

void TerrainSet::seek() {
    std::vector<Shown> before = std::move(drawn);
    std::vector<size_t> old_places; // of each drawn, among those of the frame before; SIZE_MAX: new
    drawn.clear();
    changed.clear();
    told.splits = 0;
    size_t old = 0; // both lists are in the order of the cut
    for (const CutTile &one : cut->tiles()) {
        Held &tile = held[one.tile];
        while (old < before.size() && scree_tile_compare(&tiles[before[old].tile].id, &tiles[one.tile].id) < 0) old++;
        bool was_drawn = old < before.size() && before[old].mesh == tile.mesh;
        bool is_other = tile.mesh->seek(one.level, &told.splits);
        drawn.push_back({one.tile, tile.mesh});
        changed.push_back(!was_drawn || is_other);
        old_places.push_back(was_drawn ? old : SIZE_MAX);
        for (uint32_t at = one.tile; at != UINT32_MAX; at = parents[at]) held[at].last_frame = frame_number;
    }
    bool is_same = drawn.size() == before.size();
    for (size_t i = 0; i < drawn.size() && is_same; i++) is_same = old_places[i] == i;
    is_due = changed;
    is_moved.assign(drawn.size(), 0);
    if (!is_same) find_neighbours(old_places);
}

uint64_t TerrainSet::bytes_held() const {
    uint64_t bytes = 0;
    for (uint32_t tile : holding) bytes += held[tile].bytes;
    return bytes;
}

void TerrainSet::tell_drawn() {
    told.tiles_drawn = (uint32_t)drawn.size();
    told.triangles = 0;
    for (size_t i = 0; i < drawn.size(); i++) {
        const TileMesh &mesh = *drawn[i].mesh;
        const scree_rung &rung = mesh.header().rungs[mesh.rung()];
        told.triangles += mesh.triangle_count();
        told.coarsest_rung = i == 0 ? rung.rung : std::min(told.coarsest_rung, rung.rung);
        told.finest_rung = i == 0 ? rung.rung : std::max(told.finest_rung, rung.rung);
        told.coarsest_svo_m = i == 0 ? rung.svo_m : std::max(told.coarsest_svo_m, (double)rung.svo_m);
        told.finest_svo_m = i == 0 ? rung.svo_m : std::min(told.finest_svo_m, (double)rung.svo_m);
    }
    told.tiles_held = (uint32_t)holding.size();
    told.tiles_loading = loaders == nullptr ? 0 : loaders->loading();
    told.bytes_held = bytes_held();
}

void TerrainSet::frame(const scree_view &view, const TerrainSettings &settings, double seconds) {
    frame_number++;
    Stopwatch watch;
    bury_retired();
    take_arrivals();
    if (!settings.is_frozen) choose(view, settings);
    if (settings.is_frozen && !is_first)
        cut->step(selected.data(), selection.drawn_count, 0);
    else if (is_first || settings.rungs_per_second <= 0 || !settings.morph)
        cut->jump(selected.data(), selection.drawn_count);
    else
        cut->step(selected.data(), selection.drawn_count, settings.rungs_per_second * seconds);
    if (!is_first && settings.morph && settings.rungs_per_second > 0) spread();
    is_first = false;
    told.select_ms = watch.lap_ms();
    seek();
    told.seek_ms = watch.lap_ms();
    stitch_changed(settings.stitch);
    agree_on_levels(settings.stitch);
    told.stitch_ms = watch.lap_ms();
    make_room(settings.memory_bytes);
    request(settings);
    tell_drawn();
    told.select_ms += watch.lap_ms();
}

// ---- what is to come, and what has to go ----

void TerrainSet::request(const TerrainSettings &settings) {
    std::deque<LoadRequest> requests;
    uint64_t taken = bytes_held() + (loaders == nullptr ? 0 : loaders->loading_bytes());
    for (const LoadedTile &one : arrived) taken += one.mesh == nullptr ? 0 : one.mesh->bytes();
    uint64_t room = settings.memory_bytes > taken ? settings.memory_bytes - taken : 0;
    for (uint32_t tile : denied) is_final[tile] = 0;
    denied.clear();
    auto ask = [&](uint32_t tile, uint32_t rungs, bool is_awaited) {
        const scree_stream_header *header = tiles[tile].header;
        if (header != nullptr) rungs = std::min(rungs, header->rung_count);
        bool has_come =
            std::any_of(arrived.begin(), arrived.end(), [&](const LoadedTile &one) { return one.tile == tile; });
        if (is_final[tile] || has_come || rungs <= tiles[tile].rungs_ready) return;
        uint64_t bytes = header == nullptr ? BYTES_A_BASE : BYTES_A_TRIANGLE * header->rungs[rungs - 1].triangle_count;
        if (bytes > room) { // what there is of it has to do
            if (is_awaited) denied.push_back(tile);
            return;
        }
        room -= bytes;
        requests.push_back({tile, rungs, bytes, manifest.path_of(tiles[tile].id)});
    };
    for (uint32_t tile : cut->awaited()) ask(tile, UINT32_MAX, true);
    for (uint32_t tile : denied) is_final[tile] = 1;
    for (uint32_t i = 0; i < selection.wanted_count; i++) {
        const scree_stream_header *header = tiles[wanted[i].tile].header;
        uint32_t octave = header == nullptr ? 1 : (uint32_t)held[wanted[i].tile].mesh->octave_increments();
        uint32_t end = wanted[i].end_rung <= 1 ? 0 : (wanted[i].end_rung - 1 + octave - 1) / octave * octave;
        ask(wanted[i].tile, end + 1, false);
    }
    asked = requests.size();
    if (loaders != nullptr) return loaders->want(std::move(requests));
    for (const LoadRequest &one : requests) take(load_tile(one, world));
}

void TerrainSet::drop(uint32_t tile) {
    retired.push_back(held[tile].mesh);
    held[tile] = {};
    tiles[tile].header = nullptr;
    tiles[tile].rungs_ready = 0;
    holding.erase(std::find(holding.begin(), holding.end(), tile));
}

// The tiles that have not been drawn for longest go first, and no tile before those below it.
void TerrainSet::make_room(uint64_t memory_bytes) {
    uint64_t bytes = bytes_held();
    if (bytes <= memory_bytes - memory_bytes / 8) return;
    std::vector<uint32_t> oldest = holding;
    std::sort(oldest.begin(), oldest.end(), [this](uint32_t a, uint32_t b) {
        if (held[a].last_frame != held[b].last_frame) return held[a].last_frame < held[b].last_frame;
        return a > b; // finer zooms have higher numbers
    });
    for (uint32_t tile : oldest) {
        bool has_below = false;
        for (uint32_t child = 0; child < tiles[tile].child_count; child++)
            has_below = has_below || tiles[tiles[tile].first_child + child].rungs_ready > 0;
        if (held[tile].last_frame == frame_number || has_below || parents[tile] == UINT32_MAX) continue;
        bytes -= held[tile].bytes;
        drop(tile);
        if (bytes <= memory_bytes - memory_bytes / 4) return;
    }
}

std::pair<double, double> TerrainSet::svo_range_m() const {
    double finest_m = HUGE_VAL, coarsest_m = 0;
    for (uint32_t i = 0; i < tile_count() && parents[i] == UINT32_MAX; i++)
        if (tiles[i].header != nullptr) {
            const scree_stream_header &header = *tiles[i].header;
            coarsest_m = std::max(coarsest_m, (double)header.rungs[0].svo_m);
            finest_m = std::min(finest_m, (double)header.rungs[header.rung_count - 1].svo_m);
        }
    for (const scree_zoom_scale &zoom : manifest.zooms)
        if (zoom.finest_svo_m > 0) finest_m = std::min(finest_m, zoom.finest_svo_m);
    return {finest_m, coarsest_m};
}

bool TerrainSet::is_settled() const {
    if (is_first || !cut->is_still()) return false;
    return asked == 0 && arrived.empty() && (loaders == nullptr || loaders->is_idle());
}
