#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <array>
#include <cstdint>
#include <vector>

#include "methods/thesis/place_queries.h"

namespace symsurf {

/// The cosine of the angle between unit normals, or between lines; within rounding of 1, or above,
/// it is 1: all these angles are 0.
double cosine_between(const Vector3& a, const Vector3& b, bool as_lines);

/// Finds which of some normals makes the smallest angle with another (equal angles: the lowest
/// index): the nearest on the unit sphere. A tree of boxes answers eight queries at once.
class MostParallel {
 public:
  static constexpr Index block = PlaceQueries::block;

  MostParallel(PointsView normals, bool as_lines);

  /// Adds one to be found, along a curve through the normals.
  void add(std::int32_t index);
  /// After the last, of at least one.
  void build(const Context& context);

  /// Where one that is asked for now would be added: a good guess where its answer will lie.
  std::int32_t guess() const;
  /// Searches for all eight; `guess` is that of one of them.
  void find(const std::array<std::int32_t, block>& indices, std::int32_t guess);
  std::int32_t operator[](Index which) const { return best_[which]; }

  /// Makes the list that of the most parallel to one of the normals, best first, itself left out.
  /// It takes one query at a time; what was listed for one nearby helps.
  void list(std::int32_t index, std::size_t count, std::vector<std::int32_t>& indices) const;

 private:
  PointsView normals_;
  bool as_lines_;
  BoxTree tree_;
  PlaceQueries queries_;
  std::array<std::int32_t, block> best_;
  std::array<double, block> cosine_;
};

}  // namespace symsurf
