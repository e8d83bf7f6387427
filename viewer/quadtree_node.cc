#include "viewer/quadtree_node.h"

#include "stream/quadtree.h"
#include "viewer/quadtree_dem_io.h"
#include "viewer/stopwatch_io.h"

#include <algorithm>
#include <cmath>
#include <osg/Geometry>

namespace {

constexpr double REACH_POSTS = 64, SEA_M = -100; // lower depths than any dry land's are a sea's

osg::Vec3 mixed(const osg::Vec3 &a, const osg::Vec3 &b, float part) {
    return a * (1 - part) + b * part;
}

// From green to white over the land, from pale to dark blue below a sea.
osg::Vec3 tint(double height_m, double lowest_m, double highest_m) {
    static const osg::Vec3 steps[] = {{0.47f, 0.62f, 0.42f},
                                      {0.71f, 0.77f, 0.52f},
                                      {0.86f, 0.79f, 0.58f},
                                      {0.72f, 0.58f, 0.46f},
                                      {0.95f, 0.94f, 0.92f}};
    const bool has_sea = lowest_m < SEA_M;
    if (has_sea && height_m < 0)
        return mixed(osg::Vec3(0.62f, 0.78f, 0.86f), osg::Vec3(0.10f, 0.24f, 0.45f),
                     (float)std::clamp(-height_m / 4000, 0.0, 1.0));
    const double low_m = has_sea ? 0 : lowest_m;
    const double at = 4 * std::clamp((height_m - low_m) / std::max(highest_m - low_m, 1.0), 0.0, 1.0);
    const int step = std::min((int)at, 3);
    return mixed(steps[step], steps[step + 1], (float)(at - step));
}

scree_terrain terrain_of(const QuadtreeDem &dem) {
    scree_terrain terrain = {};
    terrain.profile = SCREE_LOCAL;
    terrain.lowest_m = dem.lowest_m;
    terrain.highest_m = dem.highest_m;
    terrain.spacing_x = dem.spacing_x;
    terrain.spacing_y = dem.spacing_y;
    terrain.metres_x = dem.metres_x;
    terrain.metres_y = dem.metres_y;
    return terrain;
}

} // namespace

struct QuadtreeNode::Inside {
    explicit Inside(QuadtreeDem read)
        : dem(std::move(read)), bounds{dem.west, dem.south, dem.west + dem.spacing_x * (dem.columns - 1),
                                       dem.south + dem.spacing_y * (dem.rows - 1)},
          world(terrain_of(dem), dem.crs_wkt, bounds) {
        world.set_heights(dem.lowest_m, dem.highest_m);
    }
    ~Inside() {
        quadtree_mesh_release(&memory, &made);
        quadtree_release(&memory, &tree);
    }
    float post_m(int x, int y) const {
        const int column = std::clamp(x, 0, dem.columns - 1), row = std::clamp(y, 0, dem.rows - 1);
        return dem.heights_m[(size_t)row * (size_t)dem.columns + (size_t)column];
    }
    osg::Vec4ub colour_of(int x, int y) const;
    void fill();

    QuadtreeDem dem;
    double bounds[4];
    TerrainWorld world;
    scree_memory memory = {};
    quadtree tree = {};
    quadtree_mesh made = {};
    quadtree_view view = {}; // that `made` is for
    QuadtreeFigures figures;
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4ubArray> colours = new osg::Vec4ubArray;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
};

// ---- opening ----

QuadtreeNode::QuadtreeNode() = default;
QuadtreeNode::~QuadtreeNode() = default;

osg::ref_ptr<QuadtreeNode> QuadtreeNode::open(const std::string &path, std::string *error) {
    QuadtreeDem dem;
    scree_error failure = {};
    if (!quadtree_dem_read(path, &dem, error)) return nullptr;
    osg::ref_ptr<QuadtreeNode> node = new QuadtreeNode;
    node->inside.reset(new Inside(std::move(dem)));
    Inside &inside = *node->inside;
    curvature_posts posts = {};
    posts.heights_m = inside.dem.heights_m.data();
    posts.columns = posts.stride = inside.dem.columns;
    posts.rows = inside.dem.rows;
    posts.east_m = inside.dem.metres_x;
    posts.north_m = inside.dem.metres_y;
    if (quadtree_make(&inside.memory, &posts, &inside.tree, &failure) != SCREE_OK) {
        *error = path + ": " + failure.text;
        return nullptr;
    }
    inside.figures.all_triangles = 2u * (uint32_t)(posts.columns - 1) * (uint32_t)(posts.rows - 1);
    inside.colours->setNormalize(true);
    inside.geometry->setUseDisplayList(false);
    inside.geometry->setUseVertexBufferObjects(true);
    inside.geometry->setDataVariance(osg::Object::DYNAMIC);
    inside.geometry->setVertexArray(inside.vertices);
    inside.geometry->setColorArray(inside.colours, osg::Array::BIND_PER_VERTEX);
    inside.geometry->addPrimitiveSet(inside.triangles);
    // vertices are floats about the middle
    node->setMatrix(osg::Matrixd::translate(inside.world.middle()));
    node->addChild(inside.geometry);
    return node;
}

const TerrainWorld &QuadtreeNode::world() const {
    return inside->world;
}

const QuadtreeFigures &QuadtreeNode::figures() const {
    return inside->figures;
}

// ---- a mesh ----

// Lit from the north-west, as maps are, by the slope between a post's neighbours.
osg::Vec4ub QuadtreeNode::Inside::colour_of(int x, int y) const {
    const double east = (post_m(x + 1, y) - post_m(x - 1, y)) / (2 * dem.metres_x);
    const double north = (post_m(x, y + 1) - post_m(x, y - 1)) / (2 * dem.metres_y);
    const double sun = (0.55 * east - 0.55 * north + 0.63) / std::sqrt(east * east + north * north + 1);
    const osg::Vec3 colour =
        tint(post_m(x, y), dem.lowest_m, dem.highest_m) * (float)(0.42 + 0.78 * std::max(sun, 0.0)) * 255;
    const auto channel = [](float value) { return (unsigned char)std::clamp(value, 0.f, 255.f); };
    return osg::Vec4ub(channel(colour.x()), channel(colour.y()), channel(colour.z()), 255);
}

void QuadtreeNode::Inside::fill() {
    const osg::Vec3d middle = world.middle();
    const double west_m = dem.west * dem.metres_x / dem.spacing_x - middle.x();
    const double south_m = dem.south * dem.metres_y / dem.spacing_y - middle.y();
    vertices->resize(made.mesh.vertex_count);
    colours->resize(made.mesh.vertex_count);
    for (uint32_t i = 0; i < made.mesh.vertex_count; i++) {
        const scree_vertex &at = made.mesh.vertices[i];
        (*vertices)[i].set((float)(west_m + at.x * dem.metres_x), (float)(south_m + at.y * dem.metres_y),
                           (float)(post_m(at.x, at.y) - middle.z()));
        (*colours)[i] = colour_of(at.x, at.y);
    }
    triangles->assign(made.mesh.corners, made.mesh.corners + 3 * (size_t)made.mesh.triangle_count);
    vertices->dirty();
    colours->dirty();
    triangles->dirty();
    geometry->dirtyBound();
}

bool QuadtreeNode::follow(const osg::Vec3d &eye, double threshold, std::string *error) {
    const QuadtreeDem &dem = inside->dem;
    quadtree_view view = {};
    view.threshold = threshold;
    view.has_observer = true;
    view.x = eye.x() / dem.metres_x - dem.west / dem.spacing_x;
    view.y = eye.y() / dem.metres_y - dem.south / dem.spacing_y;
    view.height_m = eye.z();
    view.reach_m = REACH_POSTS * std::sqrt(dem.metres_x * dem.metres_y);
    const quadtree_view &before = inside->view;
    if (inside->made.mesh.triangle_count > 0 && view.threshold == before.threshold && view.x == before.x &&
        view.y == before.y && view.height_m == before.height_m)
        return true;
    scree_error failure = {};
    Stopwatch stopwatch;
    if (quadtree_extract(&inside->memory, &inside->tree, &view, &inside->made, &failure) != SCREE_OK) {
        *error = failure.text;
        return false;
    }
    inside->view = view;
    inside->figures.extract_ms = stopwatch.lap_ms();
    inside->figures.triangles = inside->made.mesh.triangle_count;
    inside->fill();
    inside->figures.fill_ms = stopwatch.lap_ms();
    return true;
}
