#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "base/radix_sort.h"
#include "cloud/cloud.h"
#include "cloud/surface_points.h"
#include "cloud/surfels.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {

namespace {

constexpr double noticeable = 0.12;   // noise, in spacings
constexpr Index most_smoothing = 60;  // neighbours

// To that share of the diagonal coordinates are rounded: far above the rounding of doubles, and far
// below what distinguishes an exact partner from others.
constexpr double quantum = 0x1p-30;

Points rounded(Points rows) { return (rows.array() / quantum).round() * quantum; }

Matrix3 right_handed(Matrix3 axes) {
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return axes;
}

// By x, then y, then z.
std::vector<std::int32_t> ascending(const Points& points, const Context& context) {
  std::vector<std::int32_t> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  const auto digits = [&](std::int32_t i, int axis) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(points(i, axis) / quantum) +
                                      (std::int64_t{1} << 31));
  };
  std::vector<std::uint64_t> keys(points.rows());
  for (Index i = 0; i < points.rows(); ++i) keys[i] = digits(order[i], 2);
  radix_sort(keys, order, context);
  for (Index i = 0; i < points.rows(); ++i)
    keys[i] = digits(order[i], 0) << 32 | digits(order[i], 1);
  radix_sort(keys, order, context);
  return order;
}

// The point of a quadratic fit nearest along the plane's normal to x, and the fit's normal there
// (a jet: Cazals and Pouget 2005).
void jet(const Points& points, const std::vector<Neighbour>& around, Vector3& x, Vector3& normal) {
  const Matrix3 axes = plane_through(points, around).axes;
  normal = axes.col(0);
  const double radius = std::sqrt(around.back().squared_distance);
  if (radius == 0) return;  // rounding made them one point
  QuadraticFit quadratic;
  for (const Neighbour& other : around) {
    const Vector3 d = axes.transpose() * (points.row(other.index).transpose() - x) / radius;
    quadratic.add(d.y(), d.z(), d.x(), 1.05 - d.squaredNorm());
  }
  const auto fit = quadratic.coefficients(0.01 * static_cast<double>(around.size()));
  x += radius * fit[0] * axes.col(0);
  normal = (axes * Vector3(1, -fit[1], -fit[2])).normalized();
}

// The points as they are searched, in the frame with these axes.
Points posed(const Cloud& cloud, const Matrix3& axes, Index most_points, const Context& context) {
  Points points;
  if (cloud.points.size() <= most_points) {
    points = cloud.frame.to_frame(cloud.points, context);
  } else {
    const Surfels& patches = cloud.patches(most_points, context);
    points.resize(patches.size(), 3);
    for (Index i = 0; i < points.rows(); ++i) points.row(i) = patches[i].sampled;
  }
  points.col(2) *= axes.col(2).dot(cloud.frame.axes.col(2));
  points = rounded(std::move(points));
  return chosen_rows(points, ascending(points, context));
}

}  // namespace

SearchCloud::SearchCloud(const Cloud& cloud, Index most_points, const Context& context)
    : SurfacePoints(
          posed(cloud, right_handed(cloud.frame.axes), most_points, context.stage(0, 0.1)),
          context.stage(0.1, 1), ring + 1),
      context(context),
      centroid(cloud.frame.centroid),
      axes(right_handed(cloud.frame.axes)),
      diagonal(cloud.frame.size),
      given_normals_(!cloud.normals.empty()) {
  spacing = std::max(spacing, single_rounding);  // doubled points are no spacing
  if (!given_normals_) return;
  const PointTree& all = cloud.tree(context);
  for (Index i = 0; i < size(); ++i) {
    const Index row = all.nearest(axes * point(i) * diagonal + centroid, infinity).index;
    normals.row(i) = cloud.normals[row].normalized().transpose() * axes;
  }
  normals = rounded(std::move(normals));
}

bool SearchCloud::noisy() const { return noise > noticeable * spacing; }

void SearchCloud::smooth(const Context& progress) {
  // The fit's error falls with the root of the neighbours' number.
  const double excess = noise / (noticeable * spacing);
  const Index count = std::min({size(), most_smoothing, static_cast<Index>(ring * excess)});
  Points smoothed = points, fitted = normals;
  constexpr Index grain = 256;
  parallel_for(progress.stage(0, 0.5), size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> around;
    for (Index p = begin; p < end; ++p) {
      const Index i = tree.order()[p];
      tree.nearest(point(i), count, around);
      Vector3 x = point(i), normal;
      jet(points, around, x, normal);
      smoothed.row(i) = x.transpose();
      if (!given_normals_) fitted.row(i) = normal.transpose();
    }
  });
  const double raw = noise;
  static_cast<SurfacePoints&>(*this) =
      SurfacePoints(std::move(smoothed), progress.stage(0.5, 1), ring + 1);
  spacing = std::max(spacing, single_rounding);
  noise = raw;
  normals = std::move(fitted);
}

}  // namespace symsurf::perpendicular
