#include "viewer/terrain_node.h"

#include "viewer/drape_io.h"
#include "viewer/terrain_program.h"
#include "viewer/terrain_set.h"
#include "viewer/tile_drawable.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgUtil/CullVisitor>
#include <osgUtil/IntersectionVisitor>

namespace {

constexpr double LONGEST_FRAME_S = 0.25; // after a pause scales do not jump

// A colour for a number, far from those of the numbers beside it.
osg::Vec4 colour_of(uint32_t number) {
    float hue = (float)std::fmod(number * 0.61803398875, 1.0) * 6;
    auto part = [hue](float shift) { return std::clamp(std::fabs(std::fmod(hue + shift, 6.f) - 3.f) - 1.f, 0.f, 1.f); };
    return osg::Vec4(0.35f + 0.6f * part(0), 0.35f + 0.6f * part(4), 0.35f + 0.6f * part(2), 1);
}

// Takes the near and the far plane apart as far as the box, which is turned against the axes of the world, reaches.
void take_depths(const osg::BoundingBox &box, const osg::Matrixd &to_eye, osgUtil::CullVisitor *visitor) {
    for (unsigned i = 0; i < 8; i++) {
        double depth = -(osg::Vec3d(box.corner(i)) * to_eye).z();
        if (depth < visitor->getCalculatedNearPlane()) visitor->setCalculatedNearPlane(depth);
        if (depth > visitor->getCalculatedFarPlane()) visitor->setCalculatedFarPlane(depth);
    }
}

} // namespace

struct TerrainNode::Inside {
    Inside(Manifest manifest, const TerrainOptions &options)
        : settings(options.settings), world(manifest.terrain, manifest.crs_wkt, manifest.bounds),
          set(std::move(manifest), options, [](const std::string &line) { OSG_WARN << line << std::endl; }) {}

    void choose(osgUtil::CullVisitor &visitor, const osg::Camera *camera);
    void follow();
    void put(osgUtil::CullVisitor &visitor);

    TerrainSettings settings;
    TerrainWorld world;
    TerrainSet set;
    osg::ref_ptr<osg::StateSet> state;
    osg::ref_ptr<BufferGraveyard> graveyard = new BufferGraveyard;
    std::vector<osg::ref_ptr<TileDrawable>> drawables; // of each shown
    std::vector<uint32_t> drawable_tiles;
    std::vector<double> distances_m; // of each shown, from the eye
    std::mutex lock;                 // the cameras of a frame may cull at the same time
    unsigned frame = UINT32_MAX;     // the last one chosen for
    double time_s = 0;
    const osg::Camera *first = nullptr; // that culled in it
    bool has_others = false, had_others = false;
    TerrainFigures told;
};

// ---- opening ----

TerrainNode::TerrainNode() {
    setCullingActive(false); // the selection knows better
    setDataVariance(DYNAMIC);
}

TerrainNode::~TerrainNode() = default;

osg::ref_ptr<TerrainNode> TerrainNode::open(const std::string &path, const TerrainOptions &options,
                                            std::string *error) {
    Manifest manifest;
    osg::ref_ptr<osg::Image> texture;
    if (!manifest_read(path, &manifest, error)) return nullptr;
    if (!options.texture.empty() && (texture = drape_image(options.texture, manifest, error)) == nullptr)
        return nullptr;
    osg::ref_ptr<TerrainNode> node = new TerrainNode;
    node->inside.reset(new Inside(std::move(manifest), options));
    Inside &inside = *node->inside;
    if (!inside.set.open(error)) return nullptr;
    std::pair<double, double> heights_m = inside.set.data_heights_m();
    inside.world.set_heights(heights_m.first, heights_m.second);
    inside.state = terrain_state(options.glsl, inside.world, texture);
    return node;
}

// ---- what a viewer asks ----

TerrainSettings &TerrainNode::settings() {
    return inside->settings;
}

const TerrainWorld &TerrainNode::world() const {
    return inside->world;
}

TerrainFigures TerrainNode::figures() const {
    return inside->told;
}

std::vector<TerrainTileFigures> TerrainNode::tile_figures() const {
    std::vector<TerrainTileFigures> figures;
    const std::vector<TerrainSet::Shown> &shown = inside->set.shown();
    for (size_t i = 0; i < shown.size() && i < inside->distances_m.size(); i++) {
        const TileMesh &mesh = *shown[i].mesh;
        const scree_stream_header &header = mesh.header();
        const scree_rung &rung = header.rungs[mesh.rung()];
        figures.push_back({inside->set.id(shown[i].tile), rung.rung, mesh.level(), rung.svo_m, rung.max_error_m,
                           inside->distances_m[i], rung.triangle_count, rung.vertex_count,
                           header.rungs[header.rung_count - 1].vertex_count});
    }
    return figures;
}

std::pair<double, double> TerrainNode::svo_range_m() const {
    return inside->set.svo_range_m();
}

bool TerrainNode::is_settled() const {
    return inside->set.is_settled();
}

osg::BoundingSphere TerrainNode::computeBound() const {
    return osg::BoundingSphere(inside->world.middle(), (float)inside->world.radius_m());
}

// ---- a frame ----

// What is drawn is chosen once a frame, for the camera that culls first; all around it when there are others.
void TerrainNode::Inside::choose(osgUtil::CullVisitor &visitor, const osg::Camera *camera) {
    const osg::FrameStamp *stamp = visitor.getFrameStamp();
    unsigned number = stamp == nullptr ? frame + 1 : stamp->getFrameNumber();
    if (number == frame) {
        has_others = has_others || camera != first;
        return;
    }
    double now_s = stamp == nullptr ? 0 : stamp->getReferenceTime();
    double passed_s = frame == UINT32_MAX ? 0 : std::clamp(now_s - time_s, 0.0, LONGEST_FRAME_S);
    frame = number;
    time_s = now_s;
    first = camera;
    had_others = has_others;
    has_others = false;
    const osg::Viewport *viewport = visitor.getViewport();
    double width_px = viewport == nullptr ? 1024 : viewport->width();
    double height_px = viewport == nullptr ? 768 : viewport->height();
    osg::Matrixd whole = *visitor.getModelViewMatrix() * *visitor.getProjectionMatrix();
    scree_view view;
    scree_error failure = {};
    // the planes before and behind are not known yet: they follow from what is drawn
    if (scree_view_of_matrix(whole.ptr(), SCREE_DEPTH_ANY, width_px, height_px, &view, &failure) != SCREE_OK) return;
    if (had_others) view.plane_count = 0;
    set.frame(view, settings, passed_s);
    told = set.figures();
    told.bytes_sent = graveyard->sent.bytes.exchange(0);
    told.send_ms = 1e-6 * (double)graveyard->sent.nanoseconds.exchange(0);
    terrain_state_follow(state, settings, world);
    follow();
    osg::Vec3d eye = osg::Vec3d(0, 0, 0) * osg::Matrixd::inverse(*visitor.getModelViewMatrix());
    distances_m.clear();
    for (const osg::ref_ptr<TileDrawable> &drawable : drawables) {
        const osg::BoundingBox box = drawable->computeBoundingBox();
        distances_m.push_back((osg::Vec3d(box.center()) * drawable->frame_matrix() - eye).length());
    }
}

// A drawable for each tile shown; those of tiles that stay are kept.
void TerrainNode::Inside::follow() {
    const std::vector<TerrainSet::Shown> &shown = set.shown();
    std::vector<osg::ref_ptr<TileDrawable>> next;
    std::vector<uint32_t> next_tiles;
    size_t old = 0;
    for (const TerrainSet::Shown &one : shown) {
        while (old < drawables.size() && scree_tile_compare(&set.id(drawable_tiles[old]), &set.id(one.tile)) < 0) old++;
        bool is_kept = old < drawables.size() && drawables[old]->mesh() == one.mesh;
        osg::ref_ptr<TileDrawable> drawable = is_kept ? drawables[old] : nullptr;
        if (!is_kept) drawable = new TileDrawable(one.mesh, colour_of(one.tile), graveyard.get());
        next.push_back(drawable);
        next_tiles.push_back(one.tile);
        const scree_rung &rung = one.mesh->header().rungs[one.mesh->rung()];
        bool by_tile = settings.colour == TerrainColour::TILE, by_rung = settings.colour == TerrainColour::RUNG;
        next.back()->set_colour(by_tile   ? next.back()->tile_colour()
                                : by_rung ? colour_of((uint32_t)(rung.rung + 1024))
                                          : osg::Vec4(0, 0, 0, 0));
    }
    drawables.swap(next);
    drawable_tiles.swap(next_tiles);
}

// Straight into the render bins, the nearest first.
void TerrainNode::Inside::put(osgUtil::CullVisitor &visitor) {
    osg::RefMatrix *view = visitor.getModelViewMatrix();
    std::vector<std::pair<double, size_t>> order;
    for (size_t i = 0; i < drawables.size(); i++) order.emplace_back(i < distances_m.size() ? distances_m[i] : 0, i);
    std::sort(order.begin(), order.end());
    visitor.pushStateSet(state.get());
    for (const auto &[distance_m, i] : order) {
        TileDrawable &drawable = *drawables[i];
        if (visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR)
            take_depths(drawable.computeBoundingBox(), drawable.frame_matrix() * *view, &visitor);
        visitor.addDrawableAndDepth(&drawable, view, (float)distance_m);
    }
    visitor.popStateSet();
}

void TerrainNode::traverse(osg::NodeVisitor &visitor) {
    if (visitor.getVisitorType() == osg::NodeVisitor::CULL_VISITOR) {
        auto *cull = visitor.asCullVisitor();
        if (cull == nullptr) return;
        std::lock_guard<std::mutex> guard(inside->lock);
        inside->choose(*cull, cull->getCurrentCamera());
        inside->put(*cull);
    } else if (dynamic_cast<osgUtil::IntersectionVisitor *>(&visitor) != nullptr) {
        std::lock_guard<std::mutex> guard(inside->lock);
        for (const osg::ref_ptr<TileDrawable> &drawable : inside->drawables) {
            osg::ref_ptr<osg::MatrixTransform> frame = new osg::MatrixTransform(drawable->frame_matrix());
            frame->addChild(drawable);
            frame->accept(visitor);
        }
    }
}

void TerrainNode::releaseGLObjects(osg::State *state) const {
    osg::Node::releaseGLObjects(state);
    inside->state->releaseGLObjects(state);
    for (const osg::ref_ptr<TileDrawable> &drawable : inside->drawables) drawable->releaseGLObjects(state);
    if (state != nullptr) inside->graveyard->empty(state->getContextID(), state->get<osg::GLExtensions>());
}

void TerrainNode::resizeGLObjectBuffers(unsigned contexts) {
    osg::Node::resizeGLObjectBuffers(contexts);
    inside->state->resizeGLObjectBuffers(contexts);
    for (const osg::ref_ptr<TileDrawable> &drawable : inside->drawables) drawable->resizeGLObjectBuffers(contexts);
}
