#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/points.h>

#include "cloud/closest_point_on_mesh.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// Whether mirrors map a mesh onto itself: vertices onto vertices, to rounding, and the surface
/// nearly, as faces may divide its two sides along different diagonals.
class MeshSymmetry {
 public:
  /// `diagonal`: of the mesh. The vertices must outlive this.
  MeshSymmetry(PointsView vertices, TrianglesView faces, double diagonal, const Context& context);

  /// `samples`: of the surface.
  bool operator()(const Mirror& mirror, PointsView samples) const;

 private:
  PointsView vertices_;
  double diagonal_;
  PointTree tree_;
  ClosestPointOnMesh surface_;
};

}  // namespace symsurf
