// An image with georeference, warped by GDAL onto the rectangle of a terrain's data.
#ifndef SCREE_VIEWER_DRAPE_IO_H
#define SCREE_VIEWER_DRAPE_IO_H

#include "viewer/manifest_io.h"

#include <osg/Image>
#include <osg/ref_ptr>

// RGBA, rows from the south, transparent where the image has nothing; at most 4096 pixels a side, and no finer than the
// image. Null, and one line in `error`, when it cannot be read or has no georeference.
osg::ref_ptr<osg::Image> drape_image(const std::string &path, const Manifest &manifest, std::string *error);

#endif
