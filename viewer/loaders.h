// Threads that read and decode tiles, the most urgent first, and hand them over when they are asked.
#ifndef SCREE_VIEWER_LOADERS_H
#define SCREE_VIEWER_LOADERS_H

#include "viewer/tile_mesh.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <unordered_map>

struct LoadRequest {
    uint32_t tile;
    uint32_t rungs; // so many of them
    uint64_t bytes; // of memory that it will take, roughly
    std::string path;
};

struct LoadedTile {
    uint32_t tile, rungs;           // as asked for
    std::unique_ptr<TileMesh> mesh; // null: not even the base mesh could be had
    uint64_t bytes_read;
    bool is_broken;
    std::string error;
};

LoadedTile load_tile(const LoadRequest &request, const MeshWorld &world);

class Loaders {
  public:
    Loaders(unsigned threads, const MeshWorld &world);
    ~Loaders();
    Loaders(const Loaders &) = delete;

    // What is to be loaded from now on, in this order, in place of what was asked for before and has not begun.
    void want(std::deque<LoadRequest> requests);

    // What has been finished since.
    std::vector<LoadedTile> take();

    // Frees meshes that nobody else holds, which takes longer than a frame has time for.
    void bury(std::vector<std::shared_ptr<TileMesh>> meshes);

    uint32_t loading() const;       // begun, and not taken yet
    uint64_t loading_bytes() const; // of these
    bool is_idle() const;           // nothing asked for, nothing under way, nothing to take

  private:
    void work();

    const MeshWorld world;
    mutable std::mutex lock;
    std::condition_variable has_work;
    std::deque<LoadRequest> queue;
    std::unordered_map<uint32_t, uint64_t> begun; // tiles and bytes
    std::vector<LoadedTile> finished;
    std::vector<std::shared_ptr<TileMesh>> buried;
    bool is_ending = false;
    std::vector<std::thread> threads;
};

#endif
