#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <cstdint>
#include <vector>

namespace symsurf {

/// The distinct points of a cloud, in the order of their first appearance.
struct DistinctPoints {
  std::vector<std::int32_t> first;   ///< of each, the first point of the cloud that equals it
  std::vector<std::int32_t> number;  ///< of each point of the cloud, which of these it equals
};

DistinctPoints distinct_points(PointsView points, const Context& context);

/// Whether more than one in twenty points are copies of others: exact of few distinct points, an
/// estimate of many.
bool has_many_duplicates(PointsView points, const Context& context);

}  // namespace symsurf
