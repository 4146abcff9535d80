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

/// The edges on the mirror that end the faces of a half, from vertex to vertex in their winding:
/// an odd number of faces has them, those of an even number close there without their images.
std::vector<std::pair<Index, Index>> cut_edges(const Triangles& faces,
                                               const std::vector<bool>& on_mirror);

/// A half and its image.
struct MirroredHalf : Half {
  std::vector<Index> partners;  ///< of each point its image, itself on the mirror
};

/// Adds the image of a half: points on the mirror belong to both, so that a closed surface stays
/// closed. Throws InvalidInput where points have no image.
MirroredHalf with_image(Half half, const Mirror& mirror, const Context& context);

/// The parameter that says which side is kept, and what it says.
Parameter kept_side();
bool keeps_positive(const ParameterValues& values);

/// Puts points and faces, and where they come from, in place of those of the input; of the whole
/// the array "partner", too.
void set_shape(Half half, OperationResult& result);
void set_shape(MirroredHalf whole, OperationResult& result);

/// A part that is added to a mesh beside its rims.
struct AddedPart {
  Index first;      ///< of its points, which stand behind those of the mesh
  Triangles faces;  ///< of points from `first` on
  /// One a point of it: whether the mesh is known to go on where it ends.
  std::vector<bool> meets_mesh;
};

/// Triangles between the rims of a mesh and of what was added to it, where the two face each other
/// or are closer than `touching` (input units).
Triangles seam_between(PointsView points, const TriangleMesh& mesh, const AddedPart& added,
                       double touching, const Context& context);

/// Chooses among copies of points, which soups, flat shading and seams of textures have, so that
/// partners pair one to one wherever there are as many copies on both sides: those that mirrored
/// faces have at the same corner, the others by their order. `partners`: of each point one at the
/// position of its mirror point, or -1.
void pair_copies(PointsView points, TrianglesView faces, std::vector<Index>& partners,
                 const Context& context);

}  // namespace symsurf
