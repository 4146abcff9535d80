#pragma once

#include <symsurf/points.h>

#include <vector>

#include "base/random.h"

namespace symsurf {

/// A displacement by a few long waves, and a rigid motion after it, so that z = 0 remains the plane
/// that mirrors the displaced points onto their displaced images best in the least-squares sense.
class SmoothAsymmetry {
 public:
  /// The points have a diagonal of about 1; the displacement's root mean square over them is
  /// `share`; 0 leaves them as they are.
  SmoothAsymmetry(double share, const std::vector<Vector3>& points, Random& random);

  Vector3 operator()(const Vector3& x) const;

 private:
  struct Wave {
    Vector3 along;  // turns a unit
    double phase;   // turns
    Vector3 way;
  };

  Vector3 displaced(const Vector3& x) const;

  std::vector<Wave> waves_;
  double strength_ = 0;
  Matrix3 rotation_ = Matrix3::Identity();
  Vector3 centre_ = Vector3::Zero();  // what turns onto the mirror
};

}  // namespace symsurf
