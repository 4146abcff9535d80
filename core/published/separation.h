#pragma once

#include <symsurf/detect.h>
#include <symsurf/parameter.h>

#include <cstdint>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// The line through a point along a unit direction, as the thesis's Algorithms 1 to 3 measure from
/// it; `diagonal` is that of the cloud.
struct Line {
  Vector3 start, direction;
  double diagonal;

  double squared_distance(const Vector3& x) const {
    const Vector3 w = x - start, u = direction;
    const double along = w.x() * u.x() + w.y() * u.y() + w.z() * u.z();
    const Vector3 r = w - along * u;
    return r.x() * r.x() + r.y() * r.y() + r.z() * r.z();
  }

  /// The square of how far a tree has to look for what beats `best` or ties with it. A projection
  /// rounds distances by some 1e-15 diagonals, which this allows for many times over.
  double reach(const Neighbour& best) const {
    return best.squared_distance * (1 + 1e-12) + 1e-16 * diagonal * diagonal;
  }
};

/// The result of the thesis's Algorithms 1 to 3: points with their partners, the distances of these
/// from their lines, the midpoints. `partners` by index of the point; -1: has none.
///
/// The score, 0 to 1, is the share of the points that a smooth surface through the midpoints
/// mirrors onto their partners, to within the spacing of the points; points nearer to the surface
/// than that do not count.
Result midpoint_pairs(const Cloud& cloud, const std::vector<Neighbour>& partners,
                      const Context& context);

/// The parameters of Algorithms 2 and 3: how normals are estimated where none are given.
std::vector<Parameter> normal_parameters();

/// Unit normals, the cloud's own or estimated as the parameters say.
Points given_or_estimated_normals(const Cloud& cloud, const ParameterValues& values,
                                  const Context& context);

}  // namespace symsurf
