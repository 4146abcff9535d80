#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/math.h"
#include "base/named_values.h"
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

namespace {

void add_box(std::vector<Parameter>& parameters) {
  parameters.push_back(Parameter::position(
      "box_low", "Lowest corner of the box of points affected; equal corners: all points."));
  parameters.push_back(Parameter::position(
      "box_high", "Highest corner of the box of points affected; equal corners: all points."));
}

Box box(const ParameterValues& values) {
  const Vector3 low = values.vector("box_low"), high = values.vector("box_high");
  return low == high ? Box{} : Box{low, high};
}

Damaged all_kept(Points points) {
  Damaged damaged;
  damaged.kept.resize(points.rows());
  std::iota(damaged.kept.begin(), damaged.kept.end(), Index{0});
  damaged.points = std::move(points);
  return damaged;
}

Damage noise() {
  Damage damage;
  damage.name = "noise";
  damage.title = "Random noise";
  damage.summary = "Moves the points in a box in random directions (thesis 5.3).";
  damage.parameters = {
      Parameter::real("low", 0, 0, infinity, "", "The least distance a point is moved by."),
      Parameter::real("high", 0.1, 0, infinity, "", "The greatest distance a point is moved by."),
  };
  add_box(damage.parameters);
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t seed) {
    return all_kept(add_noise(points, values.real("low"), values.real("high"), box(values), seed));
  };
  return damage;
}

Damage removal() {
  Damage damage;
  damage.name = "removal";
  damage.title = "Remove points";
  damage.summary = "Removes points in a box at random (thesis 5.3).";
  damage.parameters = {Parameter::real("probability", 1, 0, 1, "",
                                       "Chance of each point in the box to be removed.")};
  add_box(damage.parameters);
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t seed) {
    return remove_points(points, values.real("probability"), box(values), seed);
  };
  return damage;
}

Damage rotation() {
  Damage damage;
  damage.name = "rotation";
  damage.title = "Rotate points";
  damage.summary = "Turns the points about the origin: about x, then y, then z.";
  damage.parameters = {
      Parameter::real("roll", 0, -infinity, infinity, "degrees", "Angle about the x axis."),
      Parameter::real("pitch", 0, -infinity, infinity, "degrees", "Angle about the y axis."),
      Parameter::real("yaw", 0, -infinity, infinity, "degrees", "Angle about the z axis."),
  };
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t) {
    return all_kept(rotate(points, values.real("roll"), values.real("pitch"), values.real("yaw")));
  };
  return damage;
}

Damage thinning() {
  Damage damage;
  damage.name = "thinning";
  damage.title = "Uneven density";
  damage.summary = "Keeps only some of the points of one half of the box.";
  Parameter direction =
      Parameter::direction("direction", "The half that lies this way is thinned.");
  direction.default_value = Vector3(1, 0, 0);
  damage.parameters = {
      Parameter::real("ratio", 10, 1, infinity, "", "One point in so many is kept there."),
      direction,
  };
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t seed) {
    return thin(points, values.real("ratio"), values.vector("direction"), seed);
  };
  return damage;
}

}  // namespace

const std::vector<Damage>& damages() {
  static const std::vector<Damage> list{noise(), removal(), rotation(), thinning()};
  return list;
}

Damaged damage(std::string_view name, PointsView points, const Values& parameters,
               std::uint64_t seed) {
  const Damage& kind = find_named(damages(), name, "damage");
  return kind.run(points, ParameterValues(kind.name, kind.parameters, parameters), seed);
}

}  // namespace symsurf
