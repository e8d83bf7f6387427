/* scree remesh: the mesh of a raster that an observer needs, from a quadtree. */
#include "src/command.h"
#include "src/mesh_file_io.h"
#include "src/raster_arguments.h"
#include "src/remesh.h"
#include "src/remesh_read_io.h"

#include <cpl_conv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_THRESHOLD   1.0
#define DEFAULT_REACH_POSTS 64
#define MRAD                1e3

static const char help[] =
    "Usage: scree remesh DEM... -o MESH [OPTION]...\n"
    "Writes a raster as a triangle mesh that is fine where the terrain bends and where an observer is near: the\n"
    "restricted quadtree of Cifuentes, Venere and Clausse (\"Interactive remeshing for navigation over landscape\n"
    "models\"). The ending of MESH says how: .ply, .obj, .stl or .off.\n\n"
    "  -o MESH              the file to write\n"
    "  --observer X,Y,Z     where the observer is: x and y in the raster's CRS, z in metres as the heights are;\n"
    "                       without one the threshold holds everywhere\n"
    "  --threshold T        squares of posts stay whole up to this sum of curvature, the change of slope over two\n"
    "                       posts at each post; default 1\n"
    "  --reach M            at this distance from the observer the threshold is T; nearer and farther it is smaller\n"
    "                       and larger in proportion. Default: 64 posts, where T 1 makes an RMS error of some 0.3\n"
    "                       milliradians, a third of a pixel on a screen of 1080 rows; single posts err ten times\n"
    "                       as much\n"
    "  -q                   say nothing but errors\n"
    "  --config KEY VALUE   a GDAL configuration option\n" RASTER_ARGUMENTS_HELP
    "\nThe raster's own pixels are the posts, up to 32769 a side; it takes about 14 bytes of memory a post and 200 a\n"
    "triangle of the mesh. Errors are not held but measured, at every post: the sum times the distance between posts\n"
    "over 16 is about the height by which a square may err. A mesh keeps x and y of the raster's CRS, with heights\n"
    "in metres; where these are longitude and latitude, it is in metres east, north and up of the raster's middle.\n";

struct arguments {
    struct raster_options raster;
    const char **inputs;
    const char *output;
    bool has_observer, quiet;
    double observer[3]; /* x, y in the CRS, height in metres */
    double threshold, reach_m;
};

static int usage(const char *what, const char *argument) {
    fprintf(stderr, "scree remesh: %s%s; scree remesh --help tells how\n", what, argument);
    return EXIT_USAGE;
}

/* Three numbers with commas between them. */
static bool take_place(const char *text, double place[3]) {
    for (int k = 0; k < 3; k++) {
        char *end;
        place[k] = strtod(text, &end);
        if (end == text || !isfinite(place[k]) || *end != (k < 2 ? ',' : '\0')) return false;
        text = end + 1;
    }
    return true;
}

/* One argument that is not about reading rasters; EXIT_DONE or the code to exit with. */
static int take(int argc, char **argv, int *at, struct arguments *arguments) {
    const char *name = argv[(*at)++], *value = *at < argc ? argv[*at] : NULL;
    if (strcmp(name, "-q") == 0) return arguments->quiet = true, EXIT_DONE;
    if (name[0] != '-' || name[1] == '\0') {
        arguments->inputs[arguments->raster.input_count++] = name;
        return EXIT_DONE;
    }
    if (strcmp(name, "--config") == 0) {
        if (*at + 1 >= argc) return usage("--config wants a key and a value", "");
        CPLSetConfigOption(argv[*at], argv[*at + 1]);
        *at += 2;
        return EXIT_DONE;
    }
    const bool is_observer = strcmp(name, "--observer") == 0, is_threshold = strcmp(name, "--threshold") == 0;
    const bool is_reach = strcmp(name, "--reach") == 0, is_output = strcmp(name, "-o") == 0;
    if (!is_observer && !is_threshold && !is_reach && !is_output) return usage("there is no option ", name);
    if (value == NULL) return usage("a value is missing behind ", name);
    ++*at;
    if (is_output) arguments->output = value;
    if (is_observer && !(arguments->has_observer = take_place(value, arguments->observer)))
        return usage("--observer wants x,y,z, not ", value);
    if (is_threshold && (!argument_number(value, &arguments->threshold) || arguments->threshold < 0))
        return usage("--threshold wants a number from 0, not ", value);
    if (is_reach && (!argument_number(value, &arguments->reach_m) || arguments->reach_m <= 0))
        return usage("--reach wants metres above 0, not ", value);
    return EXIT_DONE;
}

static int parse(int argc, char **argv, struct arguments *arguments) {
    for (int at = 1; at < argc;) {
        struct scree_error error = {0};
        enum argument_result taken = raster_argument_take(argc, argv, &at, &arguments->raster, &error);
        if (taken == ARGUMENT_WRONG) return usage(error.text, "");
        if (taken == ARGUMENT_TAKEN) continue;
        int code = take(argc, argv, &at, arguments);
        if (code != EXIT_DONE) return code;
    }
    struct scree_error error = {0};
    if (!raster_arguments_check(&arguments->raster, &error)) return usage(error.text, "");
    if (arguments->raster.input_count == 0) return usage("which DEM? Name one raster or several", "");
    if (arguments->output == NULL) return usage("-o names the mesh to write", "");
    if (!mesh_file_is_known(arguments->output))
        return usage("meshes are written as .ply, .obj, .stl or .off, not ", arguments->output);
    if (arguments->reach_m > 0 && !arguments->has_observer) return usage("--reach goes with an --observer", "");
    arguments->raster.inputs = arguments->inputs;
    return EXIT_DONE;
}

/* ---- the work ---- */

struct job {
    struct scree_memory memory;
    struct remesh_raster raster;
    struct quadtree tree;
    struct quadtree_view view;
    struct quadtree_mesh made;
    struct extract_mesh placed;
    struct remesh_error measured;
};

static void set_view(const struct arguments *arguments, struct job *job) {
    const struct lattice *local = &job->raster.local;
    const struct curvature_posts *posts = &job->raster.posts;
    job->view = (struct quadtree_view){.threshold = arguments->threshold, .has_observer = arguments->has_observer};
    if (!arguments->has_observer) return;
    job->view.x = (arguments->observer[0] - local->west) / local->spacing_x;
    job->view.y = (arguments->observer[1] - local->south) / local->spacing_y;
    job->view.height_m = arguments->observer[2];
    job->view.reach_m = arguments->reach_m;
    if (job->view.reach_m <= 0) job->view.reach_m = DEFAULT_REACH_POSTS * sqrt(posts->east_m * posts->north_m);
}

static void tell(const struct arguments *arguments, const struct job *job, const double middle[2]) {
    const struct curvature_posts *posts = &job->raster.posts;
    const struct scree_mesh *mesh = &job->made.mesh;
    const struct extract_mesh *placed = &job->placed;
    const struct remesh_error *measured = &job->measured;
    const double all = 2.0 * (posts->columns - 1) * (posts->rows - 1);
    printf("%s: %u vertices, %u triangles, %.3g %% of the full grid's; max error %.4g m, RMS %.4g m\n",
           arguments->output, (unsigned)mesh->vertex_count, (unsigned)mesh->triangle_count,
           100 * mesh->triangle_count / all, measured->max_m, measured->rms_m);
    if (job->view.has_observer)
        printf("as the observer sees it: max error %.4g mrad, RMS %.4g mrad\n", MRAD * measured->max_rad,
               MRAD * measured->rms_rad);
    if (job->raster.lattice.profile == PROFILE_GEODETIC)
        printf("in metres east, north and up of %.8g, %.8g\n", middle[0], middle[1]);
    else
        printf("in metres of height over x and y of the raster's CRS\n");
    if (placed->origin[0] != 0 || placed->origin[1] != 0 || placed->origin[2] != 0)
        printf("add %.0f, %.0f, %.0f to its coordinates, which are too large for the floats of such files\n",
               placed->origin[0], placed->origin[1], placed->origin[2]);
}

static enum scree_status remesh(const struct arguments *arguments, struct job *job, struct scree_error *error) {
    const struct remesh_raster *raster = &job->raster;
    double middle[2];
    enum scree_status status = remesh_read(&job->memory, &arguments->raster, &job->raster, error);
    if (status == SCREE_OK) status = quadtree_make(&job->memory, &raster->posts, &job->tree, error);
    if (status != SCREE_OK) return status;
    set_view(arguments, job);
    status = quadtree_extract(&job->memory, &job->tree, &job->view, &job->made, error);
    if (status == SCREE_OK && !arguments->quiet)
        status = remesh_measure(&job->memory, &raster->posts, &job->made.mesh, &job->view, &job->measured, error);
    if (status == SCREE_OK)
        status =
            remesh_place(&job->memory, &raster->lattice, &raster->posts, &job->made.mesh, &job->placed, middle, error);
    if (status == SCREE_OK)
        status = mesh_file_write(arguments->output, job->placed.xyz, job->placed.vertex_count, job->placed.corners,
                                 job->placed.triangle_count, error);
    if (status == SCREE_OK && !arguments->quiet) tell(arguments, job, middle);
    return status;
}

static int run(const struct arguments *arguments) {
    struct scree_error error = {0};
    struct job job = {0};
    enum scree_status status = remesh(arguments, &job, &error);
    extract_mesh_free(&job.memory, &job.placed);
    quadtree_mesh_release(&job.memory, &job.made);
    quadtree_release(&job.memory, &job.tree);
    remesh_raster_free(&job.memory, &job.raster);
    if (status == SCREE_OK) return EXIT_DONE;
    fprintf(stderr, "scree remesh: %s\n", error.text);
    return EXIT_FAILED;
}

int command_remesh(int argc, char **argv) {
    struct arguments arguments = {.raster = {.profile = PROFILE_LOCAL}, .threshold = DEFAULT_THRESHOLD};
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return fputs(help, stdout) < 0 ? EXIT_FAILED : EXIT_DONE;
    if ((arguments.inputs = calloc((size_t)argc, sizeof *arguments.inputs)) == NULL) {
        fprintf(stderr, "scree remesh: no memory for the arguments\n");
        return EXIT_FAILED;
    }
    int code = parse(argc, argv, &arguments);
    if (code == EXIT_DONE) code = run(&arguments);
    free(arguments.inputs);
    return code;
}
