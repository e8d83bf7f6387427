// Something to draw on: a window, or a place in memory.
#ifndef SCREE_VIEWER_VIEW_WINDOW_H
#define SCREE_VIEWER_VIEW_WINDOW_H

#include <osg/GraphicsContext>
#include <osg/ref_ptr>
#include <string>

// Null, and one line in `error`, when there is no display or it has no OpenGL. Off screen: a pixel buffer, or a window
// without decoration where the display has none of those.
osg::ref_ptr<osg::GraphicsContext> open_window(int width_px, int height_px, bool is_off_screen, std::string *error);

#endif
