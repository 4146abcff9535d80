#pragma once

#include <symsurf/result.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "cloud/cloud.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// A cloud divided by a plane through its centroid, steps 3 to 9 of the
/// thesis's Algorithms 1 and 2: X1 lies strictly above it, X2 is the rest, and
/// the points of X1 have partners in X2.
struct Separation {
  /// By index: of a point of X1 the point of X2 nearest to its line along the
  /// plane's normal, equal distances: the lowest index; -1 for the points of
  /// X2, and for all where one side is empty.
  std::vector<std::int32_t> partner;
  std::vector<double> squared;  ///< by index: the partner's squared distance from the line, or 0
  Index upper = 0, lower = 0;   ///< how many points X1 and X2 have
};

/// The mean squared error of the partners in a projection, in input units
/// squared: (3.3) or (3.5).
using ProjectionError = std::function<double(const Separation&, const Context&)>;

/// The thesis's Algorithms 1 and 2: separates the cloud along each direction of
/// a half sphere and keeps the one of the highest score s = ln(d + 1) +
/// exp(-error) (3.4), d the shortest distance from any point to any midpoint;
/// equal scores: the first.
///
/// `steps` a half turn. The pairs stand in the order of their points, residuals
/// are distances of partners from their lines. The tree is that of the points.
Result best_separation(const Cloud& cloud, const PointTree& tree, Index steps,
                       const ProjectionError& error, const Context& context);

/// Their parameter "steps".
Parameter direction_steps();

}  // namespace symsurf
