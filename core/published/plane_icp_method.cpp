#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "plane_iteration.h"
#include "search/registry.h"

namespace symsurf {

namespace {

// Planes through the centroid: across the principal axes, then along a spiral over the half sphere
// (Vogel 1979), which covers it evenly.
std::vector<UnitPlane> even_starts(Index count) {
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<UnitPlane> starts;
  for (int axis = 0; axis < 3; ++axis) starts.push_back({Vector3::Unit(axis), 0});
  for (Index k = 0; k + 3 < count; ++k) {
    const double z = (static_cast<double>(k) + 0.5) / static_cast<double>(count - 3);
    const double angle = turn * static_cast<double>(k), r = std::sqrt(1 - z * z);
    starts.push_back({Vector3(r * std::cos(angle), r * std::sin(angle), z).normalized(), 0});
  }
  return starts;
}

Result run_plane_icp(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  std::vector<UnitPlane> starts = given_start(cloud, values);
  if (starts.empty()) starts = even_starts(values.integer("starts"));
  return iterated_planes("plane_icp", cloud, thinned_points(cloud, context.stage(0, 0.05)), starts,
                         robust_update, values, context.stage(0.05, 1));
}

}  // namespace

UnitPlane robust_update(const Correspondences& of, const UnitPlane& before) {
  constexpr double rounding = 1e-24;    // of a squared distance of exact partners
  constexpr double deviation = 1.4826;  // standard deviation over median of normal residuals
  std::vector<double> squared;
  for (const Neighbour& partner : of.partner) squared.push_back(partner.squared_distance);
  const double variance = std::max(deviation * deviation * median(std::move(squared)), rounding);

  Matrix3 sum = Matrix3::Zero();
  Vector3 middle = Vector3::Zero();
  double weights = 0;
  for (Index i = 0; i < of.points.rows(); ++i) {
    const Neighbour& partner = of.partner[i];
    const double weight = std::exp(-partner.squared_distance / (2 * variance));
    const Vector3 x = of.points.row(i).transpose(), y = of.points.row(partner.index).transpose();
    sum += weight * x * y.transpose();
    middle += weight / 2 * (x + y);
    weights += weight;
  }
  if (!(weights > 0)) return before;
  middle /= weights;
  // sum w (x - m)(y - m)', as w is the same for x and y: the terms of m add up to -sum(w) m m'.
  sum = (sum + sum.transpose()).eval() / 2 - weights * middle * middle.transpose();
  const Vector3 normal = eigen_of(sum).vectors.col(0);
  return {normal, -normal.dot(middle)};
}

MethodImplementation plane_icp_method() {
  MethodImplementation method;
  method.name = "plane_icp";
  method.title = "Mirror plane by reflective ICP (Combes)";
  method.summary =
      "Pairs each image with its closest point and solves for the plane directly, in turns, with "
      "robust weights (Combes et al. 2008).";
  method.parameters = {
      start_normal("Normal of the one plane to start from, through the centroid; (0, 0, 0): start "
                   "from many."),
      Parameter::integer("starts", 33, 3, 1000, "",
                         "Planes through the centroid to start from, evenly spread; without "
                         "normal."),
      pair_distance(),
  };
  method.preprocessing = {.order_points = true};
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane_icp;
  return method;
}

}  // namespace symsurf
