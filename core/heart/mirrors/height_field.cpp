#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

// Heights over the plane through scattered nodes: the modified quadratic Shepard interpolant of
// Renka (1988), with the nearest nodes in place of a fixed radius of influence.
class HeightInterpolant {
 public:
  // Rows (u, v, height), at least one. Nodes at the same position: the first counts.
  HeightInterpolant(const Points& nodes, const Context& context);

  /// The height there, and its gradient where asked for.
  double operator()(const Eigen::Vector2d& at, Eigen::Vector2d* gradient = nullptr) const;

 private:
  // height + slope . d + d' curvature d / 2, continued by its tangent beyond `reach`.
  struct Quadratic {
    double height = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  // uu, uv, vv
    double reach = 0;

    double operator()(const Eigen::Vector2d& d, Eigen::Vector2d* gradient) const;
  };

  Quadratic fitted(Index node, const std::vector<Neighbour>& around) const;

  Points nodes_;
  PointTree tree_;  // of the nodes at height 0
  std::vector<Quadratic> quadratics_;
};

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
Points distinct_nodes(const Points& nodes, const Context& context) {
  constexpr double rounding = 1e-9;  // of their extent, which map coordinates may leave
  const Points flat = flattened(nodes);
  const PointTree tree(flat);
  const double near = rounding * (flat.colwise().maxCoeff() - flat.colwise().minCoeff()).norm();
  std::vector<Index> kept;
  std::vector<char> covered(flat.rows(), 0);  // each cluster is looked through by its first only
  interruptible_for(context, flat.rows(), [&](Index i) {
    if (covered[i]) return;
    tree.within(flat.row(i), near, [&](Index other, double) { covered[other] = 1; });
    kept.push_back(i);
  });
  return nodes(kept, Eigen::indexing::all);
}

constexpr double footprint_margin = 1.5;  // cells around the object's points

}  // namespace

double HeightInterpolant::Quadratic::operator()(const Eigen::Vector2d& d,
                                                Eigen::Vector2d* gradient) const {
  const double length = d.norm();
  const double inside = length > reach ? reach / length : 1;
  // Along the ray to d: a parabola up to the reach, its tangent from there on.
  const double rise = slope.dot(d);
  const double bend = curvature[0] * d.x() * d.x() + 2 * curvature[1] * d.x() * d.y() +
                      curvature[2] * d.y() * d.y();
  if (gradient) {
    const Eigen::Vector2d bent(curvature[0] * d.x() + curvature[1] * d.y(),
                               curvature[1] * d.x() + curvature[2] * d.y());
    *gradient = slope + 2 * (inside - inside * inside / 2) * bent;
    if (inside < 1) *gradient -= bend * (inside - inside * inside) / (length * length) * d;
  }
  return height + rise + bend * (inside - inside * inside / 2);
}

HeightInterpolant::HeightInterpolant(const Points& nodes, const Context& context)
    : nodes_(distinct_nodes(nodes, context)), tree_(flattened(nodes_)), quadratics_(nodes_.rows()) {
  std::vector<Neighbour> around;
  const auto fit = [&](Index k) {
    const Index i = tree_.order()[k];
    tree_.nearest({nodes_(i, 0), nodes_(i, 1), 0}, fitted_nodes + 1, around);
    quadratics_[i] = fitted(i, around);
  };
  constexpr Index stretch = 1024;  // fits, of some microseconds
  interruptible_for(context, nodes_.rows(), fit, stretch);
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

double HeightInterpolant::operator()(const Eigen::Vector2d& at, Eigen::Vector2d* gradient) const {
  std::vector<Neighbour> near;
  near.reserve(blended_nodes + 2);
  tree_.nearest({at.x(), at.y(), 0}, blended_nodes + 1, near);
  const auto from = [&](const Neighbour& n) {
    return Eigen::Vector2d(at.x() - nodes_(n.index, 0), at.y() - nodes_(n.index, 1));
  };
  if (near.empty()) {  // at infinity
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (gradient) gradient->setConstant(none);
    return none;
  }
  const double nearest = std::sqrt(near.front().squared_distance);
  double radius = std::sqrt(near.back().squared_distance);
  Eigen::Vector2d radius_slope = from(near.back()) / radius;
  if (static_cast<Index>(near.size()) <= blended_nodes) {
    radius *= 2;
    radius_slope *= 2;
  }
  if (nearest == 0) {
    if (gradient) *gradient = quadratics_[near.front().index].slope;
    return nodes_(near.front().index, 2);
  }
  if (!(radius > nearest)) {
    radius = 2 * nearest;
    radius_slope = 2 / nearest * from(near.front());
  }

  double sum = 0, weights = 0;
  Eigen::Vector2d sum_slope = Eigen::Vector2d::Zero(), weights_slope = Eigen::Vector2d::Zero();
  for (const Neighbour& n : near) {
    const double d = std::sqrt(n.squared_distance);
    if (d >= radius) continue;
    const double inverse = (radius - d) / d * nearest;  // times the nearest: no overflow
    const double weight = inverse * inverse;
    Eigen::Vector2d slope;
    const double height = quadratics_[n.index](from(n), gradient ? &slope : nullptr);
    sum += weight * height;
    weights += weight;
    if (!gradient) continue;
    const Eigen::Vector2d weight_slope =
        2 * inverse * nearest / d * (radius_slope - radius / (d * d) * from(n));
    sum_slope += weight_slope * height + weight * slope;
    weights_slope += weight_slope;
  }
  if (gradient) *gradient = (sum_slope - sum / weights * weights_slope) / weights;
  return sum / weights;
}

HeightField::HeightField(const Vector3& direction, Points nodes, const Context& context) {
  const double length = length_of(direction);
  if (!(length > 0) || !std::isfinite(length))
    throw InvalidInput("a height field needs a direction of finite length above 0; given " +
                       to_string(Value(direction)));
  if (nodes.rows() == 0 || !nodes.allFinite())
    throw InvalidInput("a height field needs at least one node, all finite; given " +
                       std::to_string(nodes.rows()));
  direction_ = direction / length;
  across_ = orthogonal_to(direction_);
  origin_ = nodes.colwise().mean().transpose();
  Points framed(nodes.rows(), 3);
  const Points centred = nodes.rowwise() - origin_.transpose();
  framed.leftCols<2>() = centred * across_;
  framed.col(2) = centred * direction_;
  // The index of the nodes compares squares of lengths.
  if (!std::isfinite(framed.squaredNorm()))
    throw InvalidInput("a height field needs nodes nearer to each other than " +
                       to_string(Value(std::sqrt(std::numeric_limits<double>::max()))));
  nodes_ = std::make_shared<const Points>(std::move(nodes));
  heights_ = std::make_shared<const HeightInterpolant>(framed, context);
}

double HeightField::signed_distance(const Vector3& x) const {
  const Vector3 offset = x - origin_;
  return direction_.dot(offset) - (*heights_)(across_.transpose() * offset);
}

Vector3 HeightField::normal(const Vector3& x) const {
  Eigen::Vector2d slope;
  (*heights_)(across_.transpose() * (x - origin_), &slope);
  return (direction_ - across_ * slope).stableNormalized();
}

Values HeightField::numbers() const {
  return {{"direction", direction_}, {"nodes", Eigen::MatrixXd(*nodes_)}};
}

std::unique_ptr<Mirror> HeightField::transformed(double scale, const Matrix3& rotation,
                                                 const Vector3& translation) const {
  Points nodes = scale * (*nodes_ * rotation.transpose());
  nodes.rowwise() += translation.transpose();
  return std::make_unique<HeightField>(rotation * direction_, std::move(nodes));
}

// A grid along the footprint's principal axes, without the cells that no point of the object comes
// near.
Mesh HeightField::mesh_over(PointsView object, int resolution, const Context& context) const {
  Eigen::Matrix<double, Eigen::Dynamic, 2> flat =
      (object.matrix().rowwise() - origin_.transpose()) * across_;
  const Eigen::RowVector2d centre = flat.colwise().mean();
  flat.rowwise() -= centre;
  const Eigen::Matrix2d principal =
      eigen_of(Eigen::Matrix2d(flat.transpose().lazyProduct(flat))).vectors;
  flat = flat * principal;
  const Eigen::RowVector2d low = flat.colwise().minCoeff(), high = flat.colwise().maxCoeff();
  const auto [columns, rows] = grid_cells(high.x() - low.x(), high.y() - low.y(), resolution);
  const Eigen::RowVector2d size = (high - low).array() / Eigen::Array<double, 1, 2>(columns, rows);

  std::vector<char> kept(static_cast<std::size_t>(columns) * rows, 0);
  for (Index i = 0; i < flat.rows(); ++i) {
    const auto reach = [&](int axis, double side, int count) {
      const double at = size[axis] > 0 ? (flat(i, axis) - low[axis]) / size[axis] : 0;
      return std::clamp(static_cast<int>(std::floor(at + side * footprint_margin / 2)), 0,
                        count - 1);
    };
    for (int r = reach(1, -1, rows); r <= reach(1, 1, rows); ++r)
      for (int c = reach(0, -1, columns); c <= reach(0, 1, columns); ++c)
        kept[static_cast<std::size_t>(r) * columns + c] = 1;
  }

  const Mesh grid = grid_mesh({columns, rows}, context, [&](double s, double t) -> Vector3 {
    const Eigen::RowVector2d at = low + (high - low).cwiseProduct(Eigen::RowVector2d(s, t));
    return foot(origin_ + across_ * (centre + at * principal.transpose()).transpose());
  });
  return part_of(grid, [&](Index t) { return kept[t / 2]; });  // two triangles a cell
}

}  // namespace symsurf
