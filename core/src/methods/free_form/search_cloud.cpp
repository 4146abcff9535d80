#include "methods/free_form/search_cloud.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "base/math.h"
#include "base/radix_sort.h"
#include "base/semidefinite_solve.h"

namespace symsurf::perpendicular {

namespace {

constexpr int spacing_neighbour = 6;
constexpr double noticeable = 0.12;   // noise, in spacings
constexpr Index most_smoothing = 60;  // neighbours

double spacing_from(double sixth_squared) {
  return std::sqrt(sixth_squared) / std::sqrt(spacing_neighbour / std::numbers::pi);
}

// The spacing of a big cloud, from some of its points.
double sampled_spacing(PointsView points, const Context& context) {
  constexpr Index samples = 500;
  const PointTree tree(points, context);
  const Index step = std::max<Index>(1, points.size() / samples);
  std::vector<double> spacings;
  std::vector<Neighbour> found;
  for (Index p = 0; p < points.size(); p += step) {
    tree.nearest(points[tree.order()[p]], std::min<Index>(spacing_neighbour + 1, points.size()),
                 found);
    spacings.push_back(spacing_from(found.back().squared_distance));
  }
  return median(spacings);
}

// Every point that lies at least `radius` from those taken before it, starting far from the centre:
// an order that turns with the object.
std::vector<Index> spread_out(PointsView points, const Vector3& centre, double radius,
                              const Context& context) {
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

std::vector<Index> chosen(PointsView points, const Vector3& centre, Index most,
                          const Context& context) {
  std::vector<Index> all(points.size());
  std::iota(all.begin(), all.end(), Index{0});
  if (points.size() <= most) return all;
  // Points at random are 0.75 of a lattice's spacing apart when thinned to the same number.
  double radius = 0.75 * sampled_spacing(points, context) *
                  std::sqrt(static_cast<double>(points.size()) / static_cast<double>(most));
  std::vector<Index> taken = spread_out(points, centre, radius, context);
  while (static_cast<Index>(taken.size()) > most + most / 4) {
    radius *= std::sqrt(static_cast<double>(taken.size()) / static_cast<double>(most));
    taken = spread_out(points, centre, radius, context);
  }
  return taken;
}

Points unit_frame(PointsView points, const std::vector<Index>& chosen, const Vector3& centre,
                  double diagonal) {
  Points out(static_cast<Index>(chosen.size()), 3);
  for (Index i = 0; i < out.rows(); ++i)
    out.row(i) = ((points[chosen[i]] - centre) / diagonal).transpose();
  return out;
}

// A plane through a neighbourhood, and how far its points scatter about it.
struct Surfel {
  Matrix3 axes;  // columns: normal first
  Vector3 mean;
  double scatter = 0;
};

Surfel surfel(const Points& points, const std::vector<Neighbour>& around) {
  Surfel s;
  s.mean.setZero();
  for (const Neighbour& other : around) s.mean += points.row(other.index).transpose();
  s.mean /= static_cast<double>(around.size());
  Matrix3 scatter = Matrix3::Zero();
  for (const Neighbour& other : around) {
    const Vector3 d = points.row(other.index).transpose() - s.mean;
    scatter += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Matrix3> axes;
  axes.computeDirect(scatter);
  s.axes = axes.eigenvectors();
  // Three numbers of the plane are fitted.
  const double free = std::max<double>(1, static_cast<double>(around.size()) - 3);
  s.scatter = std::sqrt(std::max(0.0, axes.eigenvalues()[0]) / free);
  return s;
}

// The point of a quadratic fit nearest along the surfel's normal to x, and the fit's normal there
// (a jet: Cazals and Pouget 2005).
void jet(const Points& points, const std::vector<Neighbour>& around, const Surfel& surfel,
         Vector3& x, Vector3& normal) {
  using Row = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Row right = Row::Zero();
  const double radius = std::sqrt(around.back().squared_distance);
  for (const Neighbour& other : around) {
    const Vector3 d = surfel.axes.transpose() * (points.row(other.index).transpose() - x) / radius;
    const double weight = 1.05 - d.squaredNorm();
    Row row;
    row << 1, d.y(), d.z(), d.y() * d.y(), d.y() * d.z(), d.z() * d.z();
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    right += weight * d.x() * row;
  }
  for (int k = 3; k < 6; ++k) matrix(k, k) += 0.01 * static_cast<double>(around.size());
  const Row fit = solved(matrix, right);
  x += radius * fit[0] * surfel.axes.col(0);
  normal = (surfel.axes * Vector3(1, -fit[1], -fit[2])).normalized();
}

}  // namespace

SearchCloud::SearchCloud(const Cloud& cloud, Index most_points, const Context& context)
    : context(context),
      centroid(cloud.points.matrix().colwise().mean()),
      diagonal(cloud.diagonal),
      source(chosen(cloud.points, centroid, most_points, context.stage(0, 0.1))),
      points(unit_frame(cloud.points, source, centroid, diagonal)),
      tree(points, context.stage(0.1, 0.2)) {
  measure();
  given_normals_ = !cloud.normals.empty();
  for (Index i = 0; given_normals_ && i < size(); ++i)
    normals.row(i) = cloud.normals[source[i]].normalized().transpose();
}

bool SearchCloud::noisy() const { return noise > noticeable * spacing; }

// Neighbours, spacing, normals and noise of the points as they are.
void SearchCloud::measure() {
  neighbours.resize(size(), ring);
  local_spacing.resize(size());
  normals.resize(size(), 3);
  std::vector<double> scatters(size());
  std::vector<Neighbour> around;
  for (Index p = 0; p < size(); ++p) {
    context.check();
    const Index i = tree.order()[p];
    tree.nearest(point(i), std::min<Index>(ring + 1, size()), around);
    local_spacing[i] = spacing_from(
        around[std::min<std::size_t>(spacing_neighbour, around.size() - 1)].squared_distance);
    const Surfel s = surfel(points, around);
    normals.row(i) = s.axes.col(0).transpose();
    scatters[i] = s.scatter;
    int column = 0;
    for (const Neighbour& other : around)
      if (other.index != i && column < ring)
        neighbours(i, column++) = static_cast<std::int32_t>(other.index);
    for (; column < ring; ++column) neighbours(i, column) = static_cast<std::int32_t>(i);
  }
  // Doubled points are no spacing.
  spacing = std::max(median(local_spacing), 1e-6);
  noise = median(scatters);
}

void SearchCloud::smooth() {
  // The fit's error falls with the root of the neighbours' number.
  const double excess = noise / (noticeable * spacing);
  const Index count = std::min({size(), most_smoothing, static_cast<Index>(ring * excess)});
  Points smoothed = points, fitted = normals;
  std::vector<Neighbour> around;
  for (Index p = 0; p < size(); ++p) {
    context.check();
    const Index i = tree.order()[p];
    tree.nearest(point(i), count, around);
    Vector3 x = point(i), normal;
    jet(points, around, surfel(points, around), x, normal);
    smoothed.row(i) = x.transpose();
    if (!given_normals_) fitted.row(i) = normal.transpose();
  }
  const double raw = noise;
  points = smoothed;
  tree = PointTree(points);
  measure();
  noise = raw;
  normals = fitted;
}

}  // namespace symsurf::perpendicular
