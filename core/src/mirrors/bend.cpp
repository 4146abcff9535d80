#include <symsurf/bend.h>

#include <limits>

#include "mirrors/chart.h"

namespace symsurf {

namespace {

// Where the footprint lies about the origin and is 1 long: as exact there as where the object lies,
// in whatever unit.
class Workplace {
 public:
  Workplace(const Mirror& mirror, PointsView points) {
    const PointsView object = mirror.footprint().empty() ? points : mirror.footprint();
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (Index i = 0; i < object.size(); ++i) {
      if (!object[i].allFinite()) continue;
      low = low.cwiseMin(object[i]);
      high = high.cwiseMax(object[i]);
    }
    if ((low.array() <= high.array()).all()) centre_ = low + (high - low) / 2;
    if ((low.array() < high.array()).any()) extent_ = (high - low).maxCoeff();
    Points entered(object.size(), 3);
    for (Index i = 0; i < object.size(); ++i) entered.row(i) = to_frame(object[i]).transpose();
    mirror_ = mirror.transformed(1 / extent_, Matrix3::Identity(), -centre_ / extent_);
    chart_ = chart_of(*mirror_, entered);
  }

  Vector3 to_frame(const Vector3& x) const { return (x - centre_) / extent_; }
  Vector3 from_frame(const Vector3& x) const { return centre_ + extent_ * x; }
  const Mirror& mirror() const { return *mirror_; }
  const Chart& chart() const { return *chart_; }

 private:
  Vector3 centre_ = Vector3::Zero();
  double extent_ = 1;
  std::unique_ptr<Mirror> mirror_;
  std::unique_ptr<Chart> chart_;
};

Vector3 straightened(const Vector3& x, const Mirror& mirror, const Chart& chart) {
  const Vector3 foot = mirror.foot(x);
  const Eigen::Vector2d at = chart.flatten(foot);
  return chart.origin() + chart.axes() * Vector3(at.x(), at.y(), mirror.signed_distance(x));
}

Vector3 restored(const Vector3& x, const Chart& chart) {
  const Vector3 at = chart.axes().transpose() * (x - chart.origin());
  Vector3 foot, normal;
  if (!chart.lift(at.head<2>(), foot, normal))
    return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  return foot + at.z() * normal;
}

}  // namespace

Points bend(PointsView points, const Mirror& mirror, Bend way) {
  const Workplace position(mirror, points);
  Points out(points.size(), 3);
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 x = position.to_frame(points[i]);
    const Vector3 carried = way == Bend::Straighten
                                ? straightened(x, position.mirror(), position.chart())
                                : restored(x, position.chart());
    out.row(i) = position.from_frame(carried).transpose();
  }
  return out;
}

Plane straight_mirror(const Mirror& mirror, PointsView object) {
  const Workplace position(mirror, object);
  const Vector3 normal = position.chart().axes().col(2);
  return Plane(normal, -normal.dot(position.from_frame(position.chart().origin())));
}

}  // namespace symsurf
