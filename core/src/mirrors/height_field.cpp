#include <symsurf/errors.h>
#include <symsurf/height_field.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/math.h"
#include "base/symmetric_eigen.h"
#include "mirrors/grid_mesh.h"
#include "mirrors/height_interpolant.h"

namespace symsurf {

namespace {

constexpr double footprint_margin = 1.5;  // cells around the object's points

}  // namespace

HeightField::HeightField(const Vector3& direction, Points nodes) {
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
  heights_ = std::make_shared<const HeightInterpolant>(framed);
}

double HeightField::signed_distance(const Vector3& x) const {
  const Vector3 offset = x - origin_;
  return direction_.dot(offset) - (*heights_)(across_.transpose() * offset);
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
Mesh HeightField::mesh_over(PointsView object, int resolution) const {
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

  std::vector<Index> vertex(static_cast<std::size_t>(columns + 1) * (rows + 1), -1);
  std::vector<Vector3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  const auto corner = [&](int c, int r) {
    Index& index = vertex[static_cast<std::size_t>(r) * (columns + 1) + c];
    if (index < 0) {
      const Eigen::RowVector2d at = low + size.cwiseProduct(Eigen::RowVector2d(c, r));
      const Vector3 flat_point =
          origin_ + across_ * (centre + at * principal.transpose()).transpose();
      index = static_cast<Index>(vertices.size());
      vertices.push_back(foot(flat_point));
    }
    return index;
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      if (!kept[static_cast<std::size_t>(r) * columns + c]) continue;
      const Index a = corner(c, r), b = corner(c + 1, r);
      const Index d = corner(c, r + 1), e = corner(c + 1, r + 1);
      triangles.push_back({a, b, e});
      triangles.push_back({a, e, d});
    }
  return {rows_of(vertices), rows_of(triangles)};
}

}  // namespace symsurf
