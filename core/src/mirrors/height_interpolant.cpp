#include "mirrors/height_interpolant.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "base/semidefinite_solve.h"

namespace symsurf {

namespace {

constexpr Index fitted_nodes = 17;  // Renka's recommendation is 13; a few more steady the rim
constexpr Index blended_nodes = 12;
constexpr double least_curvature_weight = 1e-9;  // decides where the nodes leave a slope open

Points flattened(const Points& nodes) {
  Points flat = nodes;
  flat.col(2).setZero();
  return flat;
}

// Of nodes over each other, to rounding, the first.
Points distinct_nodes(const Points& nodes) {
  constexpr double rounding = 1e-9;  // of their extent, which map coordinates may leave
  const Points flat = flattened(nodes);
  const PointTree tree(flat);
  const double near = rounding * (flat.colwise().maxCoeff() - flat.colwise().minCoeff()).norm();
  std::vector<Index> kept;
  for (Index i = 0; i < flat.rows(); ++i) {
    bool first = true;
    tree.within(flat.row(i), near, [&](Index other, double) { first = first && other >= i; });
    if (first) kept.push_back(i);
  }
  return nodes(kept, Eigen::indexing::all);
}

}  // namespace

double HeightInterpolant::Quadratic::operator()(const Eigen::Vector2d& d) const {
  const double length = d.norm();
  const double inside = length > reach ? reach / length : 1;
  // Along the ray to d: a parabola up to the reach, its tangent from there on.
  const double rise = slope.dot(d);
  const double bend = curvature[0] * d.x() * d.x() + 2 * curvature[1] * d.x() * d.y() +
                      curvature[2] * d.y() * d.y();
  return height + rise + bend * (inside - inside * inside / 2);
}

HeightInterpolant::HeightInterpolant(const Points& nodes)
    : nodes_(distinct_nodes(nodes)), tree_(flattened(nodes_)), quadratics_(nodes_.rows()) {
  std::vector<Neighbour> around;
  for (const std::int32_t i : tree_.order()) {
    tree_.nearest({nodes_(i, 0), nodes_(i, 1), 0}, fitted_nodes + 1, around);
    quadratics_[i] = fitted(i, around);
  }
}

HeightInterpolant::Quadratic HeightInterpolant::fitted(Index node,
                                                       const std::vector<Neighbour>& around) const {
  using Vector5 = Eigen::Matrix<double, 5, 1>;
  Quadratic quadratic;
  quadratic.height = nodes_(node, 2);
  const double radius = std::sqrt(around.back().squared_distance);
  if (!(radius > 0)) return quadratic;

  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Vector5 right = Vector5::Zero();
  for (const Neighbour& other : around) {
    const double d = std::sqrt(other.squared_distance) / radius;
    if (!(d > 1e-9)) continue;
    const double u = (nodes_(other.index, 0) - nodes_(node, 0)) / radius;
    const double v = (nodes_(other.index, 1) - nodes_(node, 1)) / radius;
    const double inverse = (1.05 - d) / d;
    const Vector5 row{u, v, u * u / 2, u * v, v * v / 2};
    const double weight = inverse * inverse;
    normal += weight * row * row.transpose();
    right += weight * (nodes_(other.index, 2) - quadratic.height) * row;
  }
  const double ridge = least_curvature_weight * normal.trace();
  normal.diagonal() += ridge * Vector5{1e-3, 1e-3, 1, 2, 1};
  const Vector5 solution = solved(normal, right);
  if (!solution.allFinite()) return quadratic;
  quadratic.slope = solution.head<2>() / radius;
  quadratic.curvature = solution.tail<3>() / (radius * radius);
  quadratic.reach = radius;
  return quadratic;
}

double HeightInterpolant::operator()(const Eigen::Vector2d& at) const {
  std::vector<Neighbour> near;
  near.reserve(blended_nodes + 2);
  tree_.nearest({at.x(), at.y(), 0}, blended_nodes + 1, near);
  if (near.empty()) return std::numeric_limits<double>::quiet_NaN();  // at infinity
  const double nearest = std::sqrt(near.front().squared_distance);
  double radius = std::sqrt(near.back().squared_distance);
  if (static_cast<Index>(near.size()) <= blended_nodes) radius *= 2;
  if (nearest == 0) return nodes_(near.front().index, 2);
  if (!(radius > nearest)) radius = 2 * nearest;

  double sum = 0, weights = 0;
  for (const Neighbour& n : near) {
    const double d = std::sqrt(n.squared_distance);
    if (d >= radius) continue;
    const double inverse = (radius - d) / d * nearest;  // times the nearest: no overflow
    const double weight = inverse * inverse;
    const Eigen::Vector2d offset(at.x() - nodes_(n.index, 0), at.y() - nodes_(n.index, 1));
    sum += weight * quadratics_[n.index](offset);
    weights += weight;
  }
  return sum / weights;
}

}  // namespace symsurf
