#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>

#include <optional>
#include <vector>

namespace symsurf {

/// The places where points stand, several in one where they are copies: the corners of triangles
/// that nobody merged, a scan appended to itself.
class Places {
 public:
  /// None where hardly any of the points are copies.
  static std::optional<Places> where_copied(PointsView points, const Context& context);

  Index size() const { return static_cast<Index>(first_.size()); }

  /// The rows of the first point in every place.
  Points rows(PointsView points) const;

  /// From what was found of the places to what it says of the points: each has its place's partner.
  void hand_on(Result& result) const;

 private:
  Places(PointsView points, const Context& context);

  std::vector<std::int32_t> first_;  // point, a place
  std::vector<std::int32_t> place_;  // a point
};

}  // namespace symsurf
