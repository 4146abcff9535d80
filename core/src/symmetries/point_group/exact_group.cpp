#include "symmetries/point_group/exact_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/nearest_orthogonal.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

constexpr Index most_points = 1000;
constexpr double exactly = 2e-6;    // of the set's size, from an image to a point: single precision
constexpr double guessed = 5e-5;    // the same under an isometry that two points define
constexpr double same_turn = 1e-3;  // between matrices and directions; a 128th of a turn is 0.05

// The points about their centroid, which every isometry keeps in its place.
class SmallSet {
 public:
  SmallSet(const Cloud& cloud, const Context& context)
      : points_(in_frame(cloud)), tree_(points_, context) {}

  /// All but the identity.
  std::vector<Matrix3> isometries(const Context& context) const {
    const auto [a, b] = basis_points();
    const Vector3 first = points_.row(a).transpose(), second = points_.row(b).transpose();
    const Matrix3 basis = basis_of(first, second);
    std::vector<Matrix3> found;
    for (Index i = 0; i < points_.rows(); ++i) {
      context.check();
      const Vector3 x = points_.row(i).transpose();
      if (std::abs(x.norm() - first.norm()) > guessed) continue;
      for (Index k = 0; k < points_.rows(); ++k) {
        const Vector3 y = points_.row(k).transpose();
        if (std::abs((x - y).norm() - (first - second).norm()) > guessed ||
            std::abs(y.norm() - second.norm()) > guessed)
          continue;
        const Matrix3 images = basis_of(x, y);
        for (const double side : {1.0, -1.0}) {
          const Matrix3 guess = images * Vector3(1, 1, side).asDiagonal() * basis.transpose();
          Matrix3 element;
          if (!fitted(guess, guessed, element) || !fitted(element, exactly, element)) continue;
          if (!(element - Matrix3::Identity()).isZero(same_turn)) found.push_back(element);
        }
      }
    }
    return found;
  }

 private:
  static Points in_frame(const Cloud& cloud) {
    Points points(cloud.points.size(), 3);
    for (Index i = 0; i < points.rows(); ++i)
      points.row(i) = cloud.frame.to_frame(cloud.points[i]).transpose();
    return points.rowwise() - points.colwise().mean().eval();
  }

  static Matrix3 basis_of(const Vector3& a, const Vector3& b) {
    Matrix3 basis;
    basis.col(0) = a.normalized();
    basis.col(2) = a.cross(b).normalized();
    basis.col(1) = basis.col(2).cross(basis.col(0));
    return basis;
  }

  // Two points of shells with few points, as those that are equally far from the centroid have the
  // same images, in directions far from parallel.
  std::pair<Index, Index> basis_points() const {
    const Eigen::VectorXd radii = points_.rowwise().norm();
    std::vector<Index> order(points_.rows());
    for (Index i = 0; i < points_.rows(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index k) { return radii[i] < radii[k]; });
    std::vector<Index> size(points_.rows());
    for (std::size_t begin = 0, end; begin < order.size(); begin = end) {
      end = begin + 1;
      while (end < order.size() && radii[order[end]] - radii[order[end - 1]] <= exactly) ++end;
      for (std::size_t k = begin; k < end; ++k) size[order[k]] = static_cast<Index>(end - begin);
    }
    // Directions are the more exact the longer: half of the greatest radius is enough.
    const double far = radii.maxCoeff() / 4, upright = 0.3;
    const auto least = [&](const auto& may_be) {
      Index best = -1;
      for (const Index i : order)
        if (may_be(i) && (best < 0 || size[i] < size[best])) best = i;
      return best;
    };
    const Index a = least([&](Index i) { return radii[i] >= far; });
    const Vector3 first = points_.row(a).transpose().normalized();
    const auto across = [&](Index i) { return points_.row(i).transpose().cross(first).norm(); };
    Index b = least([&](Index i) { return radii[i] >= far && across(i) > upright * radii[i]; });
    if (b < 0)
      b = *std::max_element(order.begin(), order.end(),
                            [&](Index i, Index k) { return across(i) < across(k); });
    return {a, b};
  }

  // The isometry nearest to where a map sends the points, if all come to points of the set.
  bool fitted(const Matrix3& map, double reach, Matrix3& fit) const {
    Matrix3 products = Matrix3::Zero();
    std::vector<bool> is_image(points_.rows(), false);
    for (Index i = 0; i < points_.rows(); ++i) {
      const Vector3 x = points_.row(i).transpose();
      const Index partner = tree_.nearest(map * x, reach * reach).index;
      if (partner < 0 || is_image[partner]) return false;
      is_image[partner] = true;
      products += points_.row(partner).transpose() * x.transpose();
    }
    fit = nearest_orthogonal(products, map.determinant());
    return true;
  }

  Points points_;
  PointTree tree_;
};

bool holds(const std::vector<Matrix3>& elements, const Matrix3& element) {
  return std::any_of(elements.begin(), elements.end(),
                     [&](const Matrix3& other) { return (other - element).isZero(same_turn); });
}

// The highest order first.
std::vector<PointGroup::Axis> turn_axes(const std::vector<Matrix3>& elements) {
  std::vector<PointGroup::Axis> axes;
  for (const Matrix3& element : elements) {
    if (element.determinant() < 0) continue;
    const Eigen::AngleAxisd turned(element);
    const auto same = std::find_if(axes.begin(), axes.end(), [&](const PointGroup::Axis& axis) {
      return are_parallel(axis.direction, turned.axis(), same_turn);
    });
    if (same == axes.end())
      axes.push_back({turned.axis(), 2});
    else
      ++same->order;  // an axis of order n has n - 1 turns
  }
  std::stable_sort(
      axes.begin(), axes.end(),
      [](const PointGroup::Axis& a, const PointGroup::Axis& b) { return a.order > b.order; });
  return axes;
}

Vector3 normal_of(const Matrix3& reflection) {
  const Matrix3 moved = Matrix3::Identity() - reflection;
  Index longest;
  moved.colwise().squaredNorm().maxCoeff(&longest);
  return moved.col(longest).normalized();
}

bool is_reflection(const Matrix3& element) {
  return element.determinant() < 0 && std::abs(element.trace() - 1) < same_turn;
}

// With z along the axis, and x normal to a plane that holds it or along a half turn across it.
PlacedGroup axial(const std::vector<Matrix3>& elements, const PointGroup::Axis& axis) {
  const Matrix3 across = reflection(axis.direction);
  const double rotary = std::numbers::pi / static_cast<double>(axis.order);
  AxialElements has;
  has.across = holds(elements, across);
  has.rotary = !has.across && holds(elements, turn(axis.direction, rotary) * across);
  Vector3 x = Vector3::Zero();
  for (const Matrix3& element : elements) {
    if (!is_reflection(element)) continue;
    const Vector3 normal = normal_of(element);
    if (std::abs(normal.dot(axis.direction)) > same_turn) continue;
    has.vertical = true;
    x = normal;
  }
  for (const PointGroup::Axis& other : turn_axes(elements)) {
    if (has.vertical || std::abs(other.direction.dot(axis.direction)) > same_turn) continue;
    has.twofold = true;
    x = other.direction;
  }
  PlacedGroup placed{axial_group(axis.order, has),
                     GroupPose::along(axis.direction, Vector3::Zero())};
  if (!x.isZero(0)) {
    x = (x - x.dot(axis.direction) * axis.direction).normalized();
    placed.pose.axes << x, axis.direction.cross(x), axis.direction;
  }
  return placed;
}

// With x, y and z along axes at right angles, of the highest order that three have.
std::optional<PlacedGroup> polyhedral(const std::vector<Matrix3>& elements,
                                      const std::vector<PointGroup::Axis>& axes) {
  const Index highest = axes.front().order, at_right_angles = highest == 4 ? 4 : 2;
  const bool inversion = holds(elements, -Matrix3::Identity());
  const bool mirror = std::any_of(elements.begin(), elements.end(), is_reflection);
  const PointGroup group = polyhedral_group(highest, inversion, mirror);
  for (const PointGroup::Axis& z : axes)
    for (const PointGroup::Axis& x : axes) {
      if (z.order != at_right_angles || x.order != at_right_angles) continue;
      if (std::abs(z.direction.dot(x.direction)) > same_turn) continue;
      GroupPose pose;
      const Vector3 across =
          (x.direction - x.direction.dot(z.direction) * z.direction).normalized();
      pose.axes << across, z.direction.cross(across), z.direction;
      const bool stands =
          std::all_of(group.elements.begin(), group.elements.end(), [&](const Matrix3& element) {
            return element.isIdentity() || holds(elements, pose.placed(element).linear());
          });
      if (stands) return PlacedGroup{group, pose};
    }
  return {};
}

}  // namespace

std::optional<PlacedGroup> exact_group(const Cloud& cloud, const Context& context) {
  if (cloud.points.size() > most_points) return {};
  const std::vector<Matrix3> elements = SmallSet(cloud, context).isometries(context);
  if (elements.empty()) return {};
  const std::vector<PointGroup::Axis> axes = turn_axes(elements);
  if (axes.empty())
    return holds(elements, -Matrix3::Identity())
               ? PlacedGroup{inversion_group(), {}}
               : PlacedGroup{reflection_group(),
                             GroupPose::along(normal_of(elements.front()), Vector3::Zero())};
  if (axes.size() > 1 && axes[1].order > 2) return polyhedral(elements, axes);
  // Of the axes of one order that whose elements are most: of D2d the one of the rotary reflection.
  std::optional<PlacedGroup> best;
  for (const PointGroup::Axis& axis : axes) {
    if (axis.order < axes.front().order) break;
    PlacedGroup placed = axial(elements, axis);
    if (!best || placed.group.elements.size() > best->group.elements.size())
      best = std::move(placed);
  }
  return best;
}

}  // namespace symsurf
