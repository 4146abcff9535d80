#pragma once

#include <cstdint>
#include <vector>

#include "preprocess/preprocessing.h"

namespace symsurf {

/// Sorting of the points by x, then y, then z: for methods that take the first of equals, which so
/// is the same one in whatever order the points were given. Copies keep their order.
class PositionOrder : public Stage {
 public:
  bool apply(Cloud& cloud, const Context& context) override;
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 private:
  std::vector<std::int32_t> order_;  // of each point sorted, which it is of those given
};

}  // namespace symsurf
