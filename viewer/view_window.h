// Something to draw on: a window, or a place in memory.
#ifndef SCREE_VIEWER_VIEW_WINDOW_H
#define SCREE_VIEWER_VIEW_WINDOW_H

#include "viewer/screenshot_io.h"
#include "viewer/view_arguments.h"

#include <osgViewer/Viewer>
#include <string>

// Lets a viewer draw there, one thread doing all, with the sky and the size that the arguments ask for. False, and one
// line in `error`, when there is no display or it has no OpenGL. Off screen: a pixel buffer, or a window without
// decoration where the display has none of those.
bool open_window(const ViewArguments &arguments, FrameEnd *frame_end, osgViewer::Viewer *viewer, std::string *error);

#endif
