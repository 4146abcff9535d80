#pragma once

#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/random.h"

namespace symsurf {

/// A random surface, its own image in the plane z = 0 or without a mirror, about one unit large.
class RandomBody {
 public:
  virtual ~RandomBody() = default;

  /// A point of the surface; evenly spread, those of sheets over x and y.
  virtual Vector3 point(Random& random) const = 0;
};

/// "creature", "head", "part", "mask" or "sheets", all different by what is drawn from `random`.
/// Not symmetric: nothing has a counterpart, and of the sheets one is left.
std::unique_ptr<RandomBody> random_body(std::string_view shape, bool symmetric, Random& random);

/// A box, or a cylinder along its third axis, of a hard body; a hole is taken out.
struct Block {
  Vector3 centre, half;  ///< half its sides; of a cylinder the radius, the same, half its height
  Matrix3 axes;          ///< unit vectors, one a column
  bool round, hole;

  Block mirrored() const;
};

/// A body with edges: the union of blocks less the union of holes.
class HardBody : public RandomBody {
 public:
  explicit HardBody(std::vector<Block> blocks);

  Vector3 point(Random& random) const override;

 private:
  double value(const Vector3& x, Vector3& gradient) const;

  std::vector<Block> blocks_;
  Vector3 low_, high_;
};

/// A limb of a soft body: its surface alone would be about `radius` from the segment from a to b. A
/// negative weight dents what is there.
struct Limb {
  Vector3 a, b;
  double radius, weight = 1;

  Limb mirrored() const { return {a.cwiseProduct(flip()), b.cwiseProduct(flip()), radius, weight}; }
  static Vector3 flip() { return {1, 1, -1}; }
};

/// A smooth body, where a sum of polynomials of the distances from its limbs reaches a level: soft
/// objects (Wyvill, McPheeters and Wyvill 1986).
class SoftBody : public RandomBody {
 public:
  explicit SoftBody(std::vector<Limb> limbs);

  Vector3 point(Random& random) const override;

  /// With so many small bumps and dents on its surface, each on both sides unless not symmetric.
  SoftBody with_bumps(int count, double least, double greatest, bool symmetric,
                      Random& random) const;

 private:
  /// Above the level inside.
  double value(const Vector3& x, Vector3& gradient) const;

  std::vector<Limb> limbs_;
  Vector3 low_, high_;
};

/// sin(2 pi turns) by Taylor's series: sums and products, which IEEE 754 rounds alike, as it does
/// not ask of a library's sine. To a few units of the last digit.
inline double sine_of_turns(double turns) {
  constexpr double tau = 6.283185307179586476925;
  double t = turns - std::floor(turns + 0.5);  // -1/2 .. 1/2
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = tau * t, squared = x * x;
  double sum = 1;
  for (int k = 20; k >= 2; k -= 2) sum = 1 - squared / (k * (k + 1)) * sum;
  return x * sum;
}

inline double cosine_of_turns(double turns) { return sine_of_turns(turns + 0.25); }

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
