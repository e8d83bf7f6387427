// The parts of scree-view that need no picture: arguments, camera paths, cameras on the globe and on a plane.
// Prints what is wrong; exit code 1 then.
#include "viewer/camera_path.h"
#include "viewer/flight.h"
#include "viewer/frame_summary.h"
#include "viewer/view_arguments.h"

#include <cmath>
#include <cstdio>
#include <osg/Math>

namespace {

int failures = 0, checks = 0;

void check(bool is_fine, const char *what, int line) {
    checks++;
    if (is_fine) return;
    failures++;
    printf("line %d: not so: %s\n", line, what);
}
#define CHECK(what) check(what, #what, __LINE__)

bool near(double a, double b, double least) {
    return fabs(a - b) <= least;
}

// ---- arguments ----

bool parse(const std::vector<std::string> &words, ViewArguments *arguments, std::string *error) {
    error->clear();
    const bool is_fine = parse_view_arguments(words, arguments, error);
    CHECK(is_fine == error->empty());
    CHECK(error->find('\n') == std::string::npos);
    return is_fine;
}

void test_arguments() {
    ViewArguments all;
    std::string error;
    CHECK(parse({"out"}, &all, &error) && all.terrain == "out" && !all.is_off_screen());
    CHECK(all.options.settings.tolerance_px == 1 && all.width_px == 1280 && all.height_px == 800);
    CHECK(parse({"--tolerance", "2.5", "out", "--mode=error", "--size", "64x48", "--no-morph", "--no-stitch"}, &all,
                &error));
    CHECK(all.options.settings.tolerance_px == 2.5 && all.options.settings.measure == SCREE_BY_MAX_ERROR);
    CHECK(all.width_px == 64 && all.height_px == 48);
    CHECK(!all.options.settings.morph && !all.options.settings.stitch);
    CHECK(parse({"out", "--camera=-84.5,36,1200,270,-12.5", "--screenshot", "a.png", "--background", "ff00FF"}, &all,
                &error));
    CHECK(all.has_camera && all.camera.lon_deg == -84.5 && all.camera.heading_deg == 270);
    CHECK(all.camera.pitch_deg == -12.5 && all.background == 0xff00ff && all.is_off_screen());
    CHECK(parse({"out", "--camera", "-84.5,36,1200,270,-12.5"}, &all, &error));
    CHECK(parse({"out", "--memory", "64", "--triangles", "5000", "--glsl", "120", "--colour", "rung"}, &all, &error));
    CHECK(all.options.settings.memory_bytes == (uint64_t)64 << 20 && all.options.settings.triangle_budget == 5000);
    CHECK(all.options.glsl == 120 && all.options.settings.colour == TerrainColour::RUNG);
    CHECK(parse({"--contours", "out"}, &all, &error) && all.options.settings.contours && all.terrain == "out");
    CHECK(parse({"--contours=20", "out"}, &all, &error) && all.options.settings.contour_m == 20);
    CHECK(parse({"out", "--texture", "map.tif"}, &all, &error));
    CHECK(all.options.settings.colour == TerrainColour::TEXTURE && all.options.texture == "map.tif");
    CHECK(parse({"--help"}, &all, &error) && all.help);
    const std::vector<std::vector<std::string>> wrong = {
        {},
        {"a", "b"},
        {"out", "--nothing"},
        {"out", "--tolerance"},
        {"out", "--tolerance", "-1"},
        {"out", "--tolerance", "1px"},
        {"out", "--tolerance="},
        {"out", "--tolerance", "nan"},
        {"out", "--mode", "best"},
        {"out", "--size", "640"},
        {"out", "--size", "640x0"},
        {"out", "--size", "1e9x10"},
        {"out", "--background", "12345"},
        {"out", "--background", "12345g"},
        {"out", "--camera", "1,2,3,4"},
        {"out", "--camera", "1,2,3,4,5,6"},
        {"out", "--camera", "1,2,3,4,91"},
        {"out", "--camera", "1,2,inf,4,5"},
        {"out", "--no-morph=yes"},
        {"out", "--glsl", "450"},
        {"out", "--frames", "10"},
        {"out", "--frames", "1.5", "--benchmark"},
        {"out", "--screenshot", "a.png", "--benchmark"},
        {"out", "--screenshot", ""},
        {"out", "--pictures", "dir"},
        {"out", "--record", "a.txt", "--benchmark"},
        {"out", "--colour", "texture"},
    };
    for (const auto &words : wrong) {
        const bool is_taken = parse(words, &all, &error);
        if (is_taken) printf("taken: %s\n", words.back().c_str());
        CHECK(!is_taken);
    }
    const std::string help = view_options_help();
    for (const char *name : {"--tolerance PX", "--contours[=M]", "--no-stitch", "--trace-tiles FILE.csv"})
        CHECK(help.find(name) != std::string::npos);
}

// ---- camera paths ----

void test_path_text() {
    CameraPath path;
    std::string error;
    CHECK(path.parse("# a comment\n0 -84 36 900 10 -20 # the first\n\n2.5 -83 37 500 350 -90\r\n", &error));
    CHECK(path.begin_s() == 0 && path.end_s() == 2.5);
    CameraPath again;
    CHECK(again.parse(path.text(), &error));
    CHECK(again.text() == path.text());
    for (const char *text : {"", "# nothing\n", "0 1 2 3 4\n", "0 1 2 3 4 5 6\n", "0 1 2 x 4 5\n", "0 1 2 nan 4 5\n",
                             "0 1 2 3 4 91\n", "1 1 2 3 4 5\n1 1 2 3 4 5\n", "2 1 2 3 4 5\n1 1 2 3 4 5\n"}) {
        CameraPath wrong;
        error.clear();
        CHECK(!wrong.parse(text, &error) && !error.empty());
    }
}

void test_path_between() {
    CameraPath path;
    const double heights_m[] = {5000, 5000, 300, 250, 4000};
    for (int i = 0; i < 5; i++) path.add(i, {i * 0.5, 40 + i * i * 0.1, heights_m[i], 350 + 20.0 * i, -80.0 + 15 * i});
    for (int i = 0; i < 5; i++) {
        const CameraPlace place = path.at(i);
        CHECK(near(place.lon_deg, i * 0.5, 1e-12) && near(place.height_m, heights_m[i], 1e-9));
        CHECK(near(remainder(place.heading_deg - (350 + 20.0 * i), 360), 0, 1e-9));
    }
    // Outside it stands still.
    CHECK(path.at(-1).height_m == 5000 && path.at(9).height_m == 4000);
    // A straight line stays one; heights stay between their neighbours; the speed never jumps.
    double speed_before = NAN;
    for (double time_s = 0.001; time_s < 4; time_s += 0.001) {
        const CameraPlace place = path.at(time_s), before = path.at(time_s - 0.001);
        const double low_m = fmin(heights_m[(int)time_s], heights_m[(int)time_s + 1]);
        const double high_m = fmax(heights_m[(int)time_s], heights_m[(int)time_s + 1]);
        CHECK(near(place.lon_deg, 0.5 * time_s, 1e-9));
        CHECK(place.height_m >= low_m - 1e-6 && place.height_m <= high_m + 1e-6);
        const double speed = (place.lat_deg - before.lat_deg) / 0.001;
        CHECK(std::isnan(speed_before) || near(speed, speed_before, 0.003));
        speed_before = speed;
    }
}

void test_path_the_shorter_way() {
    CameraPath path;
    path.add(0, {179, 0, 0, 350, 0});
    path.add(1, {-179, 0, 0, 10, 0});
    CHECK(near(fabs(path.at(0.5).lon_deg), 180, 1e-9));
    CHECK(near(remainder(path.at(0.5).heading_deg, 360), 0, 1e-9));
    path.add(1, {0, 0, 0, 0, 0}); // time stands still: left out
    CHECK(path.end_s() == 1);
    CameraPath plane(false);
    plane.add(0, {-400, 0, 0, 0, 0});
    plane.add(1, {400, 0, 0, 0, 0});
    CHECK(near(plane.at(0.5).lon_deg, 0, 1e-9));
}

// ---- cameras ----

scree_terrain terrain_of(scree_profile profile) {
    scree_terrain terrain = {};
    terrain.profile = profile;
    terrain.lowest_m = 100;
    terrain.highest_m = 900;
    terrain.spacing_x = terrain.spacing_y = 30;
    terrain.metres_x = terrain.metres_y = 30;
    return terrain;
}

void test_camera(const TerrainWorld &world) {
    const double *bounds = world.bounds();
    for (double heading_deg : {0.0, 33.0, 270.0})
        for (double pitch_deg : {-90.0, -89.0, -20.0, 0.0, 45.0}) {
            const CameraPlace place = {bounds[0] + 0.3 * (bounds[2] - bounds[0]), bounds[1] + 1, 700, heading_deg,
                                       pitch_deg};
            const CameraPlace found = place_of_camera(world, camera_to_world(world, place));
            CHECK(near(found.lon_deg, place.lon_deg, 1e-7) && near(found.lat_deg, place.lat_deg, 1e-7));
            CHECK(near(found.height_m, 700, 1e-4) && near(found.pitch_deg, pitch_deg, 1e-5));
            CHECK(near(remainder(found.heading_deg - heading_deg, 360), 0, 1e-4));
        }
}

// Every corner of the data is in the picture, one of them near its border, and north is up.
void test_overview(const TerrainWorld &world, double width_by_height, bool is_orthogonal) {
    const osg::Matrixd camera = overview(world, 45, width_by_height, is_orthogonal);
    const osg::Matrixd to_camera = osg::Matrixd::inverse(camera);
    const double slope = tan(osg::DegreesToRadians(22.5)), *bounds = world.bounds();
    const double depth_m = -(middle_on_ground(world) * to_camera).z();
    double outmost = 0;
    for (int corner = 0; corner < 8; corner++) {
        const double x = bounds[corner & 1 ? 2 : 0], y = bounds[corner & 2 ? 3 : 1];
        const double height_m = corner & 4 ? world.highest_m() : world.lowest_m();
        const osg::Vec3d seen = world.place(x, y, height_m) * to_camera;
        const double depth = is_orthogonal ? depth_m : -seen.z();
        CHECK(depth > 0);
        outmost = fmax(outmost, fmax(fabs(seen.x()) / width_by_height, fabs(seen.y())) / (slope * depth));
    }
    CHECK(outmost < 1 && outmost > 0.9);
    const double north = (world.place(bounds[0], bounds[3], 0) * to_camera).y();
    CHECK(north > (world.place(bounds[0], bounds[1], 0) * to_camera).y());
}

void test_cameras() {
    const double patch[4] = {-85, 36, -84, 37}, plane[4] = {400000, 3800000, 412000, 3812000};
    TerrainWorld globe(terrain_of(SCREE_GEODETIC), "", patch), local(terrain_of(SCREE_LOCAL), "", plane);
    for (TerrainWorld *world : {&globe, &local}) {
        world->set_heights(100, 900);
        test_camera(*world);
        for (double width_by_height : {0.5, 1.0, 2.0}) {
            test_overview(*world, width_by_height, false);
            test_overview(*world, width_by_height, true);
        }
        const osg::Matrixd home = overview(*world, 45, 1.6, false);
        const CameraPath around = tour(*world, home, 60);
        CHECK(around.end_s() == 60 && near(around.at(0).height_m, around.at(60).height_m, 1));
        CHECK(around.at(30).height_m < around.at(0).height_m / 3 && around.at(30).height_m > 900);
    }
    // Straight down from 4500 m above the middle of the heights.
    const osg::Matrixd down = camera_to_world(local, {406000, 3806000, 5000, 0, -90});
    CHECK(near(depth_of_view(local, down), 4500, 1e-6));
    CHECK(near(depth_of_view(globe, camera_to_world(globe, {-84.5, 36.5, 5000, 0, -90})), 4500, 15));
    CHECK(depth_of_view(globe, camera_to_world(globe, {-84.5, 36.5, 5000, 0, 30})) > 0);
}

void test_play() {
    Flight flight;
    flight.play_s = 10;
    flight.range_m = {1, 64};
    CHECK(near(flight.manual_svo_m(0), 64, 1e-9) && near(flight.manual_svo_m(10), 64, 1e-9));
    CHECK(near(flight.manual_svo_m(5), 1, 1e-9) && near(flight.manual_svo_m(2.5), 8, 1e-9));
    CHECK(flight.begin_s() == 0 && flight.end_s() == 10);
}

void test_summary() {
    std::vector<Frame> frames(100);
    for (int i = 0; i < 100; i++) {
        frames[(size_t)i].frame_ms = 1 + i;
        frames[(size_t)i].figures.select_ms = 0.5;
        frames[(size_t)i].figures.splits = 3;
    }
    const std::string text = frame_summary(frames, 5000000);
    CHECK(text.find("min 1.00, median 50.00, p99 99.00, max 100.00 ms") != std::string::npos);
    CHECK(text.find("0.99 % of the frames") != std::string::npos);
    CHECK(text.find("splits             300, in one frame at most 3") != std::string::npos);
    CHECK(text.find("the process 5.0 MB") != std::string::npos);
    CHECK(!frame_summary({}, 0).empty());
}

} // namespace

int main() {
    test_arguments();
    test_path_text();
    test_path_between();
    test_path_the_shorter_way();
    test_cameras();
    test_play();
    test_summary();
    printf("%d checks, %d failed\n", checks, failures);
    return failures == 0 ? 0 : 1;
}
