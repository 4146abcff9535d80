#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

#include "cloud/triangle_mesh.h"

namespace symsurf {

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

}  // namespace symsurf
