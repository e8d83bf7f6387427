// A raster as a node of a scene: the mesh of a quadtree (stream/quadtree.h) that follows an observer. The world is the
// raster's CRS in metres, as in terrains of the local profile.
#ifndef SCREE_VIEWER_QUADTREE_NODE_H
#define SCREE_VIEWER_QUADTREE_NODE_H

#include "viewer/terrain_world.h"

#include <memory>
#include <osg/MatrixTransform>
#include <osg/ref_ptr>
#include <string>

struct QuadtreeFigures {
    uint32_t triangles = 0, all_triangles = 0; // drawn, and those of the full grid
    double extract_ms = 0, fill_ms = 0;        // CPU time of the last mesh, and of its arrays
};

class QuadtreeNode : public osg::MatrixTransform {
  public:
    // Reads any raster that GDAL reads. Null, and one line in `error`, when there is none.
    static osg::ref_ptr<QuadtreeNode> open(const std::string &path, std::string *error);

    const TerrainWorld &world() const;
    const QuadtreeFigures &figures() const;

    // Makes the mesh that of an observer at this place of the world, unless it is that already. Not while a frame is
    // drawn. `threshold` holds at a distance of 64 posts. False, and one line in `error`, when there is no memory.
    bool follow(const osg::Vec3d &eye, double threshold, std::string *error);

  protected:
    ~QuadtreeNode() override;

  private:
    QuadtreeNode();
    struct Inside;
    std::unique_ptr<Inside> inside;
};

#endif
