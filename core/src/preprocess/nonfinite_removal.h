#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>

#include <optional>

#include "preprocess/row_removal.h"

namespace symsurf {

/// Pre-processing that leaves out points with a NaN or infinite coordinate. Of all processes, where
/// several share the points out.
class NonfiniteRemoval {
 public:
  /// None where all points are finite, or where there are more in a process than can be numbered.
  /// Throws InvalidInput where some are not finite and fewer than `needed` are. Collective.
  static std::optional<NonfiniteRemoval> where_any(PointsView own, Index needed,
                                                   const Context& context);

  /// Of these rows, one a point of this process, those of finite points.
  Points apply(PointsView rows) const { return removal_.apply(rows); }
  /// The faces between finite points, by their new numbers. `points`: how many there were.
  Triangles apply(TrianglesView faces, Index points) const { return removal_.apply(faces, points); }

  /// From what was found of the finite points to what it says of all: the others have no partners.
  void map_back(Result& result) const;

 private:
  explicit NonfiniteRemoval(RowRemoval removal) : removal_(std::move(removal)) {}

  RowRemoval removal_;
};

}  // namespace symsurf
