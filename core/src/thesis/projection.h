#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

namespace symsurf {

/// For each of `queries` the one of `targets` nearest to its line along the unit vector `direction`
/// (equal distances: the lowest index), and its squared distance from the line. Both are indices
/// into `points`, targets must not be empty.
///
/// Nearest to a line is nearest in the projection along it. Targets and queries are sorted into
/// the same strips of the projection and along them; a sweep looks at a handful of targets a query
/// on any sheet, however it is turned, and at the square root of their number at worst on clusters.
struct LinePartners {
  std::vector<std::int32_t> target;
  std::vector<double> squared;
};
LinePartners nearest_to_lines(PointsView points, const std::vector<std::int32_t>& queries,
                              const std::vector<std::int32_t>& targets, const Vector3& direction,
                              const Context& context);

}  // namespace symsurf
