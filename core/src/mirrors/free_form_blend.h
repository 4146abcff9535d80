#pragma once

#include <symsurf/free_form.h>

#include <cstdint>
#include <vector>

#include "spatial/point_tree.h"

namespace symsurf {

/// The implicit function of a free-form mirror.
struct FreeForm::Blend {
 public:
  explicit Blend(std::vector<Patch> patches);

  const std::vector<Patch>& patches() const { return patches_; }

  /// The blended height of x; where no patch has a say, the nearest one's.
  double value(const Vector3& x) const;

  /// The surface's point closest to x, and its unit normal; `precision` is relative to the patches.
  bool closest(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const;

 private:
  struct Jet {
    double value;
    Vector3 gradient;
    Matrix3 hessian;
  };
  // These take and give coordinates from origin_.
  // The patches that have a say somewhere within `slack` of x.
  void around(const Vector3& x, double slack, std::vector<std::int32_t>& patches) const;
  bool jet(const Vector3& x, const std::vector<std::int32_t>& patches, Jet& jet) const;
  bool descend(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const;

  // A patch's height above its centre + d as a quadratic in d: slope . d + d . bend d / 2 - height.
  struct Piece {
    Vector3 centre;
    double per_squared_radius;
    double height;
    Vector3 slope;
    Matrix3 bend;

    double above(const Vector3& d) const { return d.dot(slope + 0.5 * (bend * d)) - height; }
  };

  std::vector<Patch> patches_;
  std::vector<Piece> pieces_;
  double reach_ = 0;  // the largest radius
  Vector3 origin_;    // all is reckoned from here: as exact wherever the mirror lies
  PointTree tree_;    // of the centres
};

}  // namespace symsurf
