/* bench_build: what a whole `scree build` costs, on fractal rasters of growing size: posts a second a core (from CPU
 * time), wall time with one thread and with two, peak memory, and how time grows with the number of posts; and the same
 * of a million lidar points that are kept as a TIN, from file to streams.
 *
 * Run it where the programs are (it starts ./scree, tests/fractal_dem and tests/fractal_las) and where there is room on
 * the disk: it works in a folder of its own, which it removes. SCREE_BENCH_SIZES="2048 4096 20000" overrules the sizes.
 */
#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

#define TARGET_POSTS_PER_CPU_S 600000.0
#define TARGET_SPEEDUP         1.8
#define TARGET_PEAK_MB         300.0
#define TARGET_POINTS_WALL_S   20.0

struct cost {
    double wall_s, cpu_s, peak_mb;
};

static double wall_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double seconds_of(struct timeval time) {
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

/* Runs a program to its end; false, with a line, unless it exits with 0. Its standard output is not shown. */
static bool run(const char *const arguments[], struct cost *cost) {
    pid_t child;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    double start_s = wall_seconds();
    int failure = posix_spawnp(&child, arguments[0], &actions, NULL, (char *const *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        fprintf(stderr, "bench_build: %s: %s\n", arguments[0], strerror(failure));
        return false;
    }
    int status = 0;
    struct rusage usage;
    if (wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        fprintf(stderr, "bench_build: %s %s did not succeed\n", arguments[0], arguments[1]);
        return false;
    }
    cost->wall_s = wall_seconds() - start_s;
    cost->cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    cost->peak_mb = (double)usage.ru_maxrss / 1024; /* Linux counts in KiB */
    return true;
}

static bool make_raster(const char *path, const char *size, bool geodetic) {
    struct cost cost;
    const char *local[] = {"tests/fractal_dem", "-o", path, "--size", size, "--epsg", "32611", NULL};
    const char *global[] = {"tests/fractal_dem", "-o", path, "--size", size, NULL};
    return run(geodetic ? global : local, &cost);
}

/* What is built: static tiles alone, or the default, which walks the finest zoom down from finer rungs. */
struct task {
    const char *raster, *out;
    bool geodetic, with_streams;
};

static bool build(const struct task *task, const char *threads, struct cost *cost) {
    struct cost ignored;
    const char *clear[] = {"rm", "-rf", task->out, NULL};
    const char *arguments[] = {"./scree",
                               "build",
                               task->raster,
                               "-o",
                               task->out,
                               "-q",
                               "-j",
                               threads,
                               "--profile",
                               task->geodetic ? "geodetic" : "local",
                               "--products",
                               task->with_streams ? "terrain,stream" : "terrain",
                               "--finest-octaves",
                               task->with_streams ? "2" : "0",
                               NULL};
    return run(clear, &ignored) && run(arguments, cost) && run(clear, &ignored);
}

static void print_cost(const struct task *task, const char *size, int threads, double posts, const struct cost *cost) {
    printf("%6s^2 %-9s %-8s %d %9.2f %9.2f %12.0f %8.0f\n", size, task->geodetic ? "geodetic" : "local",
           task->with_streams ? "both" : "terrain", threads, cost->wall_s, cost->cpu_s, posts / cost->cpu_s,
           cost->peak_mb);
}

/* Builds one raster with one thread and with two, and prints a line for each. */
static bool bench_task(const struct task *task, const char *size, double *cpu_s_per_post) {
    double posts = strtod(size, NULL) * strtod(size, NULL);
    struct cost one, two;
    if (!build(task, "1", &one) || !build(task, "2", &two)) return false;
    print_cost(task, size, 1, posts, &one);
    print_cost(task, size, 2, posts, &two);
    printf("          %.2f x with two threads\n", one.wall_s / two.wall_s);
    if (!task->with_streams && posts / one.cpu_s < TARGET_POSTS_PER_CPU_S)
        printf("missed: at least %.0f posts a second\n", TARGET_POSTS_PER_CPU_S);
    if (one.wall_s / two.wall_s < TARGET_SPEEDUP) printf("missed: at least %.1f x with two threads\n", TARGET_SPEEDUP);
    if (one.peak_mb > TARGET_PEAK_MB || two.peak_mb > TARGET_PEAK_MB)
        printf("missed: at most %.0f MB of memory\n", TARGET_PEAK_MB);
    fflush(stdout);
    *cpu_s_per_post = one.cpu_s / posts;
    return true;
}

/* Static tiles alone, then both products; the time a post is that of the former. */
static bool bench_size(const char *folder, const char *size, bool geodetic, double *cpu_s_per_post) {
    char raster[256], out[256];
    double ignored;
    snprintf(raster, sizeof raster, "%s/fractal.tif", folder);
    snprintf(out, sizeof out, "%s/out", folder);
    const struct task terrain = {raster, out, geodetic, false}, both = {raster, out, geodetic, true};
    return make_raster(raster, size, geodetic) && bench_task(&terrain, size, cpu_s_per_post) &&
           bench_task(&both, size, &ignored);
}

/* Three of four points are on the ground. */
static bool bench_points(const char *folder) {
    char cloud[256], out[256];
    struct cost cost;
    snprintf(cloud, sizeof cloud, "%s/fractal.las", folder);
    snprintf(out, sizeof out, "%s/out", folder);
    const char *make[] = {"tests/fractal_las", "-o", cloud, "--points", "1333333", "--spacing-m", "1", NULL};
    if (!run(make, &cost)) return false;
    printf(" points                    j    wall s     CPU s  points/CPU s peak MB\n");
    for (int threads = 1; threads <= 2; threads++) {
        const char *build[] = {"./scree",   "build", cloud, "--class",    "2",      "-o", out,
                               "--profile", "local", "-q",  "--products", "stream", "-j", threads == 1 ? "1" : "2",
                               NULL};
        if (!run(build, &cost)) return false;
        printf("1000000 as a TIN, streams  %d %9.2f %9.2f %12.0f %8.0f\n", threads, cost.wall_s, cost.cpu_s,
               1e6 / cost.cpu_s, cost.peak_mb);
    }
    if (cost.wall_s > TARGET_POINTS_WALL_S)
        printf("missed: a million points in at most %.0f s with two threads\n", TARGET_POINTS_WALL_S);
    return true;
}

static bool bench_all(const char *folder) {
    const char *wanted = getenv("SCREE_BENCH_SIZES");
    char sizes[256];
    snprintf(sizes, sizeof sizes, "%s", wanted != NULL ? wanted : "2048 4096");
    printf("  posts   profile products j    wall s     CPU s  posts/CPU s  peak MB\n");
    double first = 0, now;
    char *rest = NULL;
    for (char *size = strtok_r(sizes, " ", &rest); size != NULL; size = strtok_r(NULL, " ", &rest)) {
        if (!bench_size(folder, size, false, &now)) return false;
        if (first == 0) first = now;
        printf("          CPU time a post: %.2f x that of the first size\n", now / first);
    }
    return bench_size(folder, "2048", true, &now) && bench_points(folder);
}

int main(void) {
    char folder[] = "bench_build_XXXXXX";
    struct cost ignored;
    if (mkdtemp(folder) == NULL) {
        perror("bench_build: a folder to work in");
        return 1;
    }
    bool fine = bench_all(folder);
    const char *clear[] = {"rm", "-rf", folder, NULL};
    run(clear, &ignored);
    return fine ? 0 : 1;
}
