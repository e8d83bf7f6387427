// The keys of scree-view, and what they switch.
#ifndef SCREE_VIEWER_KEYS_H
#define SCREE_VIEWER_KEYS_H

#include "viewer/hud.h"
#include "viewer/terrain_node.h"

#include <osg/Group>
#include <osgGA/GUIEventHandler>
#include <string>

// What keys ask of the loop that draws; it takes the request away again.
struct KeyRequests {
    bool wants_screenshot = false, toggles_recording = false, toggles_playing = false;
};

class Keys : public osgGA::GUIEventHandler {
  public:
    // `scene` is what the wireframe is switched of. All of them outlive this.
    Keys(TerrainNode *terrain, osg::Group *scene, Hud *hud, bool is_wireframe);

    bool handle(const osgGA::GUIEventAdapter &event, osgGA::GUIActionAdapter &viewer) override;

    KeyRequests requests;
    std::string note;       // what was switched last
    double note_time_s = 0; // when, by the time of events

  private:
    struct Key;
    static const Key table[];
    void switch_wireframe();
    void colour_by(TerrainColour colour);
    void scale_by(double factor);
    TerrainNode *terrain;
    osg::Group *scene;
    Hud *hud;
    bool is_wireframe;
    TerrainColour colour_before = TerrainColour::TINT;
    friend std::string keys_help();
};

// One line a key.
std::string keys_help();

#endif
