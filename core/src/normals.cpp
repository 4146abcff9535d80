#include <symsurf/errors.h>
#include <symsurf/normals.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cloud.h"
#include "parallel.h"
#include "tree_normals.h"

namespace symsurf {

namespace {

// k x 3, from a point amid them and in units of their reach: no digits are lost to a far-off
// origin, and squares neither overflow nor vanish.
using Patch = Points;

Vector3 pca_normal(Patch& patch) {
  Matrix3 scatter = Matrix3::Zero();
  for (const auto& w : patch.rowwise()) scatter += w.transpose() * w;
  Vector3 normal = Eigen::SelfAdjointEigenSolver<Matrix3>(scatter).eigenvectors().col(0);
  Index largest;
  normal.cwiseAbs().maxCoeff(&largest);
  return normal[largest] < 0 ? -normal : normal;
}

// z = b1 x + b2 y in the least squares sense, of minimum norm: the axes of the projection on xy by
// one Jacobi rotation, the slope along each.
Vector3 regression_normal(Patch& patch) {
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
    std::array<std::vector<Neighbour>, PointTree::block> found;
    double reach = std::numeric_limits<double>::infinity();
    Patch patch(neighbours, 3);
    for (Index p = begin; p < end; p += PointTree::block) {
      PointTree::Queries queries;
      for (Index k = 0; k < PointTree::block; ++k)
        queries.col(k) = points[tree.order()[std::min(p + k, end - 1)]];
      tree.nearest(queries, neighbours, p, reach, found);
      for (Index k = 0; k < PointTree::block && p + k < end; ++k) {
        const Index i = tree.order()[p + k];
        for (Index n = 0; n < neighbours; ++n)
          patch.row(n) = (points[found[k][n].index] - points[i]).transpose();
        const double reach = patch.cwiseAbs().maxCoeff();
        if (reach > 0) patch /= reach;
        patch.rowwise() -= patch.colwise().mean().eval();
        normals.row(i) = normal_of(patch).transpose();
      }
    }
  });
  return normals;
}

}  // namespace symsurf
