// A tile of a stream as a node of a scene: geometry in the tile's own frame, in single precision, below a transform
// that puts the frame into the world in double precision.
#ifndef SCREE_VIEWER_TILE_NODE_H
#define SCREE_VIEWER_TILE_NODE_H

#include <osg/Node>
#include <osg/ref_ptr>
#include <scree/player.h>

// The mesh that the player shows now. The world is WGS84 ECEF for geodetic tiles, the CRS for local ones
// (scree_stream_frame); the node's description tells rung, SVO and max error. The player must have a mesh.
osg::ref_ptr<osg::Node> tile_node(scree_player *player, uint32_t rung);

#endif
