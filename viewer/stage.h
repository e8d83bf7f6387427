// Terrain, light, sky, camera, manipulators and HUD in one viewer of OpenSceneGraph; draws a frame at a time.
#ifndef SCREE_VIEWER_STAGE_H
#define SCREE_VIEWER_STAGE_H

#include "viewer/hud.h"
#include "viewer/keys.h"
#include "viewer/screenshot_io.h"
#include "viewer/terrain_node.h"
#include "viewer/view_arguments.h"

#include <memory>
#include <osgGA/KeySwitchMatrixManipulator>
#include <osgViewer/Viewer>

class Stage {
  public:
    Stage(osg::ref_ptr<TerrainNode> terrain, const ViewArguments &arguments);

    // False, and one line in `error`, when nothing can be drawn here.
    bool open(std::string *error);

    bool is_done() const { return viewer.done(); }

    // Draws a frame. `camera`: camera to world; null: as the manipulator has it, or where it was.
    void draw(const osg::Matrixd *camera, const std::string &figures, const std::string &note);

    osg::Matrixd camera_to_world() const { return placed; }
    osg::Matrixd home() const { return home_camera; } // the overview, or the camera asked for
    double time_of_events_s() { return viewer.getEventQueue()->getTime(); }

    osg::ref_ptr<TerrainNode> terrain;
    Hud hud;
    osg::ref_ptr<Keys> keys;
    osg::ref_ptr<FrameEnd> frame_end = new FrameEnd;

  private:
    void build_scene();
    void add_manipulators();
    void place_camera();
    const ViewArguments &arguments;
    osg::ref_ptr<osg::Group> scene;
    osgViewer::Viewer viewer;
    osg::Matrixd placed, home_camera;
};

#endif
