#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>
#include <symsurf/triangles_view.h>

#include <vector>

namespace symsurf {

/// Some points of a cloud removed: what a pre-processing stage does that leaves points out. Of all
/// processes, where several share the cloud out.
class RowRemoval {
 public:
  RowRemoval() = default;
  /// `own`: this process's removed points, in their order; `first`: how many points the processes
  /// before this one have. Collective.
  RowRemoval(std::vector<Index> own, Index first, const Context& context);

  /// Of all processes.
  Index count() const { return static_cast<Index>(all_.size()); }

  /// Of these rows, one a point of this process, those of the points that stay.
  Points apply(PointsView rows) const;
  /// The faces between points that stay, by their new numbers. `points`: how many there were.
  Triangles apply(TrianglesView faces, Index points) const;

  /// From what was found of the points that stay to what it says of all: the others have no
  /// partners.
  void map_back(Result& result) const;

 private:
  std::vector<Index> own_, all_;  // in the order of the points; own ones from this process's first
};

}  // namespace symsurf
