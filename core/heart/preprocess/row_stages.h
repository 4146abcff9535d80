#pragma once

#include <cstdint>
#include <vector>

#include "cloud/distinct_points.h"
#include "preprocess/preprocessing.h"

namespace symsurf {

/// A stage that removes points: they have no partners, and `statistic` counts them.
class RowRemoval : public Stage {
 public:
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 protected:
  explicit RowRemoval(const char* statistic) : statistic_(statistic) {}

  /// `own`: the points of this process to remove, ascending. False: there are none in any process.
  bool remove(Cloud& cloud, const std::vector<Index>& own);

  static Points without(PointsView rows, const std::vector<Index>& removed);
  /// The faces between points that stay, by their new indices. `points`: how many there were.
  static Triangles without(TrianglesView faces, const std::vector<Index>& removed, Index points);

 private:
  const char* statistic_;
  std::vector<Index> removed_;  // ascending
  Triangles faces_;
};

/// Removal of points with a NaN or infinite coordinate.
class NonfiniteRemoval : public RowRemoval {
 public:
  /// With `refuse` it changes nothing, and validation throws.
  NonfiniteRemoval(Index minimum_points, bool refuse)
      : RowRemoval("nonfinite_points"), minimum_points_(minimum_points), refuse_(refuse) {}

  /// Throws InvalidInput where some points are not finite and too few are. More points than a
  /// process can number are left to validation.
  bool apply(Cloud& cloud, const Context& context) override;

 private:
  Index minimum_points_;
  bool refuse_;
};

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
