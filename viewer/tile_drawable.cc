#include "viewer/tile_drawable.h"

#include "viewer/stopwatch_io.h"
#include "viewer/terrain_program.h"

#include <algorithm>
#include <cstddef>
#include <osg/GLExtensions>
#include <osg/Program>
#include <osg/State>

// ---- buffers that nobody draws any more ----

void BufferGraveyard::bury(unsigned context, GLuint buffer) {
    std::lock_guard<std::mutex> guard(lock);
    if (buffer != 0) buffers.emplace_back(context, buffer);
}

void BufferGraveyard::empty(unsigned context, osg::GLExtensions *gl) {
    std::lock_guard<std::mutex> guard(lock);
    auto is_here = [context](const std::pair<unsigned, GLuint> &one) { return one.first == context; };
    for (const auto &one : buffers)
        if (is_here(one)) gl->glDeleteBuffers(1, &one.second);
    buffers.erase(std::remove_if(buffers.begin(), buffers.end(), is_here), buffers.end());
}

// ---- a tile ----

TileDrawable::TileDrawable(std::shared_ptr<TileMesh> mesh, const osg::Vec4 &own_colour, BufferGraveyard *graveyard)
    : tile(std::move(mesh)), own_colour(own_colour), graveyard(graveyard) {
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(true);
    setDataVariance(DYNAMIC); // the next frame waits until this one has been drawn
}

TileDrawable::~TileDrawable() {
    TileDrawable::releaseGLObjects(nullptr);
}

bool TileDrawable::isSameKindAs(const osg::Object *other) const {
    return dynamic_cast<const TileDrawable *>(other) != nullptr;
}

osg::Matrixd TileDrawable::frame_matrix() const {
    scree_frame frame = tile->frame();
    const double(*axes)[3] = frame.axes;
    return osg::Matrixd(axes[0][0], axes[0][1], axes[0][2], 0, axes[1][0], axes[1][1], axes[1][2], 0, axes[2][0],
                        axes[2][1], axes[2][2], 0, frame.origin[0], frame.origin[1], frame.origin[2], 1);
}

osg::BoundingBox TileDrawable::computeBoundingBox() const {
    const auto &box = tile->box;
    return osg::BoundingBox(osg::Vec3d(box[0][0], box[0][1], box[0][2]), osg::Vec3d(box[1][0], box[1][1], box[1][2]));
}

void TileDrawable::accept(osg::PrimitiveFunctor &functor) const {
    std::vector<float> places;
    tile->positions(&places);
    functor.setVertexArray(tile->vertex_count(), reinterpret_cast<const osg::Vec3 *>(places.data()));
    functor.drawElements(GL_TRIANGLES, (GLsizei)(3 * tile->triangle_count()), tile->indices.data());
}

void TileDrawable::releaseGLObjects(osg::State *state) const {
    for (unsigned context = 0; context < cards.size(); context++) {
        if (state != nullptr && state->getContextID() != context) continue;
        for (GLuint buffer : cards[context].buffers) graveyard->bury(context, buffer);
        cards[context] = OnCard();
    }
    osg::Drawable::releaseGLObjects(state);
}

void TileDrawable::resizeGLObjectBuffers(unsigned contexts) {
    osg::Drawable::resizeGLObjectBuffers(contexts);
    cards.resize(contexts);
}

// ---- sending ----

void TileDrawable::make_buffers(osg::GLExtensions *gl, OnCard *card) const {
    gl->glGenBuffers(BUFFERS, card->buffers);
    gl->glBindBuffer(GL_ARRAY_BUFFER, card->buffers[VERTICES]);
    gl->glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(tile->vertices.size() * sizeof(TileVertex)), nullptr,
                     GL_STATIC_DRAW);
    gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, card->buffers[INDICES]);
    gl->glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(tile->indices.size() * sizeof(uint32_t)), nullptr,
                     GL_DYNAMIC_DRAW);
}

// Runs of pages that are newer than what was sent, within the first `end` items.
template <class Send> static void each_run(const PageVersions &pages, uint64_t sent, uint32_t end, Send send) {
    const uint32_t page_items = pages.page_items;
    for (uint32_t page = 0; page * page_items < end; page++) {
        if (pages[page] <= sent) continue;
        uint32_t first = page;
        while ((page + 1) * page_items < end && pages[page + 1] > sent) page++;
        send(first * page_items, std::min(end, (page + 1) * page_items));
    }
}

void TileDrawable::send_vertices(osg::GLExtensions *gl, OnCard *card) const {
    gl->glBindBuffer(GL_ARRAY_BUFFER, card->buffers[VERTICES]);
    auto send = [&](uint32_t first, uint32_t end) {
        uint64_t bytes = (end - first) * sizeof(TileVertex);
        gl->glBufferSubData(GL_ARRAY_BUFFER, (GLintptr)(first * sizeof(TileVertex)), (GLsizeiptr)bytes,
                            &tile->vertices[first]);
        graveyard->sent.bytes += bytes;
    };
    each_run(tile->vertex_pages, card->version, card->vertices, send);
    if (tile->vertex_count() > card->vertices) {
        send(card->vertices, tile->vertex_count());
        card->vertices = tile->vertex_count();
    }
}

void TileDrawable::send_indices(osg::GLExtensions *gl, const OnCard &card) const {
    gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, card.buffers[INDICES]);
    each_run(tile->index_pages, card.version, (uint32_t)tile->indices.size(), [&](uint32_t first, uint32_t end) {
        uint64_t bytes = (end - first) * sizeof(uint32_t);
        gl->glBufferSubData(GL_ELEMENT_ARRAY_BUFFER, (GLintptr)(first * sizeof(uint32_t)), (GLsizeiptr)bytes,
                            &tile->indices[first]);
        graveyard->sent.bytes += bytes;
    });
}

void TileDrawable::send_seam(osg::GLExtensions *gl, const OnCard &card) const {
    size_t vertex_bytes = tile->seam_vertices.size() * sizeof(TileVertex);
    size_t index_bytes = tile->seam_indices.size() * sizeof(uint32_t);
    if (index_bytes == 0) return;
    gl->glBindBuffer(GL_ARRAY_BUFFER, card.buffers[SEAM_VERTICES]);
    gl->glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)vertex_bytes, tile->seam_vertices.data(), GL_DYNAMIC_DRAW);
    gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, card.buffers[SEAM_INDICES]);
    gl->glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)index_bytes, tile->seam_indices.data(), GL_DYNAMIC_DRAW);
    graveyard->sent.bytes += vertex_bytes + index_bytes;
}

void TileDrawable::send(osg::GLExtensions *gl, OnCard *card) const {
    Stopwatch watch;
    if (card->buffers[VERTICES] == 0) make_buffers(gl, card);
    if (card->version < tile->version || card->vertices < tile->vertex_count()) {
        send_vertices(gl, card);
        send_indices(gl, *card);
    }
    if (card->seam_version < tile->seam_version) send_seam(gl, *card);
    card->version = tile->version;
    card->seam_version = tile->seam_version;
    graveyard->sent.nanoseconds += (uint64_t)(1e6 * watch.lap_ms());
}

// ---- drawing ----

// The eye as two floats a coordinate; what is left of the matrix turns and scales about it.
void TileDrawable::set_uniforms(osg::State &state, osg::GLExtensions *gl) const {
    const osg::Program::PerContextProgram *program = state.getLastAppliedProgramObject();
    auto at = [program](const char *name) { return program->getUniformLocation(osg::Uniform::getNameID(name)); };
    osg::Matrixd view = state.getModelViewMatrix();
    osg::Vec3d eye = osg::Vec3d(0, 0, 0) * osg::Matrixd::inverse(view);
    osg::Vec3f high(eye), low(eye - osg::Vec3d(high));
    view.setTrans(0, 0, 0);
    osg::Matrixf turned(view), projection(state.getProjectionMatrix());
    gl->glUniform3fv(at(UNIFORM_EYE_HIGH), 1, high.ptr());
    gl->glUniform3fv(at(UNIFORM_EYE_LOW), 1, low.ptr());
    gl->glUniformMatrix4fv(at(UNIFORM_VIEW), 1, GL_FALSE, turned.ptr());
    gl->glUniformMatrix4fv(at(UNIFORM_PROJECTION), 1, GL_FALSE, projection.ptr());
    gl->glUniform1fv(at(UNIFORM_LEVELS), SLOT_COUNT, tile->levels);
    gl->glUniform1f(at(UNIFORM_OCTAVE), tile->octave_increments());
    gl->glUniform4fv(at(UNIFORM_COLOUR), 1, colour.ptr());
}

static void point_at_vertices(osg::GLExtensions *gl) {
    const struct {
        GLint size;
        GLenum type;
        GLboolean is_share;
        size_t offset;
    } attributes[] = {{3, GL_FLOAT, GL_FALSE, offsetof(TileVertex, high)},
                      {3, GL_FLOAT, GL_FALSE, offsetof(TileVertex, low)},
                      {3, GL_FLOAT, GL_FALSE, offsetof(TileVertex, delta)},
                      {2, GL_FLOAT, GL_FALSE, offsetof(TileVertex, height_m)},
                      {2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(TileVertex, map)},
                      {4, GL_SHORT, GL_FALSE, offsetof(TileVertex, normal)},
                      {4, GL_SHORT, GL_FALSE, offsetof(TileVertex, origin_normal)}};
    for (GLuint i = 0; i <= TILE_ORIGIN_NORMAL; i++) {
        gl->glEnableVertexAttribArray(i);
        gl->glVertexAttribPointer(i, attributes[i].size, attributes[i].type, attributes[i].is_share, sizeof(TileVertex),
                                  reinterpret_cast<const void *>(attributes[i].offset));
    }
}

void TileDrawable::drawImplementation(osg::RenderInfo &info) const {
    osg::State &state = *info.getState();
    osg::GLExtensions *gl = state.get<osg::GLExtensions>();
    if (state.getLastAppliedProgramObject() == nullptr) return; // the driver took none: OpenSceneGraph has said why
    OnCard &card = cards[state.getContextID()];
    state.disableAllVertexArrays();
    state.unbindVertexBufferObject();
    state.unbindElementBufferObject();
    graveyard->empty(state.getContextID(), gl);
    send(gl, &card);
    set_uniforms(state, gl);
    gl->glBindBuffer(GL_ARRAY_BUFFER, card.buffers[VERTICES]);
    point_at_vertices(gl);
    gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, card.buffers[INDICES]);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * tile->triangle_count()), GL_UNSIGNED_INT, nullptr);
    if (!tile->seam_indices.empty()) {
        gl->glBindBuffer(GL_ARRAY_BUFFER, card.buffers[SEAM_VERTICES]);
        point_at_vertices(gl);
        gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, card.buffers[SEAM_INDICES]);
        glDrawElements(GL_TRIANGLES, (GLsizei)tile->seam_indices.size(), GL_UNSIGNED_INT, nullptr);
    }
    for (GLuint i = 0; i <= TILE_ORIGIN_NORMAL; i++) gl->glDisableVertexAttribArray(i);
    gl->glBindBuffer(GL_ARRAY_BUFFER, 0);
    gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}
