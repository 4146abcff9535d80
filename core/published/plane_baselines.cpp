#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "base/random.h"
#include "published.h"

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
      "Alternates between pairing each image with its closest point and solving for the plane with "
      "robust weights (Combes et al. 2008).";
  method.parameters = {
      start_normal("Normal of the only starting plane, through the centroid; (0, 0, 0): many "
                   "starting planes."),
      Parameter::integer("starts", 33, 3, 1000, "",
                         "Number of starting planes through the centroid, evenly spread; ignored "
                         "if normal is given."),
      pair_distance(),
  };
  method.preprocessing = {.order_points = true};
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane_icp;
  return method;
}

namespace {

constexpr std::size_t starts_kept = 8;
constexpr double near = 0.866;          // cosine of 30 degrees, from a normal that is asked for
constexpr Index looked_at = 100;        // points that a drawn plane is judged by
constexpr double nearly_as_far = 0.02;  // diagonals, of two points from the centroid
constexpr double off_cloud = 0.1;       // diagonals: an image farther than this has no partner

// Planes through the centroid that swap two drawn points that lie about equally far from it; kept
// are those that map drawn points closest to the cloud. Of planes that are asked for, those near
// them only, and they themselves.
std::vector<UnitPlane> drawn_starts(const Points& thinned, std::vector<UnitPlane> starts,
                                    Index draws, std::uint64_t seed, const Context& context) {
  struct Start {
    double cost;
    Index draw;
    UnitPlane plane;
    bool operator<(const Start& other) const {
      return cost != other.cost ? cost < other.cost : draw < other.draw;
    }
  };
  const PointTree tree(thinned, context.stage(0, 0));
  Random random(seed);
  const auto drawn = [&]() -> Vector3 {
    return thinned.row(random.below(thinned.rows())).transpose();
  };
  std::vector<Start> best;
  for (Index draw = 0; draw < draws; ++draw) {
    context.report(static_cast<double>(draw) / static_cast<double>(draws));
    const Vector3 a = drawn();
    Vector3 b = drawn();
    for (int again = 0; again < 20 && std::abs(a.norm() - b.norm()) > nearly_as_far; ++again)
      b = drawn();
    if (a == b) continue;
    const UnitPlane plane{(a - b).normalized(), 0};
    if (!starts.empty() && std::abs(plane.normal.dot(starts.front().normal)) < near) continue;
    double cost = 0;
    for (Index k = 0; k < looked_at; ++k)
      cost +=
          std::min(tree.nearest(plane.reflect(drawn())).squared_distance, off_cloud * off_cloud);
    keep_best(best, starts_kept, {cost, draw, plane});
  }
  for (const Start& start : best) starts.push_back(start.plane);
  if (starts.empty()) starts.emplace_back();
  return starts;
}

Result run_plane_svd(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const Points thinned = thinned_points(cloud, context.stage(0, 0.05));
  const std::vector<UnitPlane> starts =
      drawn_starts(thinned, given_start(cloud, values), values.integer("draws"), cloud.seed,
                   context.stage(0.05, 0.1));
  return iterated_planes("plane_svd", cloud, thinned, starts, mutual_update, values,
                         context.stage(0.1, 1));
}

}  // namespace

UnitPlane mutual_update(const Correspondences& of, const UnitPlane& before) {
  const auto is_mutual = [&](Index i) { return of.partner[of.partner[i].index].index == i; };
  Vector3 middle = Vector3::Zero();
  double count = 0;
  for (Index i = 0; i < of.points.rows(); ++i)
    if (is_mutual(i)) {
      middle += of.points.row(i).transpose();  // once as x, once as y
      ++count;
    }
  if (count == 0) return before;
  middle /= count;
  // The point of the plane before that is closest to the midpoints: c is any one of its points.
  const Vector3 c = middle - before.distance(middle) * before.normal;
  Matrix3 w = Matrix3::Zero();
  for (Index i = 0; i < of.points.rows(); ++i)
    if (is_mutual(i))
      w +=
          (of.points.row(of.partner[i].index).transpose() - c) * (of.points.row(i) - c.transpose());
  const Vector3 normal = eigen_of(w).vectors.col(0);
  return {normal, -normal.dot(middle)};
}

MethodImplementation plane_svd_method() {
  MethodImplementation method;
  method.name = "plane_svd";
  method.title = "Mirror plane by mutual pairs (Nagar)";
  method.summary =
      "Alternates between pairing images and points that are mutually closest and computing the "
      "reflection matrix in closed form, from random starts (Nagar and Raman 2020).";
  method.parameters = {
      start_normal("Normal of a plane through the centroid; random starts lie within 30 degrees of "
                   "it; (0, 0, 0): anywhere."),
      Parameter::integer("draws", 500, 1, 100000, "",
                         "Number of random pairs of points whose planes are tried as starts."),
      pair_distance(),
  };
  method.preprocessing = {.order_points = true};
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane_svd;
  return method;
}

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
      "Maximises a smooth symmetry measure of a downsampled cloud, starting from the best planes "
      "between pairs of its points (Hruda, Kolingerova and Vasa 2022).";
  method.parameters = {
      Parameter::integer("sample_size", 1000, 10, 10000, "points",
                         "Minimum number of points over which the measure is computed."),
      Parameter::integer("paired_points", 100, 3, 1000, "points",
                         "Minimum number of points whose pairs give the planes tried."),
      Parameter::integer("starts", 5, 1, 1000, "",
                         "Number of planes from which the measure is maximised."),
      pair_distance(),
  };
  method.preprocessing = {.order_points = true};
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane_hruda;
  return method;
}

}  // namespace symsurf
