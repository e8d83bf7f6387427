#include "viewer/tile_file_io.h"

#include <cpl_error.h>
#include <cpl_vsi.h>
#include <vector>

namespace {

constexpr size_t FIRST_BYTES = 8192;    // as a rule the header and the base mesh
constexpr size_t MOST_BYTES = 1u << 20; // of a piece

struct FileCloser {
    void operator()(VSILFILE *file) const { VSIFCloseL(file); }
};
using File = std::unique_ptr<VSILFILE, FileCloser>;

File open(const std::string &path, std::string *error) {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    File file(VSIFOpenL(path.c_str(), "rb"));
    CPLPopErrorHandler();
    if (file == nullptr) *error = path + ": there is no such file, or it cannot be read";
    return file;
}

// How many bytes lie between what has been taken and the end of the rung; a guess while there is no header.
size_t bytes_to(const scree_player *player, uint32_t rungs, uint64_t taken_bytes) {
    const scree_stream_header *header = scree_player_header(player);
    if (header == nullptr) return FIRST_BYTES;
    uint32_t last = (rungs < header->rung_count ? rungs : header->rung_count) - 1;
    uint64_t end = header->rungs[last].offset_bytes + header->rungs[last].size_bytes;
    uint64_t left = end > taken_bytes ? end - taken_bytes : 0;
    return left < MOST_BYTES ? (size_t)left : MOST_BYTES;
}

} // namespace

TileFile tile_file_read(const std::string &path, uint32_t rungs) {
    TileFile tile;
    scree_error failure = {};
    scree_player_options options = {};
    options.without_normals = true; // they are made of the finest mesh that is there
    scree_player *made = nullptr;
    File file = open(path, &tile.error);
    tile.is_broken = file == nullptr || scree_player_new(&options, &made, &failure) != SCREE_OK;
    tile.player.reset(made);
    if (failure.status < 0) tile.error = path + ": " + failure.text;
    std::vector<char> piece;
    scree_status status = SCREE_MORE;
    while (!tile.is_broken && status == SCREE_MORE && scree_player_rungs_ready(made) < rungs) {
        piece.resize(bytes_to(made, rungs, tile.bytes_read));
        size_t read = VSIFReadL(piece.data(), 1, piece.size(), file.get());
        tile.bytes_read += read;
        status = scree_player_push(made, piece.data(), read, &failure);
        tile.is_broken = status < 0 || (read == 0 && status == SCREE_MORE);
        if (status < 0)
            tile.error = path + ": " + failure.text;
        else if (tile.is_broken)
            tile.error = path + ": the stream is cut off; fetch it again";
    }
    if (tile.player != nullptr && scree_player_rungs_ready(made) == 0) tile.player.reset();
    return tile;
}

bool tile_file_header(const std::string &path, scree_stream_header *header, std::string *error) {
    scree_error failure = {};
    File file = open(path, error);
    if (file == nullptr) return false;
    std::vector<char> bytes(1 << 16);
    size_t read = VSIFReadL(bytes.data(), 1, bytes.size(), file.get());
    scree_status status = scree_stream_header_read(bytes.data(), read, header, &failure);
    if (status == SCREE_MORE) *error = path + ": the stream is cut off; fetch it again";
    if (status < 0) *error = path + ": " + failure.text;
    return status == SCREE_OK;
}
