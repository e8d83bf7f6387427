// Draws a tile: buffers of its own, filled once and then by what has changed.
#ifndef SCREE_VIEWER_TILE_DRAWABLE_H
#define SCREE_VIEWER_TILE_DRAWABLE_H

#include "viewer/tile_mesh.h"

#include <atomic>
#include <mutex>
#include <osg/Drawable>
#include <osg/buffered_value>

// Buffers whose tiles are gone, until a context that owns them draws again; and what has been sent since it was asked.
struct SentFigures {
    std::atomic<uint64_t> bytes{0};
    std::atomic<uint64_t> nanoseconds{0}; // CPU time
};

class BufferGraveyard : public osg::Referenced {
  public:
    void bury(unsigned context, GLuint buffer);
    void empty(unsigned context, osg::GLExtensions *gl); // of that context, which is current

    SentFigures sent;

  private:
    std::mutex lock;
    std::vector<std::pair<unsigned, GLuint>> buffers;
};

class TileDrawable : public osg::Drawable {
  public:
    TileDrawable(std::shared_ptr<TileMesh> mesh, const osg::Vec4 &own_colour, BufferGraveyard *graveyard);

    const std::shared_ptr<TileMesh> &mesh() const { return tile; }
    void set_colour(const osg::Vec4 &shown) { colour = shown; } // w 0: none
    const osg::Vec4 &tile_colour() const { return own_colour; }
    osg::Matrixd frame_matrix() const; // from the tile's frame to the world

    osg::Object *cloneType() const override { return nullptr; } // it has no meaning without its tile
    osg::Object *clone(const osg::CopyOp &) const override { return nullptr; }
    bool isSameKindAs(const osg::Object *other) const override;
    const char *libraryName() const override { return "scree"; }
    const char *className() const override { return "TileDrawable"; }

    // In the tile's frame, for those who look for intersections.
    osg::BoundingBox computeBoundingBox() const override;
    bool supports(const osg::PrimitiveFunctor &) const override { return true; }
    void accept(osg::PrimitiveFunctor &functor) const override;

    // Wants the modelview matrix of the world, not of the tile.
    void drawImplementation(osg::RenderInfo &info) const override;
    void releaseGLObjects(osg::State *state = nullptr) const override;
    void resizeGLObjectBuffers(unsigned contexts) override;

  protected:
    ~TileDrawable() override;

  private:
    enum Buffer { VERTICES, INDICES, SEAM_VERTICES, SEAM_INDICES, BUFFERS };
    struct OnCard { // in one context
        GLuint buffers[BUFFERS] = {};
        uint64_t version = 0, seam_version = 0; // that have been sent
        uint32_t vertices = 0;                  // so many from the first on
    };
    void make_buffers(osg::GLExtensions *gl, OnCard *card) const;
    void send(osg::GLExtensions *gl, OnCard *card) const;
    void send_vertices(osg::GLExtensions *gl, OnCard *card) const;
    void send_indices(osg::GLExtensions *gl, const OnCard &card) const;
    void send_seam(osg::GLExtensions *gl, const OnCard &card) const;
    void set_uniforms(osg::State &state, osg::GLExtensions *gl) const;

    std::shared_ptr<TileMesh> tile;
    osg::Vec4 own_colour, colour;
    osg::ref_ptr<BufferGraveyard> graveyard;
    mutable osg::buffered_object<OnCard> cards;
};

#endif
