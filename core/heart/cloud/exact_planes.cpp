#include "cloud/exact_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "cloud/distinct_points.h"

namespace symsurf {

namespace {

constexpr double least_angle = 1e-3;   // between the directions of two points, radians
constexpr std::size_t farthest = 512;  // points that are looked at

// Points that lie equally far from the centroid.
using Shell = std::vector<Vector3>;

// The outermost shells, each whole.
std::vector<Shell> outer_shells(const Cloud& cloud) {
  const auto farther = [](const Vector3& a, const Vector3& b) {
    return a.squaredNorm() > b.squaredNorm();
  };
  std::vector<Vector3> points;
  double least = 0;
  const auto keep_farthest = [&] {
    if (points.size() <= farthest) return;
    std::nth_element(points.begin(), points.begin() + farthest, points.end(), farther);
    points.resize(farthest);
    least = std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
              return farther(b, a);
            })->squaredNorm();
  };
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.to_frame(cloud.points[i]);
    if (x.squaredNorm() < least) continue;
    points.push_back(x);
    if (points.size() >= 4 * farthest) keep_farthest();
  }
  keep_farthest();
  const bool is_all = static_cast<Index>(points.size()) == cloud.points.size();
  std::stable_sort(points.begin(), points.end(), farther);
  if (points.size() > farthest) points.resize(farthest);

  std::vector<Shell> shells;
  double radius = 0;
  for (const Vector3& x : points) {
    if (shells.empty() || radius - x.norm() > single_rounding) shells.emplace_back();
    radius = x.norm();
    if (radius > single_rounding) shells.back().push_back(x);
  }
  if (!is_all && !shells.empty()) shells.pop_back();  // it may go on farther in
  return shells;
}

// Unit normals of the planes through the centroid that may map the shells onto themselves.
std::vector<Vector3> possible_normals(std::vector<Shell> shells) {
  std::vector<Vector3> normals;
  std::erase_if(shells, [](const Shell& shell) { return shell.empty(); });
  std::stable_sort(shells.begin(), shells.end(),
                   [](const Shell& a, const Shell& b) { return a.size() < b.size(); });
  if (shells.empty()) return normals;
  const auto add_bisectors = [&](const Shell& shell, const Vector3& a) {
    for (const Vector3& other : shell)
      if ((other - a).norm() > single_rounding) normals.push_back((other - a).normalized());
  };
  const Vector3& a = shells.front().front();
  add_bisectors(shells.front(), a);
  for (const Shell& shell : shells)
    for (const Vector3& b : shell) {
      const Vector3 across = a.normalized().cross(b.normalized());
      if (across.norm() < least_angle) continue;
      add_bisectors(shell, b);
      normals.push_back(across.normalized());
      return normals;
    }
  return normals;
}

// Drops the planes that move some of the positions elsewhere than onto points.
void keep_exact(std::vector<UnitPlane>& planes, const Points& positions, const Cloud& cloud,
                const NearestPoints& points) {
  std::vector<Vector3> images;
  for (const UnitPlane& plane : planes)
    for (Index i = 0; i < positions.rows(); ++i)
      images.push_back(cloud.frame.from_frame(plane.reflect(positions.row(i).transpose())));
  const std::vector<Vector3> partners = points.nearest(images, single_rounding * cloud.frame.size);
  std::size_t k = 0;
  std::erase_if(planes, [&](const UnitPlane&) {
    bool exact = true;
    for (Index i = 0; i < positions.rows(); ++i) exact = partners[k++].allFinite() && exact;
    return !exact;
  });
}

}  // namespace

std::vector<UnitPlane> exact_planes(const Cloud& cloud, const NearestPoints& points,
                                    const Surfels& samples) {
  std::vector<UnitPlane> planes;
  for (const Vector3& normal : possible_normals(outer_shells(cloud))) planes.push_back({normal, 0});
  for (const Index count : {Index{4}, Index{64}, samples.size()}) {
    Points positions(std::min(count, samples.size()), 3);
    for (Index k = 0; k < positions.rows(); ++k)
      positions.row(k) = samples[k * samples.size() / positions.rows()].sampled.transpose();
    keep_exact(planes, positions, cloud, points);
  }
  suppress_non_maxima(planes, planes.size(), [](const UnitPlane& plane, const UnitPlane& other) {
    return plane.normal.cross(other.normal).norm() < least_angle;
  });
  // A flat cloud's own plane moves nothing.
  std::erase_if(planes, [&](const UnitPlane& plane) {
    for (Index k = 0; k < samples.size(); ++k)
      if (std::abs(plane.distance(samples[k].sampled)) > single_rounding) return false;
    return true;
  });
  return planes;
}

// How often a file repeats a point must not move the centroid.
std::vector<Plane> exact_planes(PointsView points, const Context& context) {
  const Points distinct = chosen_rows(points, distinct_points(points, context).first);
  const Cloud cloud = checked_cloud(distinct, {}, 1, context);
  const PointTree tree(distinct, context);
  std::vector<Plane> planes;
  for (const UnitPlane& plane : exact_planes(cloud, NearestPoints(distinct, tree, context),
                                             Surfels(cloud, distinct.rows(), context)))
    planes.push_back(in_input_units(plane, cloud.frame));
  return planes;
}

}  // namespace symsurf
