#include <symsurf/errors.h>
#include <symsurf/normals.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/least_variance.h"
#include "cloud/tree_normals.h"

namespace symsurf {

namespace {

using Normals = Eigen::Matrix<double, 3, Neighbourhoods::lanes>;

Normals pca_normals(const Neighbourhoods& neighbourhoods) {
  Normals normals = neighbourhoods.least_variance();
  for (auto normal : normals.colwise()) {
    Index largest;
    normal.cwiseAbs().maxCoeff(&largest);
    if (normal[largest] < 0) normal = -normal;
  }
  return normals;
}

// z = b1 x + b2 y in the least squares sense, of minimum norm: the axes of the projection on xy by
// one Jacobi rotation, the slope along each.
Vector3 regression_normal(Points patch) {
  // A projection on xy thinner than this, against its length, is a line.
  constexpr double thinness = 1e-8;
  // From a point amid them and in units of their reach: no digits are lost to a far-off origin, and
  // squares neither overflow nor vanish.
  const double reach = patch.cwiseAbs().maxCoeff();
  if (reach > 0) patch /= reach;
  patch.rowwise() -= patch.colwise().mean().eval();
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

Normals regression_normals(const Neighbourhoods& neighbourhoods) {
  Normals normals;
  for (int lane = 0; lane < Neighbourhoods::lanes; ++lane)
    normals.col(lane) = regression_normal(neighbourhoods.offsets(lane));
  return normals;
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
  const auto normals_of = method == "pca" ? pca_normals : regression_normals;
  Points normals(points.size(), 3);
  constexpr Index grain = 2048;
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    std::array<std::vector<Neighbour>, PointTree::block> found;
    double reach = std::numeric_limits<double>::infinity();
    Neighbourhoods neighbourhoods(neighbours);
    for (Index p = begin; p < end; p += PointTree::block) {
      const auto row = [&](Index lane) { return tree.order()[std::min(p + lane, end - 1)]; };
      PointTree::Queries queries;
      for (Index lane = 0; lane < PointTree::block; ++lane) queries.col(lane) = points[row(lane)];
      tree.nearest(queries, neighbours, p, reach, found);
      for (int lane = 0; lane < PointTree::block; ++lane)
        for (Index n = 0; n < neighbours; ++n)
          neighbourhoods.set(lane, n, points[found[lane][n].index] - queries.col(lane));
      const Normals block = normals_of(neighbourhoods);
      for (Index lane = 0; lane < PointTree::block; ++lane)
        normals.row(row(lane)) = block.col(lane).transpose();
    }
  });
  return normals;
}

}  // namespace symsurf
