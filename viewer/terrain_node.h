// A terrain of streams as a node of any scene: it chooses tiles and rungs for the camera that culls it, loads them in
// the background, morphs and stitches them. Frames never wait for a file.
//
// The world is what scree/select.h says: WGS84 ECEF in the geodetic profile (TerrainWorld tells it to manipulators by a
// CoordinateSystemNode), the CRS's coordinates in metres in the local one.
//
// Several cameras that look at one terrain draw the same tiles: those for the camera that culled it first, chosen all
// around its eye.
#ifndef SCREE_VIEWER_TERRAIN_NODE_H
#define SCREE_VIEWER_TERRAIN_NODE_H

#include "viewer/terrain_settings.h"
#include "viewer/terrain_world.h"

#include <memory>
#include <osg/Node>
#include <osg/ref_ptr>
#include <vector>

// A tile that is drawn, for tables and plots.
struct TerrainTileFigures {
    scree_tile_id id;
    int32_t rung;
    double level, svo_m, max_error_m;
    double distance_m; // of the eye from the middle of the tile at half of its heights
    uint32_t triangles, vertices;
    uint32_t finest_vertices; // of the tile's last rung: the difference is what has been simplified away
};

class TerrainNode : public osg::Node {
  public:
    // Opens OUT, OUT/stream, a scree.json or a single .scree file, anywhere that GDAL's virtual file systems reach.
    // Waits until the coarsest tiles are there. Null, and one line in `error`, when there is no terrain.
    static osg::ref_ptr<TerrainNode> open(const std::string &path, const TerrainOptions &options, std::string *error);

    TerrainSettings &settings();
    const TerrainWorld &world() const;
    TerrainFigures figures() const;
    std::vector<TerrainTileFigures> tile_figures() const; // in the order of the cut
    std::pair<double, double> svo_range_m() const;        // the finest and the coarsest of the whole terrain

    // Nothing that the last frame wanted is still on its way: a picture taken now is the final one.
    bool is_settled() const;

    osg::BoundingSphere computeBound() const override;
    void traverse(osg::NodeVisitor &visitor) override;
    void releaseGLObjects(osg::State *state = nullptr) const override;
    void resizeGLObjectBuffers(unsigned contexts) override;

  protected:
    ~TerrainNode() override;

  private:
    TerrainNode();
    struct Inside;
    std::unique_ptr<Inside> inside;
};

#endif
