#pragma once

#include <symsurf/points.h>

#include <memory>
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

}  // namespace symsurf
