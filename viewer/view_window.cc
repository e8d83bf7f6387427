#include "viewer/view_window.h"

#include <osg/Notify>

namespace {

osg::ref_ptr<osg::GraphicsContext> realized(osg::GraphicsContext::Traits *traits) {
    osg::ref_ptr<osg::GraphicsContext> context = osg::GraphicsContext::createGraphicsContext(traits);
    if (!context.valid() || !context->valid() || !context->realize()) return nullptr;
    return context;
}

osg::ref_ptr<osg::GraphicsContext> context_new(int width_px, int height_px, bool is_off_screen) {
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
    return context;
}

} // namespace

bool open_window(const ViewArguments &arguments, FrameEnd *frame_end, osgViewer::Viewer *viewer, std::string *error) {
    osg::ref_ptr<osg::GraphicsContext> context =
        context_new(arguments.width_px, arguments.height_px, arguments.is_off_screen());
    if (!context.valid()) {
        *error = "no picture can be drawn here: DISPLAY has to name a display with OpenGL (xvfb-run makes one)";
        return false;
    }
    viewer->setThreadingModel(osgViewer::Viewer::SingleThreaded);
    osg::Camera *camera = viewer->getCamera();
    const osg::GraphicsContext::Traits *traits = context->getTraits();
    camera->setGraphicsContext(context);
    camera->setViewport(0, 0, traits->width, traits->height);
    camera->setDrawBuffer(traits->doubleBuffer ? GL_BACK : GL_FRONT);
    camera->setReadBuffer(traits->doubleBuffer ? GL_BACK : GL_FRONT);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    // Near enough for a stand on the ground, and far enough for a look across a continent.
    camera->setComputeNearFarMode(osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    camera->setNearFarRatio(1e-5);
    const unsigned sky = arguments.has_background ? arguments.background : 0xa9c7e8;
    camera->setClearColor(
        osg::Vec4((float)(sky >> 16 & 255) / 255, (float)(sky >> 8 & 255) / 255, (float)(sky & 255) / 255, 1));
    camera->setFinalDrawCallback(frame_end);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    return true;
}
