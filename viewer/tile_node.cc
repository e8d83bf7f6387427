#include "viewer/tile_node.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <cstdio>

static osg::Matrixd frame_matrix(const scree_stream_header *header) {
    scree_frame frame;
    scree_stream_frame(header, &frame);
    const double(*axes)[3] = frame.axes;
    return osg::Matrixd(axes[0][0], axes[0][1], axes[0][2], 0, axes[1][0], axes[1][1], axes[1][2], 0, axes[2][0],
                        axes[2][1], axes[2][2], 0, frame.origin[0], frame.origin[1], frame.origin[2], 1);
}

static osg::ref_ptr<osg::Vec3Array> vectors(const float *numbers, uint32_t count) {
    osg::ref_ptr<osg::Vec3Array> array = new osg::Vec3Array(osg::Array::BIND_PER_VERTEX, count);
    for (uint32_t i = 0; i < count; i++) (*array)[i].set(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    return array;
}

osg::ref_ptr<osg::Node> tile_node(scree_player *player, uint32_t rung) {
    const scree_stream_header *header = scree_player_header(player);
    const scree_rung *shown = &header->rungs[rung];
    scree_arrays arrays;
    scree_player_seek_rung(player, rung);
    scree_player_look(player, &arrays);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(vectors(arrays.positions, arrays.vertex_count));
    geometry->setNormalArray(vectors(arrays.normals, arrays.vertex_count));
    osg::ref_ptr<osg::Vec4Array> white = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
    (*white)[0].set(1, 1, 1, 1);
    geometry->setColorArray(white);
    geometry->addPrimitiveSet(
        new osg::DrawElementsUInt(GL_TRIANGLES, arrays.indices, arrays.indices + 3 * (size_t)arrays.triangle_count));
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(frame_matrix(header));
    char text[128];
    snprintf(text, sizeof text, "rung %d, SVO %g m, max error %g m", (int)shown->rung, shown->svo_m,
             shown->max_error_m);
    transform->addDescription(text);
    // Not the transform's own child: the writer of .ive files knows drawables only below a Geode.
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(geometry);
    transform->addChild(geode);
    return transform;
}
