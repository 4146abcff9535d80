#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "base/radix_sort.h"
#include "cloud/cloud.h"
#include "cloud/surface_points.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {

namespace {

constexpr double noticeable = 0.12;     // noise, in spacings
constexpr Index most_smoothing = 60;    // neighbours
constexpr double least_spacing = 1e-6;  // diagonals: doubled points are no spacing

// The spacing of a big cloud, from some of its points: spread over it in whatever order they are.
double sampled_spacing(PointsView points, const Context& context) {
  constexpr Index samples = 500;
  const PointTree tree(points, context);
  const Index step = std::max<Index>(1, points.size() / samples);
  std::vector<double> spacings;
  std::vector<Neighbour> found;
  for (Index p = 0; p < points.size(); p += step) {
    tree.nearest(points[tree.order()[p]], SurfacePoints::ring, found);
    spacings.push_back(spacing_at(found));
  }
  return median(std::move(spacings));
}

Vector3 centroid_of(PointsView points) { return points.matrix().colwise().mean(); }

// Every point that lies at least `radius` from those taken before it, starting far from the centre:
// an order that turns with the object.
std::vector<Index> spread_out(PointsView points, double radius, const Context& context) {
  const Vector3 centre = centroid_of(points);
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  // Bits of doubles above 0 are in the doubles' order: the farthest has the lowest complement.
  std::vector<std::uint64_t> nearness(points.size());
  for (Index i = 0; i < points.size(); ++i)
    nearness[i] = ~std::bit_cast<std::uint64_t>((points[i] - centre).squaredNorm());
  radix_sort(nearness, order, context);

  const auto cell = [&](const Vector3& x) {
    return Eigen::Matrix<std::int64_t, 3, 1>(
        ((x - centre) / radius).array().floor().cast<std::int64_t>());
  };
  const auto key = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return ((x + (1 << 20)) << 42) ^ ((y + (1 << 20)) << 21) ^ (z + (1 << 20));
  };
  std::unordered_multimap<std::int64_t, Index> grid;
  std::vector<Index> taken;
  for (const Index i : order) {
    context.check();
    const auto c = cell(points[i]);
    bool free = true;
    for (int dx = -1; dx <= 1 && free; ++dx)
      for (int dy = -1; dy <= 1 && free; ++dy)
        for (int dz = -1; dz <= 1 && free; ++dz) {
          const auto [first, last] = grid.equal_range(key(c.x() + dx, c.y() + dy, c.z() + dz));
          for (auto other = first; other != last && free; ++other)
            free = (points[other->second] - points[i]).squaredNorm() >= radius * radius;
        }
    if (!free) continue;
    grid.emplace(key(c.x(), c.y(), c.z()), i);
    taken.push_back(i);
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

constexpr double least_radius = 0x1p-19;  // of the diagonal: cells have 20 bits an axis and a sign

std::vector<Index> thinned(PointsView points, Index most, const Context& context) {
  std::vector<Index> all(points.size());
  std::iota(all.begin(), all.end(), Index{0});
  if (points.size() <= most) return all;
  // Points at random are 0.75 of a lattice's spacing apart when thinned to the same number.
  double radius = 0.75 * sampled_spacing(points, context) *
                  std::sqrt(static_cast<double>(points.size()) / static_cast<double>(most));
  radius = std::max(radius, least_radius * diagonal_of(points));
  std::vector<Index> taken = spread_out(points, radius, context);
  while (static_cast<Index>(taken.size()) > most + most / 4) {
    radius *= std::sqrt(static_cast<double>(taken.size()) / static_cast<double>(most));
    taken = spread_out(points, radius, context);
  }
  return taken;
}

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

}  // namespace

SearchCloud::Posed::Posed(const Cloud& cloud, const Context& context)
    : axes(right_handed(cloud.frame.axes)) {
  points.resize(cloud.points.size(), 3);
  interruptible_for(context, points.rows(), [&](Index i) {
    points.row(i) = (axes.transpose() * (cloud.points[i] - cloud.frame.centroid) / cloud.frame.size)
                        .transpose();
  });
  points = rounded(std::move(points));
  order = ascending(points, context);
  points = chosen_rows(points, order);
}

SearchCloud::SearchCloud(const Cloud& cloud, Index most_points, const Context& context)
    : SearchCloud(cloud, Posed(cloud, context.stage(0, 0.05)), most_points, context) {}

SearchCloud::SearchCloud(const Cloud& cloud, const Posed& posed, Index most_points,
                         const Context& context)
    : SearchCloud(cloud, posed, thinned(posed.points, most_points, context.stage(0.05, 0.1)),
                  context) {}

SearchCloud::SearchCloud(const Cloud& cloud, const Posed& posed, const std::vector<Index>& rows,
                         const Context& context)
    : SurfacePoints(chosen_rows(posed.points, rows), context.stage(0.1, 1), ring + 1),
      context(context),
      centroid(cloud.frame.centroid),
      axes(posed.axes),
      diagonal(cloud.frame.size),
      given_normals_(!cloud.normals.empty()) {
  spacing = std::max(spacing, least_spacing);
  if (!given_normals_) return;
  for (Index i = 0; i < size(); ++i)
    normals.row(i) = cloud.normals[posed.order[rows[i]]].normalized().transpose() * axes;
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
  spacing = std::max(spacing, least_spacing);
  noise = raw;
  normals = std::move(fitted);
}

}  // namespace symsurf::perpendicular
