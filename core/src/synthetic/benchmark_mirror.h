#pragma once

#include <symsurf/parameter.h>

#include <string>
#include <string_view>

#include "base/random.h"

namespace symsurf {

/// The image in the plane z = 0.
inline Vector3 over_mirror(const Vector3& x) { return {x.x(), x.y(), -x.z()}; }

/// The plane z = 0 after it was bent, with the space around it: a point over (x, y) moves along the
/// surface's normal, at the same distance from it, so that images stay images.
class BenchmarkMirror {
 public:
  /// "straight", "bent" (a cylinder), "domed" (a sphere), "waved" (a sine) or "twisted" (a
  /// hyperbolic paraboloid), drawn for a body of diagonal 1 that reaches so far from the plane: the
  /// radius of curvature is at least `reach` / 0.7.
  BenchmarkMirror(std::string_view bend, double reach, Random& random);

  Vector3 bent(const Vector3& x) const;
  /// The inverse near `start`, by Newton's method.
  Vector3 straightened(const Vector3& x, const Vector3& start) const;

  /// "plane", "cylinder", "sphere" or "graph".
  std::string kind() const;
  /// The mirror after x -> scale * rotation * x + translation: see BenchmarkSample.
  Values mirror(double scale, const Matrix3& rotation, const Vector3& translation) const;

 private:
  enum class Bend { Straight, Bent, Domed, Waved, Twisted };

  Bend bend_;
  double along_x_ = 1,
         along_y_ = 0;  // the direction, within the plane, that is bent: a unit vector
  double radius_ = 0;
  double amplitude_ = 0, frequency_ = 0, phase_ = 0;  // of the wave; frequency in turns a unit
  double slope_ = 0;                                  // of the twist
};

}  // namespace symsurf
