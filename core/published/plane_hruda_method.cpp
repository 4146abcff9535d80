#include <symsurf/points.h>

#include <algorithm>
#include <memory>

#include "base/parallel.h"
#include "plane_iteration.h"
#include "search/registry.h"
#include "symmetry_measure.h"

namespace symsurf {

namespace {

using Coefficients = Eigen::Vector4d;  // (a, b, c, d), of lengths in l_avg about the centroid

// The greatest measure first.
struct MeasuredPlane {
  double measure;
  Coefficients plane;
  bool operator<(const MeasuredPlane& other) const { return measure > other.measure; }
};

constexpr double alike = 0.1;  // distance of the coefficients of planes that are averaged
constexpr int most_steps = 100;
constexpr double gained = 1e-10;  // share of the measure that a last step gains

// The planes that swap two of the points, similar ones averaged: the coefficients are added, or
// subtracted where the normals point apart.
std::vector<Coefficients> averaged_planes(const Points& points, const Context& context) {
  std::vector<Coefficients> sums, means;
  interruptible_for(
      context, points.rows(),
      [&](Index i) {
        for (Index j = i + 1; j < points.rows(); ++j) {
          const Vector3 normal = (points.row(i) - points.row(j)).transpose().normalized();
          if (normal.isZero(0)) continue;
          Coefficients plane;
          plane << normal, -normal.dot(points.row(i) + points.row(j)) / 2;
          std::size_t k = 0;
          double sign = 1;
          for (; k < means.size(); ++k) {
            sign = means[k].head<3>().dot(normal) < 0 ? -1 : 1;
            if ((means[k] - sign * plane).norm() < alike) break;
          }
          if (k == means.size()) {
            sums.push_back(plane);
            means.push_back(plane);
          } else {
            sums[k] += sign * plane;
            means[k] = sums[k] / sums[k].head<3>().norm();
          }
        }
      },
      1);
  return means;
}

// Climbs by the BFGS method with backtracking (Nocedal and Wright 2006, algorithms 6.1 and 3.1).
MeasuredPlane maximised(const SymmetryMeasure& measure, Coefficients p, const Context& context) {
  Coefficients slope;
  double value = measure(p, slope);
  if (slope.isZero(0)) return {value, p};
  Eigen::Matrix4d inverse_hessian = Eigen::Matrix4d::Identity() * (0.01 / slope.norm());
  for (int step = 0; step < most_steps; ++step) {
    context.check();
    const Coefficients direction = inverse_hessian * slope;
    Coefficients next, next_slope;
    double next_value = value;
    double length = 1;
    for (int halving = 0; halving < 8; ++halving, length /= 2) {
      next = p + length * direction;
      next_value = measure(next, next_slope);
      if (next_value >= value + 1e-4 * length * direction.dot(slope)) break;
    }
    if (!(next_value > value)) break;
    const bool rests = next_value - value < gained * value;
    const Coefficients moved = next - p, turned = slope - next_slope;
    const double curvature = moved.dot(turned);
    if (curvature > 0) {
      const Eigen::Matrix4d left =
          Eigen::Matrix4d::Identity() - moved * turned.transpose() / curvature;
      inverse_hessian =
          left * inverse_hessian * left.transpose() + moved * moved.transpose() / curvature;
    }
    p = next;
    value = next_value;
    slope = next_slope;
    if (rests) break;
  }
  return {value, p};
}

Result run_plane_hruda(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const Eigen::RowVector3d centroid = cloud.points.matrix().colwise().mean();
  Points points =
      downsample(cloud.points, values.integer("sample_size"), context).rowwise() - centroid;
  const double extent = points.rowwise().norm().mean();
  points /= extent;
  const SymmetryMeasure measure(points);

  std::vector<MeasuredPlane> candidates;
  for (const Coefficients& plane : averaged_planes(
           downsample(points, values.integer("paired_points"), context), context.stage(0, 0.1)))
    candidates.push_back({0, plane});
  parallel_for(context.stage(0.1, 0.5), static_cast<Index>(candidates.size()), 16,
               [&](Index begin, Index end) {
                 for (Index k = begin; k < end; ++k)
                   candidates[k].measure = measure(candidates[k].plane);
               });
  std::stable_sort(candidates.begin(), candidates.end());
  candidates.resize(
      std::min<std::size_t>(candidates.size(), static_cast<std::size_t>(values.integer("starts"))));
  for (MeasuredPlane& each : candidates) each = maximised(measure, each.plane, context);
  context.report(0.8);
  std::stable_sort(candidates.begin(), candidates.end());

  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const MeasuredPlane& each : candidates) {
    const Vector3 normal = each.plane.head<3>();
    mirrors.push_back(
        std::make_shared<Plane>(normal, each.plane[3] * extent - normal.dot(centroid)));
  }
  return ranked_planes("plane_hruda", cloud, mirrors, values, context.stage(0.8, 1));
}

}  // namespace

MethodImplementation plane_hruda_method() {
  MethodImplementation method;
  method.name = "plane_hruda";
  method.title = "Mirror plane by a differentiable measure (Hruda)";
  method.summary =
      "Maximises a smooth measure of symmetry of a thinned cloud from the best of the planes "
      "between pairs of its points (Hruda, Kolingerova and Vasa 2022).";
  method.parameters = {
      Parameter::integer("sample_size", 1000, 10, 10000, "points",
                         "Points at the least that the measure is taken over."),
      Parameter::integer("paired_points", 100, 3, 1000, "points",
                         "Points at the least between whose pairs planes are tried."),
      Parameter::integer("starts", 5, 1, 1000, "", "Planes that the measure is maximised from."),
      pair_distance(),
  };
  method.preprocessing = {.order_points = true};
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane_hruda;
  return method;
}

}  // namespace symsurf
