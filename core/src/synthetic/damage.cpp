#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "cloud/cloud.h"

namespace symsurf {

namespace {

void require_box(const Box& box) {
  if (!(box.low.array() <= box.high.array()).all())
    throw InvalidParameter("the box runs from " + to_string(Value(box.low)) + " to " +
                           to_string(Value(box.high)) +
                           "; its minimum must not exceed its maximum");
}

template <typename Keep>
Damaged kept_points(PointsView points, const Keep& keep) {
  Damaged damaged;
  for (Index i = 0; i < points.size(); ++i)
    if (keep(points[i])) damaged.kept.push_back(i);
  damaged.points.resize(static_cast<Index>(damaged.kept.size()), 3);
  for (Index row = 0; row < damaged.points.rows(); ++row)
    damaged.points.row(row) = points[damaged.kept[row]].transpose();
  return damaged;
}

}  // namespace

Points add_noise(PointsView points, double low, double high, const Box& box, std::uint64_t seed) {
  require_points(points);
  require_box(box);
  if (!(low >= 0) || !(low <= high) || !std::isfinite(high))
    throw InvalidParameter("noise from " + to_string(Value(low)) + " to " + to_string(Value(high)) +
                           "; allowed is 0 <= low <= high");
  Random random(seed);
  Points moved = points.matrix();
  for (Index i = 0; i < points.size(); ++i) {
    if (!box.holds(points[i])) continue;
    const Vector3 direction = random.direction();
    moved.row(i) += random.uniform(low, high) * direction.transpose();
  }
  return moved;
}

Damaged remove_points(PointsView points, double probability, const Box& box, std::uint64_t seed) {
  require_points(points);
  require_box(box);
  if (!(probability >= 0) || !(probability <= 1))
    throw InvalidParameter("probability is " + to_string(Value(probability)) +
                           "; allowed is [0, 1]");
  Random random(seed);
  return kept_points(
      points, [&](const Vector3& x) { return !box.holds(x) || random.uniform() >= probability; });
}

Matrix3 rotation_matrix(double roll, double pitch, double yaw) {
  for (const double angle : {roll, pitch, yaw})
    if (!std::isfinite(angle)) throw InvalidParameter("an angle is not finite");
  const auto about = [](double degrees, const Vector3& axis) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
  };
  return about(yaw, Vector3::UnitZ()) * about(pitch, Vector3::UnitY()) *
         about(roll, Vector3::UnitX());
}

Points rotate(PointsView points, double roll, double pitch, double yaw) {
  require_points(points);
  return points.matrix() * rotation_matrix(roll, pitch, yaw).transpose();
}

Damaged thin(PointsView points, double ratio, const Vector3& direction, std::uint64_t seed) {
  require_points(points);
  if (!(ratio >= 1) || !std::isfinite(ratio))
    throw InvalidParameter("ratio is " + to_string(Value(ratio)) + "; allowed is [1, inf)");
  if (!direction.allFinite() || direction.isZero(0))
    throw InvalidParameter("direction is " + to_string(Value(direction)) +
                           "; allowed is any finite vector but (0, 0, 0)");
  const Eigen::VectorXd along = points.matrix() * direction;
  const double middle = (along.minCoeff() + along.maxCoeff()) / 2;
  Random random(seed);
  return kept_points(points, [&](const Vector3& x) {
    return x.dot(direction) <= middle || random.uniform() * ratio < 1;
  });
}

}  // namespace symsurf
