#pragma once

#include "methods/thesis/block_search.h"

namespace symsurf {

/// Which places are nearest to each of eight others.
class PlaceQueries : public BlockQueries {
 public:
  using Places = BoxTree::Coordinates;

  /// `rounding`: more than that of any distance between places. `axes`: 2 where no z counts.
  PlaceQueries(float rounding, int axes) : slack_(2 * rounding), axes_(axes) {}

  void begin(const Places& places, const Limits& squared);
  /// The same limits, from the places opposite.
  void turn_round();

  void bound(const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) const;
  bool lower_limits(const BoxTree::Run& run);
  Bits near(const BoxTree::Run& run) const;

 private:
  float slack_;
  int axes_;
  Places places_{};
};

}  // namespace symsurf
