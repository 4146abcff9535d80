#pragma once

#include <symsurf/types.h>

#include "methods/thesis/block_search.h"

namespace symsurf {

/// Which places are nearest to each of eight lines, but for one place that each line leaves out.
class LineQueries : public BlockQueries {
 public:
  /// `rounding`: more than that of any distance of a place.
  explicit LineQueries(float rounding) : rounding_(rounding) {}

  /// The line through x along a unit vector, which leaves out the place named `index`.
  void set(int which, const Vector3& x, const Vector3& unit, std::int32_t index);

  void bound(const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) const;
  bool lower_limits(const BoxTree::Run& run);
  Bits near(const BoxTree::Run& run) const;

  /// Two axes across each line, and where the line lies on them.
  struct Lines {
    std::array<BoxTree::Coordinates, 2> axis;
    std::array<std::array<float, block>, 2> at;
    std::array<std::int32_t, block> left_out;
  };

 private:
  float rounding_;
  Lines lines_{};
};

}  // namespace symsurf
