#include "viewer/screenshot_io.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <osg/Viewport>
#include <osgDB/WriteFile>
#include <sys/stat.h>
#include <unistd.h>

void FrameEnd::operator()(osg::RenderInfo &info) const {
    glFinish();
    if (!is_wanted) return;
    const osg::Viewport *viewport = info.getCurrentCamera()->getViewport();
    image = new osg::Image;
    image->readPixels((int)viewport->x(), (int)viewport->y(), (int)viewport->width(), (int)viewport->height(), GL_RGB,
                      GL_UNSIGNED_BYTE, 1);
    is_wanted = false;
}

bool write_png(const osg::Image &image, const std::string &path, std::string *error) {
    const std::string beside = path + "." + std::to_string(getpid()) + ".png"; // the ending chooses the format
    errno = 0;
    const bool written = osgDB::writeImageFile(image, beside) && rename(beside.c_str(), path.c_str()) == 0;
    if (written) return true;
    *error = path + ": the picture cannot be written" + (errno != 0 ? std::string(": ") + strerror(errno) : "");
    unlink(beside.c_str());
    return false;
}

std::string free_name(const std::string &stem, const std::string &ending) {
    for (int number = 1;; number++) {
        char name[16];
        snprintf(name, sizeof name, "-%03d", number);
        const std::string path = stem + name + ending;
        struct stat there;
        if (stat(path.c_str(), &there) != 0) return path;
    }
}

bool make_folder(const std::string &path, std::string *error) {
    struct stat there;
    if (mkdir(path.c_str(), 0777) == 0) return true;
    if (errno == EEXIST && stat(path.c_str(), &there) == 0 && S_ISDIR(there.st_mode)) return true;
    *error = path + ": " + strerror(errno);
    return false;
}
