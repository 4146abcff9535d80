#pragma once

#include <utility>

#include "cloud/point_tree.h"
#include "cloud/surfels.h"

namespace symsurf {

/// One of two halves of a cloud, as one mean a cell: its density does not show.
struct ThinnedHalf {
  explicit ThinnedHalf(Points means) : points(std::move(means)), tree(points) {}
  Points points;  ///< in the principal frame
  PointTree tree;
};

/// A cloud split at random into halves. How well one says what the other says is the most that a
/// mirror image can. Copies of a point are one point, clutter is left out.
struct CloudHalves {
  /// `surface`: what lies in none of its cells is clutter. `split`: which of several.
  CloudHalves(const Cloud& cloud, const Surfels& surface, std::size_t split);

  double cell;           ///< its edge, as wide as the sparse parts of the cloud need
  ThinnedHalf one, two;  ///< on grids that are turned against each other

 private:
  struct Split;
  explicit CloudHalves(const Split& split);
};

/// The points of a set in a ball, with weights that fall to 0 at its rim: 1 - (distance /
/// radius)^2.
struct Ball {
  double count = 0;                     ///< of points
  double effective = 0;                 ///< points of equal weight with the same variance
  Vector3 mean = Vector3::Zero();       ///< from the centre
  Vector3 variances = Vector3::Zero();  ///< along the principal axes, ascending
  Matrix3 axes = Matrix3::Identity();   ///< the principal axes
  Vector3 thinness = Vector3::Zero();   ///< 0..1 along each: 1 for a surface's, 0 for a volume's
  double flatness = 0;                  ///< 0..1: does it have a normal?

  Ball() = default;
  Ball(const ThinnedHalf& points, const Vector3& centre, double radius);

  Vector3 normal() const { return axes.col(0); }

  /// Of the points' image under an isometry.
  Ball moved(const Matrix3& linear) const;
};

/// What offsets between two balls count.
struct Tolerance {
  double near;  ///< distance across the surface that halves the support
  double far;   ///< that of the worst miss
};

/// How well the second ball says the same as the first: with r the distance of their means across
/// the surface, less what few points leave to it, and c = (n . n')^2,
///
///   c / (1 + (r / near)^2) - penalty (r / far)^2 exp(1 - (r / far)^2),
///
/// times how complete the one with fewer points is.
struct BallSupport {
  double support = 0;
  double missing = 0, rim = 0;  ///< 0..1: where the second's or the first's has fewer points
  double apart = 0;             ///< r

  BallSupport(const Ball& own, const Ball& other, const Tolerance& tolerance);
};

}  // namespace symsurf
