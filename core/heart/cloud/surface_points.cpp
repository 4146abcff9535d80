#include "cloud/surface_points.h"

#include <symsurf/points.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
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

namespace {

Points along_curve(const Points& points, const Context& context) {
  return chosen_rows(points, PointTree(points, context).order());
}

}  // namespace

SurfacePoints::SurfacePoints(const Points& all, Index count, const Context& context)
    : SurfacePoints(
          along_curve(chosen_rows(all, drawn_with_images(all, count)), context.stage(0, 0.3)),
          context.stage(0.3, 1)) {}

namespace {

// `found`: nearest first.
NeighbourhoodMoments moments_of(const Vector3& x, PointsView points,
                                const std::vector<Neighbour>& found) {
  NeighbourhoodMoments around;
  const double farthest = found.back().squared_distance;
  if (!(farthest > 0)) return around;
  around.radius = std::sqrt(farthest);
  double weights = 0;
  for (const Neighbour& neighbour : found) {
    const double weight = 1 - neighbour.squared_distance / farthest;
    const Vector3 offset = (points[neighbour.index] - x) / around.radius;
    weights += weight;
    around.mean += weight * offset;
    around.covariance += weight * offset * offset.transpose();
  }
  around.mean /= weights;
  around.covariance = around.covariance / weights - around.mean * around.mean.transpose();
  return around;
}

}  // namespace

void visit_neighbourhoods(PointsView points, const PointTree& tree, Index k,
                          const std::vector<Index>& positions, const Context& context,
                          const std::function<void(Index, const NeighbourhoodMoments&)>& visit) {
  constexpr Index grain = 1024;
  parallel_for(context, static_cast<Index>(positions.size()), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> found;
    for (Index v = begin; v < end; ++v) {
      const Vector3 x = points[tree.order()[positions[v]]];
      tree.nearest(x, k + 1, found);  // the point itself is the nearest
      visit(v, moments_of(x, points, found));
    }
  });
}

namespace {

// The offsets of a neighbourhood from their mean, in units of their reach: no digits are lost to a
// far-off origin, and squares neither overflow nor vanish.
void normalise(Points& patch) {
  const double reach = patch.cwiseAbs().maxCoeff();
  if (reach > 0) patch /= reach;
  patch.rowwise() -= patch.colwise().mean().eval();
}

Vector3 pca_normal(const Points& patch) {
  const Vector3 normal = least_eigen_of(patch.transpose().lazyProduct(patch)).vector;
  Index largest;
  normal.cwiseAbs().maxCoeff(&largest);
  return normal[largest] < 0 ? -normal : normal;
}

// z = b1 x + b2 y in the least squares sense, of minimum norm: the axes of the projection on xy by
// one Jacobi rotation, the slope along each.
Vector3 regression_normal(const Points& patch) {
  // A projection on xy thinner than this, against its length, is a line.
  constexpr double thinness = 1e-8;
  Eigen::Matrix<double, Eigen::Dynamic, 2> xy = patch.leftCols<2>();
  Eigen::JacobiRotation<double> turn;
  turn.makeJacobi(xy.col(0).squaredNorm(), xy.col(0).dot(xy.col(1)), xy.col(1).squaredNorm());
  xy.applyOnTheRight(0, 1, turn);
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();
  axes.applyOnTheRight(0, 1, turn);
  const Eigen::Vector2d lengths = xy.colwise().squaredNorm();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k)
    if (lengths[k] > thinness * thinness * lengths.maxCoeff())
      slope += xy.col(k).dot(patch.col(2)) / lengths[k] * axes.col(k);
  return Vector3(-slope.x(), -slope.y(), 1).normalized();
}

void require_allowed(PointsView points, Index neighbours, std::string_view method) {
  if (method != "pca" && method != "regression")
    throw InvalidParameter("method is " + std::string(method) + "; allowed is pca | regression");
  if (neighbours < 3)
    throw InvalidParameter("neighbours is " + std::to_string(neighbours) +
                           "; allowed is 3 and above");
  if (points.size() < neighbours)
    throw InvalidInput(std::to_string(points.size()) + " points given; at least " +
                       std::to_string(neighbours) + ", the number of neighbours, are needed");
}

}  // namespace

Points estimate_normals(PointsView points, Index neighbours, std::string_view method,
                        const Context& context) {
  require_allowed(points, neighbours, method);
  require_finite(points, "point");
  const PointTree tree(points, context.stage(0, 0.1));
  return estimate_normals(points, tree, neighbours, method, context.stage(0.1, 1));
}

Points estimate_normals(PointsView points, const PointTree& tree, Index neighbours,
                        std::string_view method, const Context& context) {
  require_allowed(points, neighbours, method);
  const auto normal_of = method == "pca" ? pca_normal : regression_normal;
  Points normals(points.size(), 3);
  constexpr Index grain = 2048;
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> found;
    Points patch(neighbours, 3);
    for (Index p = begin; p < end; ++p) {
      context.check();  // of many neighbours a point takes long
      const std::int32_t i = tree.order()[p];
      tree.nearest(points[i], neighbours, found);
      for (Index n = 0; n < neighbours; ++n)
        patch.row(n) = (points[found[n].index] - points[i]).transpose();
      normalise(patch);
      normals.row(i) = normal_of(patch).transpose();
    }
  });
  return normals;
}

}  // namespace symsurf
