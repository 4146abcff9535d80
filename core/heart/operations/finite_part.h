#pragma once

#include <symsurf/operations.h>

#include <vector>

namespace symsurf {

/// What an operation works on where some points are not finite, as in clouds of depth cameras: the
/// others and the faces between them. The points left out keep their places in the result, without
/// values.
class FinitePart {
 public:
  /// Throws InvalidInput where no point is finite. Both must outlive it.
  FinitePart(const OperationInput& whole, const Operation& operation);
  FinitePart(const FinitePart&) = delete;
  FinitePart& operator=(const FinitePart&) = delete;

  const OperationInput& input() const { return part_; }

  /// Makes the result for the part that for the whole, and counts the points left out.
  void map_back(OperationResult& result) const;

 private:
  // Of one of the part, or added behind it, its number among the whole and what is added.
  Index whole_point(Index i) const;
  Index whole_face(Index f) const;
  void map_sources(OperationResult& result) const;
  void map_rows(OperationResult& result) const;
  void map_arrays(OperationResult& result) const;

  const OperationInput& whole_;
  const Operation& operation_;
  OperationInput part_;
  std::vector<Index> kept_points_, kept_faces_;  // where some are left out
  Points points_;
  Triangles faces_;
};

}  // namespace symsurf
