#include "viewer/run_quadtree.h"

#include "viewer/camera_path.h"
#include "viewer/camera_place.h"
#include "viewer/flight.h"
#include "viewer/frame_log_io.h"
#include "viewer/hud.h"
#include "viewer/quadtree_node.h"
#include "viewer/screenshot_io.h"
#include "viewer/view_window.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <osg/PolygonMode>
#include <osgGA/OrbitManipulator>
#include <osgGA/TerrainManipulator>
#include <osgViewer/Viewer>

namespace {

const double FIELD_OF_VIEW_DEG = 45;         // from the picture's bottom to its top
const double TOUR_S = 60, TOUR_FRAMES = 200; // --benchmark without a flight, or frames, of its own
const double LEAST_THRESHOLD = 1e-3, MOST_THRESHOLD = 1e6;

// What keys switch.
class QuadtreeKeys : public osgGA::GUIEventHandler {
  public:
    QuadtreeKeys(osg::Group *scene, const ViewArguments &arguments)
        : threshold(arguments.threshold), hud("Keys\n\n" + quadtree_keys_help()), scene(scene),
          is_wireframe(arguments.wireframe) {
        switch_wireframe();
    }

    bool handle(const osgGA::GUIEventAdapter &event, osgGA::GUIActionAdapter &) override {
        if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
        switch (event.getKey()) {
        case '+':
        case '=':
        case osgGA::GUIEventAdapter::KEY_KP_Add: threshold = std::min(threshold * std::sqrt(2), MOST_THRESHOLD); break;
        case '-':
        case osgGA::GUIEventAdapter::KEY_KP_Subtract:
            threshold = std::max(threshold / std::sqrt(2), LEAST_THRESHOLD);
            break;
        case 'f': is_frozen = !is_frozen; break;
        case 'h': hud.show_help(!hud.shows_help()); break;
        case 'i': hud.show_figures(!hud.shows_figures()); break;
        case 'w':
            is_wireframe = !is_wireframe;
            switch_wireframe();
            break;
        default: return false;
        }
        return true;
    }

    double threshold;
    bool is_frozen = false;
    Hud hud;

  private:
    void switch_wireframe() {
        const osg::PolygonMode::Mode mode = is_wireframe ? osg::PolygonMode::LINE : osg::PolygonMode::FILL;
        scene->getOrCreateStateSet()->setAttributeAndModes(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, mode));
    }

    osg::Group *scene;
    bool is_wireframe;
};

class QuadtreeStage {
  public:
    QuadtreeStage(osg::ref_ptr<QuadtreeNode> terrain, const ViewArguments &arguments)
        : terrain(terrain), arguments(arguments), scene(new osg::Group) {
        const double aspect = (double)arguments.width_px / arguments.height_px;
        scene->addChild(terrain);
        home = arguments.has_camera ? camera_to_world(terrain->world(), arguments.camera)
                                    : overview(terrain->world(), FIELD_OF_VIEW_DEG, aspect, false);
        keys = new QuadtreeKeys(scene.get(), arguments);
    }

    bool open(std::string *error);
    bool run_window(std::string *error);
    bool run_screenshot(std::string *error);
    bool run_flight(std::string *error);

  private:
    bool draw(const osg::Matrixd *camera, std::string *error);
    bool take_picture(const osg::Matrixd &camera, const std::string &path, std::string *error);
    std::string figures() const;

    osg::ref_ptr<QuadtreeNode> terrain;
    const ViewArguments &arguments;
    osg::ref_ptr<osg::Group> scene;
    osg::ref_ptr<QuadtreeKeys> keys;
    osg::ref_ptr<FrameEnd> frame_end = new FrameEnd;
    osgViewer::Viewer viewer;
    osg::Matrixd home;
};

bool QuadtreeStage::open(std::string *error) {
    const bool is_off_screen = arguments.is_off_screen();
    if (!open_window(arguments, frame_end, &viewer, error)) return false;
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);
    if (!is_off_screen) {
        osg::ref_ptr<osgGA::TerrainManipulator> manipulator = new osgGA::TerrainManipulator;
        const double depth_m = depth_of_view(terrain->world(), home);
        manipulator->setHomePosition(home.getTrans(), osg::Vec3d(0, 0, -depth_m) * home,
                                     osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), home));
        manipulator->setMinimumDistance(1e-6, true);
        manipulator->setAllowThrow(false);
        root->addChild(keys->hud.camera());
        viewer.addEventHandler(keys);
        viewer.setCameraManipulator(manipulator);
    }
    if (!terrain->follow(home.getTrans(), keys->threshold, error)) return false;
    viewer.setSceneData(root);
    viewer.realize();
    if (!is_off_screen) viewer.getCameraManipulator()->home(0);
    return true;
}

std::string QuadtreeStage::figures() const {
    const QuadtreeFigures &now = terrain->figures();
    char text[256];
    snprintf(text, sizeof text,
             "threshold %.3g%s\n%u triangles, %.3g %% of the full grid's\nmesh %.1f ms, arrays %.1f ms",
             keys->threshold, keys->is_frozen ? ", frozen" : "", now.triangles,
             100.0 * now.triangles / now.all_triangles, now.extract_ms, now.fill_ms);
    return text;
}

// `camera`: camera to world; null: as the manipulator has it.
bool QuadtreeStage::draw(const osg::Matrixd *camera, std::string *error) {
    osg::Camera *own = viewer.getCamera();
    const double width = own->getViewport()->width(), height = own->getViewport()->height();
    viewer.advance();
    if (!arguments.is_off_screen()) viewer.eventTraversal();
    const osg::Matrixd placed = camera != nullptr ? *camera : viewer.getCameraManipulator()->getMatrix();
    if (!keys->is_frozen && !terrain->follow(placed.getTrans(), keys->threshold, error)) return false;
    viewer.updateTraversal();
    const double far_m = depth_of_view(terrain->world(), placed) + 2 * terrain->world().radius_m();
    own->setViewMatrix(osg::Matrixd::inverse(placed));
    own->setProjectionMatrixAsPerspective(FIELD_OF_VIEW_DEG, width / std::max(height, 1.0), far_m * 1e-5, far_m);
    keys->hud.resize(width, height);
    keys->hud.update(figures(), "");
    viewer.renderingTraversals();
    return true;
}

bool QuadtreeStage::run_window(std::string *error) {
    while (!viewer.done())
        if (!draw(nullptr, error)) return false;
    return true;
}

bool QuadtreeStage::take_picture(const osg::Matrixd &camera, const std::string &path, std::string *error) {
    frame_end->want_picture();
    return draw(&camera, error) && write_png(*frame_end->picture(), path, error);
}

bool QuadtreeStage::run_screenshot(std::string *error) {
    return take_picture(home, arguments.screenshot, error);
}

// Off screen, frame by frame.
bool QuadtreeStage::run_flight(std::string *error) {
    CameraPath path(terrain->world().knows_longitudes());
    if (arguments.fly.empty())
        path = tour(terrain->world(), home, TOUR_S);
    else if (!read_camera_path(arguments.fly, &path, error))
        return false;
    if (!arguments.pictures.empty() && !make_folder(arguments.pictures, error)) return false;
    const unsigned frames = arguments.frames > 0 ? arguments.frames : (unsigned)TOUR_FRAMES;
    double extract_ms = 0, worst_ms = 0, fill_ms = 0, triangles = 0;
    for (unsigned i = 0; i < frames; i++) {
        const double time_s = path.begin_s() + (path.end_s() - path.begin_s()) * i / std::max(frames - 1, 1u);
        const osg::Matrixd camera = camera_to_world(terrain->world(), path.at(time_s));
        char name[32];
        snprintf(name, sizeof name, "/frame-%06u.png", i);
        const bool is_pictured = !arguments.pictures.empty() && i % arguments.picture_every_frames == 0;
        if (!(is_pictured ? take_picture(camera, arguments.pictures + name, error) : draw(&camera, error)))
            return false;
        const QuadtreeFigures &now = terrain->figures();
        extract_ms += now.extract_ms / frames;
        worst_ms = std::max(worst_ms, now.extract_ms);
        fill_ms += now.fill_ms / frames;
        triangles += (double)now.triangles / frames;
    }
    if (arguments.benchmark)
        printf("frames     %u\ntriangles  %.0f, %.3g %% of the full grid's\nmesh       %.2f ms of CPU time, at most "
               "%.2f\narrays     %.2f ms\n",
               frames, triangles, 100 * triangles / terrain->figures().all_triangles, extract_ms, worst_ms, fill_ms);
    return true;
}

} // namespace

bool run_quadtree(const ViewArguments &arguments, std::string *error) {
    osg::ref_ptr<QuadtreeNode> terrain = QuadtreeNode::open(arguments.quadtree, error);
    if (!terrain.valid()) return false;
    QuadtreeStage stage(terrain, arguments);
    if (!stage.open(error)) return false;
    if (!arguments.screenshot.empty()) return stage.run_screenshot(error);
    return arguments.is_off_screen() ? stage.run_flight(error) : stage.run_window(error);
}

std::string quadtree_keys_help() {
    return "  h       this help\n"
           "  i       figures in the corner\n"
           "  w       wireframe\n"
           "  + -     a larger or smaller threshold: coarser, finer\n"
           "  f       freeze the mesh, to look at it from elsewhere\n"
           "  space   the overview\n"
           "  Esc     end\n";
}
