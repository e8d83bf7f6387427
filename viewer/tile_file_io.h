// A tile's file, read from its beginning as far as is wanted and no farther, and decoded.
#ifndef SCREE_VIEWER_TILE_FILE_IO_H
#define SCREE_VIEWER_TILE_FILE_IO_H

#include <cstdint>
#include <memory>
#include <scree/player.h>
#include <string>

struct PlayerDeleter {
    void operator()(scree_player *player) const { scree_player_free(player); }
};
using Player = std::unique_ptr<scree_player, PlayerDeleter>;

struct TileFile {
    Player player; // plays what could be read; null: not even the base mesh
    uint64_t bytes_read = 0;
    bool is_broken = false; // what was wanted is not there, or damaged; `error` says why in one line
    std::string error;
};

// Reads so many rungs, or all that there are. Any thread; different calls have nothing in common.
TileFile tile_file_read(const std::string &path, uint32_t rungs);

// The header alone.
bool tile_file_header(const std::string &path, scree_stream_header *header, std::string *error);

#endif
