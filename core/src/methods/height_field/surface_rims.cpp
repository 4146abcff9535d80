#include "methods/height_field/surface_rims.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/semidefinite_solve.h"

namespace symsurf {

namespace {

constexpr Index rim_neighbours = 24, looked_at = 56;
constexpr double on_the_rim = 0.42;   // lean
constexpr double least_lean = 0.2;    // chance leans as much inside a surface
constexpr double lean_a_reach = 0.5;  // that is lost going inwards
constexpr double same_surface = 0.6;  // cosine between normals
constexpr double thickness = 0.35;    // of a surface, against the reach
constexpr double end_on = 0.1;        // sine below which a rim is seen end-on

constexpr double inside = 0.6;             // reaches, of a point that sees no rim
constexpr double near_rim = 0.5;           // reaches
constexpr double opposed = 1.2;            // sum of the inward directions of two different rims
constexpr double prior_turn = 0.1;         // radians
constexpr double prior_difference = 0.02;  // diagonals

}  // namespace

SurfaceRims::SurfaceRims(const SurfacePoints& cloud)
    : cloud_(cloud), lean_(Points::Zero(cloud.size(), 3)), reach_(cloud.size()) {
  std::vector<Neighbour> near;
  for (Index i = 0; i < cloud.size(); ++i) {
    const Vector3 normal = cloud.normal(i);
    cloud.tree.nearest(cloud.point(i), looked_at, near);
    Vector3 sum = Vector3::Zero();
    Index count = 0;
    for (const Neighbour& n : near) {
      const Vector3 d = cloud.point(n.index) - cloud.point(i);
      const double off = normal.dot(d);
      const double far = std::sqrt(n.squared_distance);
      if (n.index == i || std::abs(off) > std::max(thickness * far, 0.5 * cloud.spacing) ||
          std::abs(normal.dot(cloud.normal(n.index))) < same_surface)
        continue;
      sum += d - off * normal;
      reach_[i] = far;
      if (++count == rim_neighbours) break;
    }
    if (count > 0) lean_.row(i) = (sum / static_cast<double>(count) / reach_[i]).transpose();
  }
}

bool SurfaceRims::seen_across(Index i, const Eigen::Matrix<double, 3, 2>& across, Rim& rim) const {
  const Vector3 lean = lean_.row(i).transpose();
  const double size = lean.norm();
  if (size < least_lean) return false;
  const Vector3 inwards = lean / size;
  const Eigen::Vector2d along = across.transpose() * cloud_.normal(i).cross(inwards);
  const double length = along.norm();
  if (!(length > end_on)) return false;
  const Eigen::Vector2d flat = across.transpose() * inwards;
  const Eigen::Vector2d square = flat - along * (along.dot(flat) / (length * length));
  const double shortened = square.norm();
  if (!(shortened > end_on)) return false;
  rim.inwards = square / shortened;
  rim.reach = reach_[i] * shortened;
  rim.distance = std::max(0.0, (on_the_rim - size) / lean_a_reach) * rim.reach;
  return true;
}

void RimAlignment::add(Index point, Index partner, const Eigen::Vector2d& aside, double arm,
                       double weight) {
  SurfaceRims::Rim own, other;
  const bool own_seen = rims_.seen_across(point, across_, own);
  const bool other_seen = rims_.seen_across(partner, across_, other);
  if (!own_seen && !other_seen) return;
  if (!own_seen) own = {other.inwards, inside * other.reach, other.reach};
  if (!other_seen) other = {own.inwards, inside * own.reach, own.reach};
  Eigen::Vector2d inwards = own.inwards + other.inwards;
  if (inwards.norm() < opposed) return;
  inwards.normalize();
  const double reach = (own.reach + other.reach) / 2;
  const double image = other.distance - (other_seen ? inwards.dot(aside) : 0.0);
  if (image + own.distance > 2 * near_rim * reach) return;
  Vector3 row;
  row << arm * inwards, std::copysign(prior_difference, arm);
  weight /= reach * reach;
  normal_ += weight * row * row.transpose();
  right_ -= weight * (image - own.distance) * row;
}

Eigen::Vector2d RimAlignment::turn(const Eigen::Vector2d& start) const {
  constexpr double prior = 1 / (prior_turn * prior_turn);
  Matrix3 normal = normal_;
  normal.diagonal() += Vector3(prior, prior, 1);
  Vector3 right = right_;
  right.head<2>() += prior * start;
  return solved(normal, right).head<2>();
}

}  // namespace symsurf
