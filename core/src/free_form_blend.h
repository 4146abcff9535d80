#pragma once

#include <symsurf/free_form.h>

#include "point_tree.h"

namespace symsurf {

/// The implicit function of a free-form mirror.
struct FreeForm::Blend {
 public:
  explicit Blend(std::vector<Patch> patches);

  const std::vector<Patch>& patches() const { return patches_; }

  /// The blended height of x and its gradient; false where no patch has a say.
  bool value(const Vector3& x, double& value, Vector3& gradient) const;

  /// The surface's point closest to x, and its unit normal; `precision` is relative to the patches.
  bool closest(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const;

 private:
  struct Jet {
    double value;
    Vector3 gradient;
    Matrix3 hessian;
  };
  bool jet(const Vector3& x, Jet& jet) const;
  bool descend(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const;

  std::vector<Patch> patches_;
  std::vector<Matrix3> hessians_;
  double reach_ = 0;  // the largest radius
  Points centres_;
  PointTree tree_;
};

}  // namespace symsurf
