// Text over the picture: figures of the frame in the corner, and a page of help. In Debian's DejaVu where
// it is there, else in OpenSceneGraph's own built-in font.
#ifndef SCREE_VIEWER_HUD_H
#define SCREE_VIEWER_HUD_H

#include "viewer/terrain_settings.h"

#include <osg/Camera>
#include <osgText/Text>
#include <string>

class Hud {
  public:
    explicit Hud(const std::string &help);

    osg::Camera *camera() { return root.get(); } // to be put into the scene
    void resize(double width_px, double height_px);

    void show_figures(bool shown) { are_figures_shown = shown; }
    void show_help(bool shown) { is_help_shown = shown; }
    bool shows_figures() const { return are_figures_shown; }
    bool shows_help() const { return is_help_shown; }

    // Once a frame. `note` is a line about what was just switched; "": none.
    void update(const std::string &figures, const std::string &note);

  private:
    osg::ref_ptr<osg::Camera> root;
    osg::ref_ptr<osgText::Text> figures, help, note;
    bool are_figures_shown = true, is_help_shown = false;
    double width_px = 0, height_px = 0;
};

// The lines of the corner.
std::string hud_figures(const TerrainFigures &figures, const TerrainSettings &settings, double frames_per_s,
                        bool is_recording);

#endif
