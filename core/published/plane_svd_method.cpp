#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/random.h"
#include "plane_iteration.h"
#include "search/registry.h"

namespace symsurf {

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
      "Keeps the mutual pairs of images and their closest points and takes the reflection matrix "
      "in "
      "closed form, in turns, from random starts (Nagar and Raman 2020).";
  method.parameters = {
      start_normal(
          "Starts are drawn within 30 degrees of this normal of a plane through the centroid; "
          "(0, 0, 0): anywhere."),
      Parameter::integer("draws", 500, 1, 100000, "",
                         "Random pairs whose planes are tried as starts."),
      pair_distance(),
  };
  method.preprocessing = {.order_points = true};
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane_svd;
  return method;
}

}  // namespace symsurf
