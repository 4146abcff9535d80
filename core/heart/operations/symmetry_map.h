#pragma once

#include <symsurf/mirror.h>

#include <Eigen/Geometry>
#include <string_view>

namespace symsurf {

/// What a shape may be symmetric under: the reflection over a mirror, or a rotation.
class SymmetryMap {
 public:
  /// The mirror must stay alive.
  SymmetryMap(const Mirror& mirror) : mirror_(&mirror) {}
  explicit SymmetryMap(const Eigen::Isometry3d& rotation)
      : rotation_(rotation), inverse_(rotation.inverse()) {}

  std::string_view kind() const { return mirror_ ? mirror_->kind() : "axis"; }

  /// Whether it turns the winding of faces round, and is its own inverse.
  bool is_reflection() const { return mirror_ != nullptr; }

  SymmetryMap inverse() const { return mirror_ ? *this : SymmetryMap(inverse_); }

  /// NaN where there is none.
  Vector3 image(const Vector3& x) const { return mirror_ ? mirror_->reflect(x) : rotation_ * x; }
  /// What has the image x.
  Vector3 preimage(const Vector3& x) const { return mirror_ ? mirror_->reflect(x) : inverse_ * x; }

  Points images(PointsView points, const Context& context) const {
    if (mirror_) return mirror_->reflect(points, context);
    return (points.matrix() * rotation_.linear().transpose()).rowwise() +
           rotation_.translation().transpose();
  }

 private:
  const Mirror* mirror_ = nullptr;
  Eigen::Isometry3d rotation_ = Eigen::Isometry3d::Identity(), inverse_ = rotation_;
};

}  // namespace symsurf
