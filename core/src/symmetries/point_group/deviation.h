#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>
#include <symsurf/triangles_view.h>

#include <optional>
#include <vector>

#include "mesh/closest_point_on_mesh.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// How far maps take a shape off itself: the greatest distance from the image of a vertex to the
/// surface, of a cloud from that of a point to the nearest point (Hodan et al. 2020, who call a map
/// a symmetry up to a limit of it).
class Deviation {
 public:
  /// The points must stay alive.
  Deviation(PointsView points, TrianglesView faces, const Context& context);

  /// Of each map, in the unit of the points; looks at about as many images in all.
  std::vector<double> of(const std::vector<Matrix4>& maps, Index looked,
                         const Context& context) const;

 private:
  double squared_distance(const Vector3& x) const;

  PointsView points_;
  std::vector<Index> vertices_;
  PointTree tree_;
  std::optional<ClosestPointOnMesh> surface_;
};

}  // namespace symsurf
