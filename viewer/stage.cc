#include "viewer/stage.h"

#include "viewer/camera_place.h"
#include "viewer/view_window.h"

#include <algorithm>
#include <cmath>
#include <osg/CoordinateSystemNode>
#include <osg/Math>
#include <osgGA/OrbitManipulator>
#include <osgGA/TerrainManipulator>
#include <osgGA/TrackballManipulator>

static const double FIELD_OF_VIEW_DEG = 45; // from the picture's bottom to its top

Stage::Stage(osg::ref_ptr<TerrainNode> terrain, const ViewArguments &arguments)
    : terrain(terrain), hud("Keys\n\n" + keys_help()), arguments(arguments) {
    const double aspect = (double)arguments.width_px / arguments.height_px;
    home_camera = arguments.has_camera ? ::camera_to_world(terrain->world(), arguments.camera)
                                       : overview(terrain->world(), FIELD_OF_VIEW_DEG, aspect, arguments.orthogonal);
    placed = home_camera;
    build_scene();
    keys = new Keys(terrain.get(), scene.get(), &hud, arguments.wireframe);
}

void Stage::build_scene() {
    // What asks for the way up, as manipulators do, finds it in this node.
    if (terrain->world().is_geodetic()) {
        osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode;
        globe->setEllipsoidModel(new osg::EllipsoidModel);
        scene = globe;
    } else {
        scene = new osg::Group;
    }
    scene->addChild(terrain);
}

void Stage::add_manipulators() {
    osg::ref_ptr<osgGA::KeySwitchMatrixManipulator> manipulators = new osgGA::KeySwitchMatrixManipulator;
    manipulators->addMatrixManipulator('1', "terrain", new osgGA::TerrainManipulator);
    manipulators->addMatrixManipulator('2', "trackball", new osgGA::TrackballManipulator);
    const double depth_m = depth_of_view(terrain->world(), home_camera);
    const osg::Vec3d eye = home_camera.getTrans();
    manipulators->setHomePosition(eye, osg::Vec3d(0, 0, -depth_m) * home_camera,
                                  osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), home_camera));
    for (auto &key : manipulators->getKeyManipMap()) {
        auto *manipulator = static_cast<osgGA::OrbitManipulator *>(key.second.second.get());
        manipulator->setMinimumDistance(1e-6, true);
        manipulator->setAllowThrow(false);
    }
    viewer.setCameraManipulator(manipulators);
}

bool Stage::open(std::string *error) {
    if (!open_window(arguments, frame_end, &viewer, error)) return false;
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scene);
    if (!arguments.is_off_screen()) {
        root->addChild(hud.camera());
        viewer.addEventHandler(keys);
    }
    viewer.setSceneData(root);
    if (!arguments.is_off_screen()) add_manipulators();
    viewer.realize();
    if (!arguments.is_off_screen()) viewer.getCameraManipulator()->home(0);
    return true;
}

void Stage::place_camera() {
    osg::Camera *camera = viewer.getCamera();
    const double width = camera->getViewport()->width(), height = camera->getViewport()->height();
    const double slope = tan(osg::DegreesToRadians(FIELD_OF_VIEW_DEG) / 2), aspect = width / std::max(height, 1.0);
    hud.resize(width, height);
    const double depth_m = depth_of_view(terrain->world(), placed), far_m = depth_m + 2 * terrain->world().radius_m();
    if (arguments.orthogonal) {
        // Nothing changes in the picture when the camera goes back; far enough for nothing to be behind it.
        camera->setViewMatrix(osg::Matrixd::inverse(osg::Matrixd::translate(0, 0, far_m) * placed));
        camera->setProjectionMatrixAsOrtho(-slope * aspect * depth_m, slope * aspect * depth_m, -slope * depth_m,
                                           slope * depth_m, 1, 2 * far_m);
    } else {
        camera->setViewMatrix(osg::Matrixd::inverse(placed));
        camera->setProjectionMatrixAsPerspective(FIELD_OF_VIEW_DEG, aspect, far_m * 1e-5, far_m);
    }
}

void Stage::draw(const osg::Matrixd *camera, const std::string &figures, const std::string &note) {
    osgGA::CameraManipulator *manipulator = viewer.getCameraManipulator();
    viewer.advance();
    if (camera != nullptr && manipulator != nullptr) manipulator->setByMatrix(*camera);
    if (!arguments.is_off_screen()) viewer.eventTraversal();
    viewer.updateTraversal();
    if (camera != nullptr)
        placed = *camera;
    else if (manipulator != nullptr)
        placed = manipulator->getMatrix();
    place_camera();
    hud.update(figures, note);
    viewer.renderingTraversals();
}
