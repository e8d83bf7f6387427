/* scree extract: terrain at a scale, as a mesh file. */
#include "src/command.h"
#include "src/extract_mesh.h"
#include "src/extract_stream_io.h"
#include "src/mesh_file_io.h"
#include "src/raster_arguments.h"
#include "src/stream_set_io.h"
#include "src/terrain_path_io.h"
#include "src/terrain_set_io.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST_RUNG 1000

static const char help[] =
    "Usage: scree extract OUT|TILE.scree|TILE.terrain -o MESH [OPTION]...\n"
    "Writes terrain at one scale, or one tile of it, as a triangle mesh; tiles are joined at their borders.\n"
    "The ending of MESH says how: .ply, .obj, .stl or .off.\n\n"
    "  -o MESH          the file to write\n"
    "  --svo M          the coarsest scale whose smallest visible object is at most M metres\n"
    "  --error M        the coarsest scale whose largest error is at most M metres\n"
    "  --rung L         this rung of the scale ladder, from streams\n"
    "  --zoom Z         this zoom, from static tiles\n"
    "  --tile Z/X/Y     one tile; for a .terrain file whose folders do not tell, where it lies\n"
    "  --ecef           earth-centred coordinates in place of metres east, north and up of the middle\n"
    "  -q               say nothing\n\n"
    "The finest there is, where no scale is named. The scale is taken from the streams in OUT, which have every rung\n"
    "of the ladder: four to a zoom, 4 Z - 4 to 4 Z at zoom Z, and further ones at the finest; of static tiles, one a\n"
    "zoom, where there are no streams or OUT/terrain is named. At one scale each place is shown by the tile of the\n"
    "zoom that has the rung; where only coarser ones have data, by those, and their borders are made to meet.\n"
    "scree info tells SVO and max error of every rung. A bound holds for every tile where data are.\n\n"
    "The local profile keeps x and y of its CRS, with heights in metres.\n"
    "Memory grows with the mesh: about 200 bytes a triangle; more than 2^30 of them are refused.\n";

struct arguments {
    const char *path, *output;
    bool has_zoom, has_rung, has_error, has_svo, has_tile, as_ecef, quiet;
    int zoom, rung;
    double error_m, svo_m;
    struct tile_id tile;
};

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree extract: %s%s; scree extract --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* One option with its value at argv[*at]. */
static int parse_option(int argc, char **argv, int *at, struct arguments *arguments) {
    const char *option = argv[(*at)++];
    const char *value = *at < argc ? argv[*at] : NULL;
    if (strcmp(option, "--ecef") == 0) {
        arguments->as_ecef = true;
        return EXIT_DONE;
    }
    if (strcmp(option, "-q") == 0) {
        arguments->quiet = true;
        return EXIT_DONE;
    }
    if (strcmp(option, "-o") == 0 && value != NULL) {
        arguments->output = value;
    } else if (strcmp(option, "--zoom") == 0 && value != NULL) {
        arguments->has_zoom = true;
        if (!argument_integer(value, 0, MAX_ZOOM, &arguments->zoom)) return usage("--zoom wants a zoom, not ", value);
    } else if (strcmp(option, "--rung") == 0 && value != NULL) {
        arguments->has_rung = true;
        if (!argument_integer(value, -LARGEST_RUNG, LARGEST_RUNG, &arguments->rung))
            return usage("--rung wants a rung, not ", value);
    } else if (strcmp(option, "--error") == 0 && value != NULL) {
        arguments->has_error = true;
        if (!argument_number(value, &arguments->error_m) || arguments->error_m < 0)
            return usage("--error wants metres, not ", value);
    } else if (strcmp(option, "--svo") == 0 && value != NULL) {
        arguments->has_svo = true;
        if (!argument_number(value, &arguments->svo_m) || arguments->svo_m < 0)
            return usage("--svo wants metres, not ", value);
    } else if (strcmp(option, "--tile") == 0 && value != NULL) {
        arguments->has_tile = true;
        if (!tile_id_parse(value, &arguments->tile)) return usage("--tile wants zoom/x/y, not ", value);
    } else {
        return usage(value == NULL ? "an option without its value, or unknown: " : "there is no option ", option);
    }
    ++*at;
    return EXIT_DONE;
}

static int parse(int argc, char **argv, struct arguments *arguments) {
    for (int at = 1; at < argc;) {
        if (argv[at][0] == '-' && argv[at][1] != '\0') {
            int code = parse_option(argc, argv, &at, arguments);
            if (code != EXIT_DONE) return code;
        } else if (arguments->path != NULL) {
            return usage("one terrain at a time, and then there is ", argv[at]);
        } else {
            arguments->path = argv[at++];
        }
    }
    if (arguments->path == NULL) return usage("which terrain? Name a folder, a .scree or a .terrain file", "");
    if (arguments->output == NULL) return usage("-o names the mesh to write", "");
    if (!mesh_file_is_known(arguments->output))
        return usage("meshes are written as .ply, .obj, .stl or .off, not ", arguments->output);
    if (arguments->has_zoom + arguments->has_rung + arguments->has_error + arguments->has_svo > 1)
        return usage("--rung, --zoom, --error and --svo exclude each other", "");
    if (arguments->has_zoom && arguments->has_tile) return usage("--tile has a zoom already; leave --zoom out", "");
    return EXIT_DONE;
}

/* The coarsest zoom that is fine enough, or -1. */
static int choose_zoom(const struct terrain_set *set, const struct arguments *arguments) {
    for (int zoom = 0; zoom <= MAX_ZOOM; zoom++) {
        const struct layer_zoom_info *told = &set->layer.zooms[zoom];
        if (set->tiles[zoom].count == 0 || !told->is_told) continue;
        if (arguments->has_error && told->max_error_m <= arguments->error_m) return zoom;
        if (arguments->has_svo && told->svo_m <= arguments->svo_m) return zoom;
    }
    return -1;
}

static enum scree_status find_zoom(const struct terrain_set *set, const struct arguments *arguments, int *zoom,
                                   struct scree_error *error) {
    *zoom = arguments->zoom;
    if (arguments->has_error || arguments->has_svo) {
        *zoom = choose_zoom(set, arguments);
        if (*zoom < 0)
            return scree_fail(error, SCREE_E_ARGUMENT, "%s: no zoom is that fine; scree info tells what there is",
                              set->folder);
    } else if (!arguments->has_zoom) {
        for (int z = 0; z <= MAX_ZOOM; z++)
            if (set->tiles[z].count != 0) *zoom = z;
    }
    if (set->tiles[*zoom].count == 0 || *zoom > set->layer.lattice.finest_zoom)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: there are no tiles of zoom %d", set->folder, *zoom);
    return SCREE_OK;
}

static enum scree_status add_from_set(struct scree_memory *memory, const struct terrain_set *set, struct tile_id id,
                                      struct extract_mesh *mesh, struct scree_error *error) {
    struct decoded_tile tile;
    enum scree_status status = terrain_set_read(memory, set, id, &tile, NULL, error);
    if (status == SCREE_OK) status = extract_mesh_add(memory, mesh, id, &tile, error);
    decoded_tile_free(memory, &tile);
    return status;
}

/* The middle of the tiles: of all at this zoom, or of one. */
static void find_middle(const struct lattice *lattice, const struct tile_id *ids, uint32_t count, double middle[2]) {
    double all[4] = {0}, bounds[4];
    for (uint32_t i = 0; i < count; i++) {
        lattice_tile_bounds(lattice, ids[i], bounds);
        for (int k = 0; k < 4; k++)
            if (i == 0 || (k < 2 ? bounds[k] < all[k] : bounds[k] > all[k])) all[k] = bounds[k];
    }
    middle[0] = (all[0] + all[2]) / 2;
    middle[1] = (all[1] + all[3]) / 2;
}

static enum scree_status write_mesh(struct scree_memory *memory, const struct arguments *arguments,
                                    struct extract_mesh *mesh, const char *scale, const double middle[2],
                                    struct scree_error *error) {
    bool is_geodetic = mesh->lattice->profile == PROFILE_GEODETIC;
    struct horizon_frame frame = place_horizon(middle[0], middle[1]);
    enum scree_status status =
        extract_mesh_place(memory, mesh, is_geodetic && !arguments->as_ecef ? &frame : NULL, error);
    if (status == SCREE_OK)
        status = mesh_file_write(arguments->output, mesh->xyz, mesh->vertex_count, mesh->corners, mesh->triangle_count,
                                 error);
    if (status != SCREE_OK || arguments->quiet) return status;
    printf("%s: %s, %u vertices, %u triangles, in metres", arguments->output, scale, (unsigned)mesh->vertex_count,
           (unsigned)mesh->triangle_count);
    if (!is_geodetic) {
        printf(" of height over x and y of the raster's CRS");
    } else if (arguments->as_ecef) {
        printf(", earth-centred");
    } else {
        printf(" east, north and up of %.8g, %.8g", middle[0], middle[1]);
    }
    printf("\n");
    if (mesh->origin[0] != 0 || mesh->origin[1] != 0 || mesh->origin[2] != 0)
        printf("add %.0f, %.0f, %.0f to its coordinates, which are too large for the floats of such files\n",
               mesh->origin[0], mesh->origin[1], mesh->origin[2]);
    return SCREE_OK;
}

static enum scree_status write_zoom(struct scree_memory *memory, const struct arguments *arguments,
                                    struct extract_mesh *mesh, const double middle[2], struct scree_error *error) {
    char scale[32];
    snprintf(scale, sizeof scale, "zoom %d", mesh->zoom);
    return write_mesh(memory, arguments, mesh, scale, middle, error);
}

/* ---- static tiles ---- */

static enum scree_status extract_from_set(struct scree_memory *memory, const struct arguments *arguments,
                                          const char *path, struct scree_error *error) {
    struct extract_mesh mesh = {0};
    double middle[2];
    struct terrain_set *set = calloc(1, sizeof *set);
    if (set == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    enum scree_status status = terrain_set_open(memory, path, set, error);
    if (status != SCREE_OK) goto cleanup;
    mesh.lattice = &set->layer.lattice;
    if (arguments->has_tile) {
        mesh.zoom = arguments->tile.zoom;
        if (tile_list_find(&set->tiles[mesh.zoom], arguments->tile) == TILE_NOT_LISTED ||
            mesh.zoom > set->layer.lattice.finest_zoom) {
            status = scree_fail(error, SCREE_E_ARGUMENT, "%s: there is no tile %d/%u/%u", set->folder, mesh.zoom,
                                (unsigned)arguments->tile.x, (unsigned)arguments->tile.y);
            goto cleanup;
        }
        find_middle(mesh.lattice, &arguments->tile, 1, middle);
        status = add_from_set(memory, set, arguments->tile, &mesh, error);
    } else {
        status = find_zoom(set, arguments, &mesh.zoom, error);
        const struct tile_list *list = &set->tiles[mesh.zoom];
        find_middle(mesh.lattice, list->ids, list->count, middle);
        for (uint32_t i = 0; i < list->count && status == SCREE_OK; i++)
            status = add_from_set(memory, set, list->ids[i], &mesh, error);
    }
    if (status == SCREE_OK) status = write_zoom(memory, arguments, &mesh, middle, error);
cleanup:
    extract_mesh_free(memory, &mesh);
    terrain_set_free(memory, set);
    free(set);
    return status;
}

/* A file without a layer.json near it: the geodetic profile, where its folders or --tile say. */
static enum scree_status extract_file(struct scree_memory *memory, const struct arguments *arguments,
                                      struct scree_error *error) {
    struct tile_id id = arguments->tile;
    struct extract_mesh mesh = {0};
    struct decoded_tile tile;
    double middle[2];
    if (!arguments->has_tile && !terrain_path_tile(arguments->path, &id))
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: its folders are not zoom/x; say where it lies with --tile Z/X/Y", arguments->path);
    struct lattice lattice = lattice_geodetic(id.zoom);
    if (lattice_tile_window(&lattice, id).columns == 0)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: zoom %d has no tile %u/%u", arguments->path, id.zoom,
                          (unsigned)id.x, (unsigned)id.y);
    mesh.lattice = &lattice;
    mesh.zoom = id.zoom;
    enum scree_status status = terrain_file_read(memory, arguments->path, &tile, NULL, error);
    if (status == SCREE_OK) status = extract_mesh_add(memory, &mesh, id, &tile, error);
    find_middle(&lattice, &id, 1, middle);
    if (status == SCREE_OK) status = write_zoom(memory, arguments, &mesh, middle, error);
    decoded_tile_free(memory, &tile);
    extract_mesh_free(memory, &mesh);
    return status;
}

static enum scree_status extract_terrain(struct scree_memory *memory, struct arguments *arguments,
                                         struct scree_error *error) {
    char folder[3072];
    bool has_scale = arguments->has_rung || arguments->has_error || arguments->has_svo;
    if (arguments->has_rung)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: static tiles have no rungs; name streams, or a --zoom",
                          arguments->path);
    if (has_scale && arguments->has_tile)
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: a static tile has one scale; leave --error and --svo out",
                          arguments->path);
    if (!terrain_path_is_tile(arguments->path)) return extract_from_set(memory, arguments, arguments->path, error);
    if (arguments->has_zoom || has_scale)
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "%s: a static tile has one scale; leave --zoom, --error and --svo out", arguments->path);
    if (!arguments->has_tile && terrain_path_folder(arguments->path, folder, sizeof folder)) {
        arguments->has_tile = terrain_path_tile(arguments->path, &arguments->tile);
        return extract_from_set(memory, arguments, folder, error);
    }
    return extract_file(memory, arguments, error);
}

/* ---- streams ---- */

static struct scale_wish wish_of(const struct arguments *arguments) {
    if (arguments->has_rung) return (struct scale_wish){.kind = SCALE_RUNG, .rung = arguments->rung};
    if (arguments->has_svo) return (struct scale_wish){.kind = SCALE_SVO, .bound_m = arguments->svo_m};
    if (arguments->has_error) return (struct scale_wish){.kind = SCALE_ERROR, .bound_m = arguments->error_m};
    return (struct scale_wish){.kind = SCALE_FINEST};
}

static enum scree_status extract_from_streams(struct scree_memory *memory, const struct arguments *arguments,
                                              struct stream_extract *extract, struct scree_error *error) {
    const struct scale_wish wish = wish_of(arguments);
    struct stream_set *set = calloc(1, sizeof *set);
    if (set == NULL) return scree_fail(error, SCREE_E_MEMORY, "out of memory");
    enum scree_status status = stream_set_open(memory, arguments->path, set, error);
    if (status == SCREE_OK)
        status = extract_stream_set(memory, set, &wish, arguments->has_tile ? &arguments->tile : NULL, extract, error);
    stream_set_free(memory, set);
    free(set);
    return status;
}

static enum scree_status extract_streams(struct scree_memory *memory, const struct arguments *arguments,
                                         struct scree_error *error) {
    struct stream_extract extract = {0};
    const struct scale_wish wish = wish_of(arguments);
    char scale[160];
    enum scree_status status;
    if (!stream_path_is_tile(arguments->path)) {
        status = extract_from_streams(memory, arguments, &extract, error);
    } else if (arguments->has_tile) {
        status = scree_fail(error, SCREE_E_ARGUMENT, "%s: a stream says itself which tile it is; leave --tile out",
                            arguments->path);
    } else {
        status = extract_stream_file(memory, arguments->path, &wish, &extract, error);
    }
    if (status != SCREE_OK) goto cleanup;
    if (!arguments->quiet && (arguments->has_svo || arguments->has_error))
        fprintf(stderr, "scree extract: rung %d is the coarsest with %s of at most %g m\n", (int)extract.rung,
                arguments->has_svo ? "an SVO" : "a max error",
                arguments->has_svo ? arguments->svo_m : arguments->error_m);
    snprintf(scale, sizeof scale, "rung %d of zoom %d, %u tile%s, SVO %.4g m, max error %.4g m", (int)extract.rung,
             extract.zoom, (unsigned)extract.tiles, extract.tiles == 1 ? "" : "s", extract.svo_m, extract.max_error_m);
    status = write_mesh(memory, arguments, &extract.mesh, scale, extract.middle, error);
cleanup:
    stream_extract_free(memory, &extract);
    return status;
}

/* ---- which of them ---- */

static enum scree_status extract(struct scree_memory *memory, struct arguments *arguments, struct scree_error *error) {
    const char *path = arguments->path;
    if (arguments->has_zoom && stream_path_is_tile(path))
        return scree_fail(error, SCREE_E_ARGUMENT, "%s: a stream has rungs; name one with --rung", path);
    if (stream_path_is_tile(path)) return extract_streams(memory, arguments, error);
    if (terrain_path_is_tile(path)) return extract_terrain(memory, arguments, error);
    bool has_terrain = product_is_there(path, PRODUCT_TERRAIN), has_streams = product_is_there(path, PRODUCT_STREAM);
    if (!has_terrain && !has_streams) return product_fail_none(path, error);
    if (has_streams && !arguments->has_zoom) return extract_streams(memory, arguments, error);
    if (has_terrain) return extract_terrain(memory, arguments, error);
    return scree_fail(error, SCREE_E_ARGUMENT, "%s: has no static tiles, whose zoom --zoom tells; name a --rung", path);
}

int command_extract(int argc, char **argv) {
    struct arguments arguments = {0};
    struct scree_error error = {0};
    struct scree_memory memory = {0};
    if (argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        fputs(help, stdout);
        return EXIT_DONE;
    }
    int code = parse(argc, argv, &arguments);
    if (code != EXIT_DONE) return code;
    if (extract(&memory, &arguments, &error) == SCREE_OK) return EXIT_DONE;
    fprintf(stderr, "scree extract: %s\n", error.text);
    return EXIT_FAILED;
}
