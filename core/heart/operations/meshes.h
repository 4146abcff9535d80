#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/operations.h>

#include <utility>
#include <vector>

#include "cloud/triangle_mesh.h"

// What operations do with the faces of a mesh: cut it along a mirror, close the cut, join parts.

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

/// Faces within a mirror that close a half where it is cut.
struct Cap {
  Points points;    ///< within the cut, behind those of the half
  Triangles faces;  ///< of points of the half and of these
  Index open = 0;   ///< curves of the cut that do not close: the shape ends at them
};

/// Triangles about as large as the faces of the half. Closed curves within others bound holes.
Cap cap_of(const Half& half, const Mirror& mirror, const Context& context);

/// A part that is added to a mesh beside its rims.
struct AddedPart {
  Index first;      ///< of its points, which stand behind those of the mesh
  Triangles faces;  ///< of points from `first` on
  /// One a point of it: whether the mesh is known to go on where it ends.
  std::vector<bool> meets_mesh;
};

/// Triangles between the rims of a mesh and of what was added to it, where the two face each other
/// or are closer than `touching` (input units); and in those holes that hold no added part because
/// they are too small, if all their points are `fillable`.
Triangles seam_between(PointsView points, const TriangleMesh& mesh, const AddedPart& added,
                       const std::vector<bool>& fillable, double touching, const Context& context);

/// Chooses among copies of points, which soups, flat shading and seams of textures have, so that
/// partners pair one to one wherever there are as many copies on both sides: those that mirrored
/// faces have at the same corner, the others by their order. `partners`: of each point one at the
/// position of its mirror point, or -1.
void pair_copies(PointsView points, TrianglesView faces, std::vector<Index>& partners,
                 const Context& context);

}  // namespace symsurf
