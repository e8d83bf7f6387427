#define _LARGEFILE64_SOURCE /* for VSIStatBufL */
#include "src/mesh_file_read.h"
#include "src/mesh_parts.h"
#include "src/raster_parts_io.h"

#include <cpl_conv.h>
#include <inttypes.h>
#include <string.h>

#define MOST_BYTES ((uint64_t)1 << 40)

typedef enum scree_status (*mesh_reader)(struct mesh_source *source, struct scree_error *error);

static mesh_reader find_reader(const char *name) {
    static const struct {
        const char *ending;
        mesh_reader read;
    } formats[] = {
        {"ply", mesh_read_ply}, {"obj", mesh_read_obj}, {"off", mesh_read_off},
        {"stl", mesh_read_stl}, {"om", mesh_read_om},
    };
    const char *ending = CPLGetExtension(name);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (EQUAL(ending, formats[i].ending)) return formats[i].read;
    return NULL;
}

bool mesh_file_is_mesh(const char *name) {
    return find_reader(name) != NULL;
}

/* The whole file. */
static enum scree_status load(const char *path, struct mesh_source *source, unsigned char **bytes,
                              struct scree_error *error) {
    enum scree_status status = SCREE_OK;
    VSIStatBufL about;
    if (VSIStatExL(path, &about, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG) != 0)
        return scree_fail(error, SCREE_E_IO, "%s: there is no such file", path);
    if (!VSI_ISREG(about.st_mode)) return scree_fail(error, SCREE_E_IO, "%s: is no file", path);
    VSILFILE *stream = VSIFOpenL(path, "rb");
    if (stream == NULL) return scree_fail(error, SCREE_E_IO, "%s: cannot be opened", path);
    uint64_t size_bytes = VSIFSeekL(stream, 0, SEEK_END) == 0 ? VSIFTellL(stream) : 0;
    if (size_bytes > MOST_BYTES) {
        status = scree_fail(error, SCREE_E_LIMIT, "%s: is too large for a mesh", path);
        goto cleanup;
    }
    *bytes = scree_allocate(source->tin->memory, (size_t)size_bytes, 1, "a mesh file's bytes", error);
    if (*bytes == NULL) {
        status = error->status;
    } else if (VSIFSeekL(stream, 0, SEEK_SET) != 0 ||
               VSIFReadL(*bytes, 1, (size_t)size_bytes, stream) != (size_t)size_bytes) {
        status = scree_fail(error, SCREE_E_IO, "%s: its %" PRIu64 " bytes cannot be read", path, size_bytes);
    }
    source->bytes = *bytes;
    source->size_bytes = (size_t)size_bytes;
cleanup:
    VSIFCloseL(stream);
    return status;
}

enum scree_status mesh_file_read(const char *path, struct tin *tin, struct scree_error *error) {
    struct mesh_source source = {.name = path, .tin = tin};
    struct scree_error why = {0};
    struct raster_trap trap;
    unsigned char *bytes = NULL;
    mesh_reader read = find_reader(path);
    if (read == NULL)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: meshes are read from .ply, .obj, .stl, .off or .om", path);
    raster_trap_set(&trap);
    enum scree_status status = load(path, &source, &bytes, &why);
    if (status == SCREE_OK) status = read(&source, &why);
    if (status == SCREE_OK) status = mesh_check(&source, &why);
    if (status != SCREE_OK) {
        bool has_name = strncmp(why.text, path, strlen(path)) == 0; /* those of memory have not */
        status = scree_fail(error, status, "%s%s%s", has_name ? "" : path, has_name ? "" : ": ", why.text);
        tin_release(tin);
    }
    scree_release(tin->memory, bytes);
    raster_trap_clear();
    return status;
}
