#pragma once

#include <vector>

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
  std::vector<Index> removed_;  // of all processes, ascending
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

}  // namespace symsurf
