#pragma once

#include <functional>
#include <vector>

#include "recurring/recurring_part.h"

namespace symsurf {

/// From a position to the surface, infinite far from it.
using SquaredDistance = std::function<double(const Vector3& x)>;

/// Which instance each point of a mesh belongs to, and how well instances fit.
struct PartPoints {
  /// Of each point; -1: none.
  std::vector<Index> part, instance;
  /// Of each instance of each part: 1 where the surface about the lines of the first lands on the
  /// surface, less the farther off it comes, 0 beyond the tolerance.
  std::vector<std::vector<double>> scores;
  /// The points of each instance of each part, ascending. A corner may be one of two instances: it
  /// is among those of both, though it counts for the first.
  std::vector<std::vector<std::vector<Index>>> members;
};

/// A point belongs to the instance with the feature line nearest to it, where it lies in the box
/// around that one's lines.
PartPoints part_points(PointsView points, const FeatureLines& graph,
                       const std::vector<RecurringPart>& parts, double tolerance,
                       const SquaredDistance& to_surface, const Context& context);

}  // namespace symsurf
