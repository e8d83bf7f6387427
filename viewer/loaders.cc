#include "viewer/loaders.h"

LoadedTile load_tile(const LoadRequest &request, const MeshWorld &world) {
    TileFile file = tile_file_read(request.path, request.rungs);
    LoadedTile tile = {request.tile, request.rungs, nullptr, file.bytes_read, file.is_broken, std::move(file.error)};
    if (file.player != nullptr) tile.mesh = std::make_unique<TileMesh>(std::move(file.player), file.is_broken, world);
    return tile;
}

Loaders::Loaders(unsigned count, const MeshWorld &world) : world(world) {
    for (unsigned i = 0; i < count; i++) threads.emplace_back([this] { work(); });
}

Loaders::~Loaders() {
    {
        std::lock_guard<std::mutex> guard(lock);
        is_ending = true;
    }
    has_work.notify_all();
    for (std::thread &thread : threads) thread.join();
}

void Loaders::work() {
    std::unique_lock<std::mutex> guard(lock);
    while (true) {
        has_work.wait(guard, [this] { return is_ending || !queue.empty() || !buried.empty(); });
        if (is_ending) return;
        std::vector<std::shared_ptr<TileMesh>> freed = std::move(buried);
        buried.clear();
        if (!freed.empty()) {
            guard.unlock();
            freed.clear();
            guard.lock();
            continue;
        }
        LoadRequest request = std::move(queue.front());
        queue.pop_front();
        if (!begun.emplace(request.tile, request.bytes).second) continue;
        guard.unlock();
        LoadedTile tile;
        try {
            tile = load_tile(request, world);
        } catch (const std::bad_alloc &) {
            tile = {request.tile, request.rungs, nullptr, 0, true, request.path + ": no memory is left for it"};
        }
        guard.lock();
        finished.push_back(std::move(tile));
    }
}

void Loaders::want(std::deque<LoadRequest> requests) {
    {
        std::lock_guard<std::mutex> guard(lock);
        queue = std::move(requests);
    }
    has_work.notify_all();
}

void Loaders::bury(std::vector<std::shared_ptr<TileMesh>> meshes) {
    {
        std::lock_guard<std::mutex> guard(lock);
        for (std::shared_ptr<TileMesh> &mesh : meshes) buried.push_back(std::move(mesh));
    }
    has_work.notify_one();
}

std::vector<LoadedTile> Loaders::take() {
    std::lock_guard<std::mutex> guard(lock);
    std::vector<LoadedTile> taken = std::move(finished);
    finished.clear();
    for (const LoadedTile &tile : taken) begun.erase(tile.tile);
    return taken;
}

uint32_t Loaders::loading() const {
    std::lock_guard<std::mutex> guard(lock);
    return (uint32_t)begun.size();
}

uint64_t Loaders::loading_bytes() const {
    std::lock_guard<std::mutex> guard(lock);
    uint64_t bytes = 0;
    for (const auto &one : begun) bytes += one.second;
    return bytes;
}

bool Loaders::is_idle() const {
    std::lock_guard<std::mutex> guard(lock);
    return queue.empty() && begun.empty() && finished.empty();
}
