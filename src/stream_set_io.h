/* Streams on disk: scree.json and z/x/y.scree, or a single .scree file. Reading only. */
#ifndef SCREE_STREAM_SET_IO_H
#define SCREE_STREAM_SET_IO_H

#include "src/product_files_io.h"
#include "src/scree_read_io.h"
#include "src/tile_list.h"
#include "stream/memory.h"
#include <scree/error.h>
#include <scree/player.h>

struct stream_set {
    char folder[PRODUCT_FOLDER_BYTES]; /* that holds scree.json */
    struct scree_info info;
    struct tile_list tiles[MAX_ZOOM + 1]; /* the files that are there */
};

/* Opens OUT, OUT/stream or the path of a scree.json, and lists the files. */
enum scree_status stream_set_open(struct scree_memory *memory, const char *path, struct stream_set *set,
                                  struct scree_error *error);

/* Safe on a zeroed set and twice. */
void stream_set_free(struct scree_memory *memory, struct stream_set *set);

/* Does the path end in ".scree"? */
bool stream_path_is_tile(const char *path);

/* Reads a file's header and nothing else; `file_bytes` is the size of the file, which may lack its end. Errors name the
 * file. */
enum scree_status stream_file_header(struct scree_memory *memory, const char *path, struct scree_stream_header *header,
                                     uint64_t *file_bytes, struct scree_error *error);

/* Reads a whole file and decodes all of it: `player` plays it, its finest rung first, without positions. The player is
 * the caller's to free; NULL after a failure. Errors name the file. */
enum scree_status stream_file_play(struct scree_memory *memory, const char *path, struct scree_player **player,
                                   uint64_t *file_bytes, struct scree_error *error);

/* The base mesh alone, of a tile of a set: no more of the file is read. */
enum scree_status stream_set_play_base(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                                       struct scree_player **player, struct scree_error *error);

/* Header and all of it, for a tile of a set. */
enum scree_status stream_set_header(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                                    struct scree_stream_header *header, uint64_t *file_bytes,
                                    struct scree_error *error);
enum scree_status stream_set_play(struct scree_memory *memory, const struct stream_set *set, struct tile_id id,
                                  struct scree_player **player, uint64_t *file_bytes, struct scree_error *error);

#endif
