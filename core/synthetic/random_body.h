#pragma once

#include <symsurf/points.h>

#include <memory>
#include <string_view>

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

}  // namespace symsurf
