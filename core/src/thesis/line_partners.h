#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <array>
#include <cstdint>
#include <vector>

#include "strips.h"

namespace symsurf {

/// Which of some points is nearest to the line of each of some others, all along one direction.
///
/// Nearest to a line is nearest in the projection along it. The targets are sorted into strips of
/// the projection; a query looks at a handful of them on any sheet, however it is turned, and at
/// the square root of their number at worst on clusters. Keeps its room from call to call.
class LinePartners {
 public:
  /// `names` of the points: of those equally near the one of the lowest is taken.
  LinePartners(PointsView points, const std::vector<std::int32_t>& names);

  /// Searches among the rows `targets`, at least one, for each of the rows `queries`: the cheaper,
  /// the nearer each is to the one before. `direction` is a unit vector.
  void find(const std::vector<std::int32_t>& queries, const std::vector<std::int32_t>& targets,
            const Vector3& direction, const Context& context);

  /// Of each query: the row that is nearest to its line, and its squared distance from the line.
  const std::vector<std::int32_t>& rows() const { return rows_; }
  const std::vector<double>& squared() const { return squared_; }

 private:
  void project(const std::vector<std::int32_t>& rows, Places& places, const Context& context) const;

  PointsView points_;
  const std::vector<std::int32_t>& names_;
  Vector3 centre_;
  double scale_ = 1;
  std::array<Vector3, 2> axes_;
  Places target_places_, query_places_;
  Strips strips_;
  std::vector<std::int32_t> rows_;
  std::vector<double> squared_;
};

}  // namespace symsurf
