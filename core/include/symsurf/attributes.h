#pragma once

// What becomes of the arrays that a shape has at its points where an operation moves them.

#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <optional>

namespace symsurf {

/// What the numbers of an array are, and what a map with the Jacobian J makes of them.
enum class AttributeKind {
  Scalar,  ///< numbers without a direction, which stay
  Vector,  ///< v becomes J v
  Normal,  ///< n becomes the direction of J^-T n, with the length of n
  Tensor,  ///< T becomes J T J', symmetric: 9 numbers, or 6 in VTK's order xx yy zz xy yz xz
};

/// Takes arrays at the points of a shape to those of its image, or of an operation's result. The
/// points and the mirror must outlive it. Not for several threads at once.
class AttributeTransform {
 public:
  using Rows = decltype(OperationResult::point_parents);
  using Shares = decltype(OperationResult::point_shares);

  /// Of the image over the mirror.
  AttributeTransform(const Mirror& mirror, PointsView points, const Context& context = {});

  /// Of the result of an operation on the points; `mirror`: the one that was used, null where none
  /// was. Throws InvalidInput where the result is not one of so many points.
  AttributeTransform(const OperationResult& result, PointsView points, const Mirror* mirror,
                     const Context& context = {});

  /// Whether directions change, of some points at least.
  bool turns() const { return jacobian_of_.size() > 0 && jacobian_of_.maxCoeff() >= 0; }

  /// Of each point and each of its parents the row of jacobians(), -1 for none.
  const Rows& jacobian_of() const { return jacobian_of_; }

  /// The local Jacobians of the map; found when they are first asked for. Throws Cancelled.
  const std::vector<Matrix3>& jacobians() const;

  /// Values of the points of the image or the result, from those of the shape, one row a point:
  /// between several parents the mean by their shares, of normals at the greatest of their lengths.
  /// NaN at points without an image. Throws InvalidInput for another number of rows, or of columns
  /// for the kind; Cancelled.
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& values, AttributeKind kind) const;

 private:
  PointsView points_;
  const Mirror* mirror_;
  Context context_;
  std::optional<Bend> bend_;
  Rows parents_, jacobian_of_;
  Shares shares_;
  mutable std::vector<Matrix3> jacobians_;
};

}  // namespace symsurf
