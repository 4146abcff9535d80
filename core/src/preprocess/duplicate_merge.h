#pragma once

#include "cloud/distinct_points.h"
#include "preprocess/preprocessing.h"

namespace symsurf {

/// Merging of equal points: corners of triangles that nobody merged, a scan appended to itself.
/// Only where there are many; fewer than minimum_points distinct ones are InvalidInput. Each point
/// gets the partner of the one that it was merged with.
class DuplicateMerge : public Stage {
 public:
  explicit DuplicateMerge(Index minimum_points) : minimum_points_(minimum_points) {}

  bool apply(Cloud& cloud, const Context& context) override;
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 private:
  Index minimum_points_;
  DistinctPoints distinct_;
};

}  // namespace symsurf
