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

  struct Height {
    double value;
    Eigen::Vector2d gradient;
  };

  Height operator()(const Eigen::Vector2d& at) const;

 private:
  // height + slope . d + d' curvature d / 2, continued by its tangent beyond `reach`.
  struct Quadratic {
    double height = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  // uu, uv, vv
    double reach = 0;

    Height operator()(const Eigen::Vector2d& d) const;
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
  const Points flat = flattened(nodes);
  const PointTree tree(flat);
  // Of their extent, which map coordinates may leave.
  const double near =
      double_rounding * (flat.colwise().maxCoeff() - flat.colwise().minCoeff()).norm();
  std::vector<Index> kept;
  std::vector<char> covered(flat.rows(), 0);  // each cluster is looked through by its first only
  interruptible_for(context, flat.rows(), [&](Index i) {
    if (covered[i]) return;
    tree.within(flat.row(i), near, [&](Index other, double) { covered[other] = 1; });
    kept.push_back(i);
  });
  return nodes(kept, Eigen::indexing::all);
}

constexpr double footprint_margin = 0.75;  // cells to either side of the object's points

}  // namespace

// Along the ray to d: a parabola up to the reach, its tangent from there on.
HeightInterpolant::Height HeightInterpolant::Quadratic::operator()(const Eigen::Vector2d& d) const {
  const double length = d.norm();
  const double inside = length > reach ? reach / length : 1;
  const double part = inside - inside * inside / 2;
  const Eigen::Vector2d bent(curvature[0] * d.x() + curvature[1] * d.y(),
                             curvature[1] * d.x() + curvature[2] * d.y());
  const double bend = d.dot(bent);
  Eigen::Vector2d gradient = slope + 2 * part * bent;
  if (inside < 1) gradient -= bend * (inside - inside * inside) / (length * length) * d;
  return {height + slope.dot(d) + bend * part, gradient};
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
  Quadratic quadratic{nodes_(node, 2)};
  const double radius = std::sqrt(around.back().squared_distance);
  if (!(radius > 0)) return quadratic;

  using Vector5 = Eigen::Vector<double, 5>;
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Vector5 right = Vector5::Zero();
  for (const Neighbour& other : around) {
    const double d = std::sqrt(other.squared_distance) / radius;
    if (!(d > double_rounding)) continue;
    const Eigen::RowVector3d offset = nodes_.row(other.index) - nodes_.row(node);
    const double u = offset[0] / radius, v = offset[1] / radius, inverse = (1.05 - d) / d;
    const Vector5 row{u, v, u * u / 2, u * v, v * v / 2};
    normal += inverse * inverse * row * row.transpose();
    right += inverse * inverse * offset[2] * row;
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

HeightInterpolant::Height HeightInterpolant::operator()(const Eigen::Vector2d& at) const {
  std::vector<Neighbour> near;
  near.reserve(blended_nodes + 2);
  tree_.nearest({at.x(), at.y(), 0}, blended_nodes + 1, near);
  if (near.empty()) return {NAN, {NAN, NAN}};  // at infinity
  const auto from = [&](const Neighbour& n) -> Eigen::Vector2d {
    return at - nodes_.row(n.index).head<2>().transpose();
  };
  const double nearest = std::sqrt(near.front().squared_distance);
  if (nearest == 0) {
    const Quadratic& own = quadratics_[near.front().index];
    return {own.height, own.slope};
  }
  double radius = std::sqrt(near.back().squared_distance);
  Eigen::Vector2d radius_slope = from(near.back()) / radius;
  if (static_cast<Index>(near.size()) <= blended_nodes || !(radius > nearest)) {
    radius *= 2;
    radius_slope *= 2;
  }
  Height sum{0, Eigen::Vector2d::Zero()}, weights = sum;
  for (const Neighbour& n : near) {
    const double d = std::sqrt(n.squared_distance);
    const Eigen::Vector2d offset = from(n);
    const Height here = quadratics_[n.index](offset);
    const double inverse = (radius - d) / d * nearest;  // times the nearest: no overflow
    const double weight = inverse * inverse;
    const Eigen::Vector2d slope =
        2 * inverse * nearest / d * (radius_slope - radius / (d * d) * offset);
    sum.value += weight * here.value;
    sum.gradient += slope * here.value + weight * here.gradient;
    weights.value += weight;
    weights.gradient += slope;
  }
  const double height = sum.value / weights.value;
  return {height, (sum.gradient - height * weights.gradient) / weights.value};
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
  origin_ = nodes.colwise().mean();
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

std::optional<Foot> HeightField::at(const Vector3& x) const {
  const Vector3 offset = x - origin_;
  const auto [height, gradient] = (*heights_)(across_.transpose() * offset);
  const double distance = direction_.dot(offset) - height;
  if (!std::isfinite(distance)) return std::nullopt;
  return Foot{x - distance * direction_, (direction_ - across_ * gradient).stableNormalized(),
              distance};
}

Vector3 HeightField::normal(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot ? foot->normal : Vector3::Constant(NAN);
}

Values HeightField::numbers() const {
  return {{"direction", direction_}, {"nodes", Eigen::MatrixXd(*nodes_)}};
}

std::unique_ptr<Mirror> HeightField::moved(const Motion& by) const {
  Points nodes = by.scale * (*nodes_ * by.rotation.transpose());
  nodes.rowwise() += by.translation.transpose();
  return std::make_unique<HeightField>(by.rotation * direction_, std::move(nodes));
}

// A grid along the footprint's principal axes, without the cells that no point of the object comes
// near.
Mesh HeightField::mesh_over(const std::vector<Foot>& feet, int resolution,
                            const Context& context) const {
  Eigen::MatrixX2d flat = (points_of(feet).rowwise() - origin_.transpose()) * across_;
  const Eigen::RowVector2d centre = flat.colwise().mean();
  flat.rowwise() -= centre;
  const Eigen::Matrix2d principal =
      eigen_of(Eigen::Matrix2d(flat.transpose().lazyProduct(flat))).vectors;
  flat *= principal;
  const Eigen::Array2d low = flat.colwise().minCoeff(),
                       size = flat.colwise().maxCoeff().transpose().array() - low;
  const auto [columns, rows] = grid_cells(size.x(), size.y(), resolution);
  const Eigen::Array2i count(columns, rows);
  const Eigen::Array2d cell = (size / count.cast<double>()).max(std::numeric_limits<double>::min());

  std::vector<char> kept(static_cast<std::size_t>(columns) * rows, 0);
  for (const auto& row : flat.rowwise()) {
    const Eigen::Array2d at = (row.transpose().array() - low) / cell;
    const Eigen::Array2i first = (at - footprint_margin).floor().cast<int>().max(0),
                         last = (at + footprint_margin).floor().cast<int>().min(count - 1);
    for (int r = first.y(); r <= last.y(); ++r)
      for (int c = first.x(); c <= last.x(); ++c)
        kept[static_cast<std::size_t>(r) * columns + c] = 1;
  }

  const Mesh grid = box_mesh(flat, resolution, context, [&](const Eigen::Vector2d& at) {
    return foot(origin_ + across_ * (centre.transpose() + principal * at));
  });
  return part_of(grid, [&](Index t) { return kept[t / 2]; });  // two triangles a cell
}

}  // namespace symsurf
