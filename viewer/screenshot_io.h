// Pictures of what a camera drew, as PNG files.
#ifndef SCREE_VIEWER_SCREENSHOT_IO_H
#define SCREE_VIEWER_SCREENSHOT_IO_H

#include <osg/Camera>
#include <osg/Image>
#include <string>

// The last thing that a camera does in a frame: waits until all has been drawn, so that a clock behind it tells the
// truth, and copies the picture when one is wanted.
class FrameEnd : public osg::Camera::DrawCallback {
  public:
    void want_picture() { is_wanted = true; }
    osg::Image *picture() { return image.get(); } // null until a frame was drawn after want_picture
    void operator()(osg::RenderInfo &info) const override;

  private:
    mutable bool is_wanted = false;
    mutable osg::ref_ptr<osg::Image> image;
};

// Writes beside, then renames. False, and one line in `error`, when it did not work.
bool write_png(const osg::Image &image, const std::string &path, std::string *error);

// `stem` and a number that no file of the current folder has, and the ending.
std::string free_name(const std::string &stem, const std::string &ending);

bool make_folder(const std::string &path, std::string *error); // fine when it is there

#endif
