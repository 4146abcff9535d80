#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/operations.h>

#include <utility>
#include <vector>

namespace symsurf {

/// One side of a shape, cut along a mirror.
struct Half {
  Points points;      ///< of the side, then where it is cut
  Triangles faces;    ///< of what is left of each face
  Triangles parents;  ///< of each point three points of the shape, the one with most share first
  Points shares;      ///< of these in the point; they sum to 1
  std::vector<Index> face_sources;  ///< of each face the one of the shape that it is a part of
  std::vector<bool> on_mirror;      ///< one a point
};

/// Cuts the faces that the mirror crosses and keeps the side where signed distances are positive or
/// negative. Faces within the mirror are left out: they would cover their images. Throws
/// InvalidInput where some of the points have no foot, or none lies on the side.
Half half_of(PointsView points, TrianglesView faces, const Mirror& mirror, bool positive,
             const Context& context);

/// The edges of a half's faces on the mirror, from vertex to vertex in the winding of the face.
/// Throws InvalidInput where two faces of the half meet in one: it would have four with their
/// images.
std::vector<std::pair<Index, Index>> cut_edges(const Half& half);

/// A half and its image.
struct MirroredHalf : Half {
  std::vector<Index> partners;  ///< of each point its image, itself on the mirror
};

/// Adds the image of a half: points on the mirror belong to both, so that a closed surface stays
/// closed. Throws InvalidInput where points have no image, and what cut_edges() throws.
MirroredHalf with_image(Half half, const Mirror& mirror, const Context& context);

/// The partners as an array of an operation.
Eigen::VectorXd partner_array(const MirroredHalf& whole);

/// The parameter that says which side is kept, and what it says.
Parameter kept_side();
bool keeps_positive(const ParameterValues& values);

/// Puts points and faces, and where they come from, in place of those of the input.
void set_shape(Half half, OperationResult& result);

}  // namespace symsurf
