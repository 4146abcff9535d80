#pragma once

#include <symsurf/mirror.h>

#include <memory>

namespace symsurf {

class HeightInterpolant;

/// A curved mirror with a fixed direction of mapping v: the graph of a height h over the plane
/// orthogonal to v. A point is mapped along v: x' = x + 2 (h - x . v) v.
///
/// The surface passes through given nodes: quadratics fitted about each, blended by inverse
/// distance over the nearest ones (modified quadratic Shepard: Franke and Nielson 1980, Renka
/// 1988). It is defined everywhere: in gaps between the nodes and beyond them each quadratic is
/// continued by its tangent, so it stays smooth and grows linearly. Direction and nodes are all
/// there is to it: the same numbers make the same mirror.
class HeightField final : public Mirror {
 public:
  /// The direction may have any length but zero. Nodes: m x 3, one at least, in input units; of
  /// nodes that lie over each other along the direction only the first counts.
  /// Throws InvalidInput for a zero or non-finite direction and for no or non-finite nodes,
  /// Cancelled.
  HeightField(const Vector3& direction, Points nodes, const Context& context = {});

  const Vector3& direction() const { return direction_; }
  const Points& nodes() const { return *nodes_; }

  std::string_view kind() const override { return "height field"; }
  Vector3 foot(const Vector3& x) const override { return x - signed_distance(x) * direction_; }
  double signed_distance(const Vector3& x) const override;
  /// The unit normal at the foot of x, on the side that the direction points to.
  Vector3 normal(const Vector3& x) const;
  /// "direction", and "nodes" as m x 3.
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

 private:
  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;

  Vector3 direction_;
  std::shared_ptr<const Points> nodes_;
  Vector3 origin_;                      // of the frame (across_, direction_)
  Eigen::Matrix<double, 3, 2> across_;  // orthonormal
  std::shared_ptr<const HeightInterpolant> heights_;
};

}  // namespace symsurf
