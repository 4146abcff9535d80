#include "cloud/normals.h"

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "cloud/cloud.h"

namespace symsurf {

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
