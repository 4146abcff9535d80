#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>

#include <vector>

namespace symsurf {

/// One side of a shape, cut along a mirror, and its image.
struct MirroredHalf {
  Points points;      ///< of the side, then where it is cut, then their images
  Triangles faces;    ///< of the side, then their images, wound the other way round
  Triangles parents;  ///< of each point three points of the shape, the one with most share first
  Points shares;      ///< of these in the point, or in what it is the image of; they sum to 1
  std::vector<Index> face_sources;  ///< of each face the one of the shape that it is a part of
  std::vector<Index> partners;      ///< of each point its image, itself on the mirror
};

/// Cuts the faces that the mirror crosses, keeps the side where signed distances are positive or
/// negative, and adds its image: points on the mirror belong to both, so that a closed surface
/// stays closed. Faces within the mirror are left out: they would cover their images. Throws
/// InvalidInput where the shape has no points on the side or some of them have no image, and where
/// more than two faces of the side meet in an edge on the mirror.
MirroredHalf mirrored_half(PointsView points, TrianglesView faces, const Mirror& mirror,
                           bool positive, const Context& context);

}  // namespace symsurf
