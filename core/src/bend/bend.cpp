#include <symsurf/bend.h>

#include <limits>

#include "chart.h"

namespace symsurf {

Points bend(PointsView points, const Mirror& mirror, Bend way) {
  const std::unique_ptr<Chart> chart = chart_of(mirror, points);
  const Matrix3& axes = chart->axes();
  Points out = Points::Constant(points.size(), 3, std::numeric_limits<double>::quiet_NaN());
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 x = points[i];
    if (way == Bend::Straighten) {
      const Vector3 foot = mirror.foot(x);
      if (!foot.allFinite()) continue;
      const Eigen::Vector2d at = chart->flatten(foot);
      out.row(i) =
          (chart->origin() + axes * Vector3(at.x(), at.y(), mirror.signed_distance(x))).transpose();
    } else {
      const Vector3 at = axes.transpose() * (x - chart->origin());
      Vector3 foot, normal;
      if (chart->lift(at.head<2>(), foot, normal))
        out.row(i) = (foot + at.z() * normal).transpose();
    }
  }
  return out;
}

Plane straight_mirror(const Mirror& mirror, PointsView object) {
  const std::unique_ptr<Chart> chart = chart_of(mirror, object);
  const Vector3 normal = chart->axes().col(2);
  return Plane(normal, -normal.dot(chart->origin()));
}

}  // namespace symsurf
