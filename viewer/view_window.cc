#include "viewer/view_window.h"

#include <osg/Notify>

namespace {

osg::ref_ptr<osg::GraphicsContext> realized(osg::GraphicsContext::Traits *traits) {
    osg::ref_ptr<osg::GraphicsContext> context = osg::GraphicsContext::createGraphicsContext(traits);
    if (!context.valid() || !context->valid() || !context->realize()) return nullptr;
    return context;
}

} // namespace

osg::ref_ptr<osg::GraphicsContext> open_window(int width_px, int height_px, bool is_off_screen, std::string *error) {
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    traits->x = traits->y = is_off_screen ? 0 : 40;
    traits->width = width_px;
    traits->height = height_px;
    traits->windowName = "scree-view";
    traits->depth = 24;
    traits->doubleBuffer = !is_off_screen;
    traits->pbuffer = is_off_screen;
    traits->windowDecoration = traits->supportsResize = !is_off_screen;
    traits->vsync = !is_off_screen;
    // What OpenSceneGraph has to say about a display that it cannot open is said below, in one line.
    const osg::NotifySeverity severity = osg::getNotifyLevel();
    osg::setNotifyLevel(osg::ALWAYS);
    osg::ref_ptr<osg::GraphicsContext> context = realized(traits);
    if (!context.valid() && is_off_screen) {
        traits->pbuffer = false;
        traits->overrideRedirect = true;
        context = realized(traits);
    }
    osg::setNotifyLevel(severity);
    if (!context.valid())
        *error = "no picture can be drawn here: DISPLAY has to name a display with OpenGL (xvfb-run makes one)";
    return context;
}
