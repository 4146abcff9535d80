#include "cloud/surface_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/voxel_grid.h"

namespace symsurf {

namespace {

constexpr std::size_t sixth = 6;

double spacing_from(double sixth_distance) {
  return sixth_distance / std::sqrt(static_cast<double>(sixth) / std::numbers::pi);
}

}  // namespace

double spacing_at(const std::vector<Neighbour>& neighbourhood) {
  const std::size_t rank = std::min(sixth, neighbourhood.size() - 1);
  return spacing_from(std::sqrt(neighbourhood[rank].squared_distance));
}

double surface_spacing(PointsView points, const PointTree& tree, Index copies) {
  constexpr Index samples = 2000;
  const Index neighbours = std::min(copies * static_cast<Index>(sixth + 1), points.size());
  const Index step = std::max<Index>(1, points.size() / samples);
  std::vector<double> distances;
  std::vector<Neighbour> found;
  for (Index i = 0; i < points.size(); i += step) {
    tree.nearest(points[i], neighbours, found);
    distances.push_back(std::sqrt(found.back().squared_distance));
  }
  return spacing_from(median(std::move(distances)));
}

LocalPlane plane_through(const Points& points, std::span<const Neighbour> neighbourhood) {
  Vector3 mean = Vector3::Zero();
  for (const Neighbour& n : neighbourhood) mean += points.row(n.index).transpose();
  mean /= static_cast<double>(neighbourhood.size());
  Matrix3 scatter = Matrix3::Zero();
  for (const Neighbour& n : neighbourhood) {
    const Vector3 d = points.row(n.index).transpose() - mean;
    scatter += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Matrix3> eigen;
  eigen.computeDirect(scatter);
  // Three numbers of the plane are fitted.
  const double free = std::max<double>(1, static_cast<double>(neighbourhood.size()) - 3);
  return {eigen.eigenvectors(), std::sqrt(std::max(0.0, eigen.eigenvalues()[0]) / free)};
}

SurfacePoints::SurfacePoints(Points positions, const Context& context, Index neighbourhood)
    : points(std::move(positions)),
      tree(points, context.stage(0, 0.4)),
      neighbours(size(), ring),
      normals(size(), 3),
      spacings(size()) {
  std::vector<double> deviations(size());
  constexpr Index grain = 512;
  parallel_for(context.stage(0.4, 1), size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> around;
    for (Index p = begin; p < end; ++p) {
      const std::int32_t i = tree.order()[p];
      tree.nearest(point(i), ring + 1, around);
      spacings[i] = spacing_at(around);
      const std::size_t planar = std::min<std::size_t>(neighbourhood, around.size());
      const LocalPlane plane = plane_through(points, std::span(around).first(planar));
      normals.row(i) = plane.axes.col(0).transpose();
      deviations[i] = plane.deviation;
      int column = 0;
      for (const Neighbour& other : around)
        if (other.index != i && column < ring)
          neighbours(i, column++) = static_cast<std::int32_t>(other.index);
      for (; column < ring; ++column) neighbours(i, column) = i;
    }
  });
  spacing = median(std::vector(spacings.begin(), spacings.end()));
  noise = median(std::move(deviations));
}

namespace {

// By hashes of their distances from the frame's planes; of points that share one, all or none.
std::vector<Index> drawn_with_images(const Points& all, Index count) {
  constexpr double quantum = 0x1p-30;  // far above the rounding of doubles
  std::vector<Index> rows;
  std::vector<std::uint64_t> hashes(all.rows());
  for (Index i = 0; i < all.rows(); ++i)
    hashes[i] = hash_of(Vector3((all.row(i).cwiseAbs() / quantum).array().round()));
  std::uint64_t limit = ~std::uint64_t{0};
  if (count < all.rows()) {
    std::vector<std::uint64_t> ranked = hashes;
    std::nth_element(ranked.begin(), ranked.begin() + count, ranked.end());
    // At least those of the least hash, which more than `count` may share.
    limit = std::max(ranked[count], *std::min_element(ranked.begin(), ranked.end()) + 1);
  }
  for (Index i = 0; i < all.rows(); ++i)
    if (hashes[i] < limit) rows.push_back(i);
  return rows;
}

Points along_curve(const Points& points, const Context& context) {
  return chosen_rows(points, spread_along_curve(points, points.rows(), context));
}

}  // namespace

SurfacePoints::SurfacePoints(const Points& all, Index count, const Context& context)
    : SurfacePoints(
          along_curve(chosen_rows(all, drawn_with_images(all, count)), context.stage(0, 0.3)),
          context.stage(0.3, 1)) {}

std::vector<Index> spread_along_curve(PointsView points, Index count, const Context& context) {
  const PointTree curve(points, context);
  std::vector<Index> rows(std::min(points.size(), count));
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = curve.order()[k * static_cast<std::size_t>(points.size()) / rows.size()];
  return rows;
}

}  // namespace symsurf
