#pragma once

#include <vector>

#include "synthetic/random_body.h"

namespace symsurf {

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

}  // namespace symsurf
