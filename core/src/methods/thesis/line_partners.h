#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

#include "methods/thesis/box_tree.h"
#include "methods/thesis/plane_curve.h"

namespace symsurf {

/// Which of some points is nearest to the line of each of some others, all along one direction.
///
/// Nearest to a line is nearest in the projection along it. All are sorted along a curve through
/// the projection, so that a tree of boxes over the targets answers eight queries at once, however
/// sheets are turned. Keeps its room from call to call.
class LinePartners {
 public:
  /// `names` of the points: of those equally near the one of the lowest is taken.
  LinePartners(PointsView points, const std::vector<std::int32_t>& names);

  /// Searches among the rows `targets`, at least one, for each of the rows `queries`. `direction`
  /// is a unit vector.
  void find(const std::vector<std::int32_t>& queries, const std::vector<std::int32_t>& targets,
            const Vector3& direction, const Context& context);

  /// Of each query: the row that is nearest to its line, and its squared distance from the line.
  const std::vector<std::int32_t>& rows() const { return rows_; }
  const std::vector<double>& squared() const { return squared_; }

 private:
  struct Query {
    float u, v;
    std::int32_t number;  // among the queries
    std::int32_t run;     // of the targets that lie about here along the curve
  };

  void sort(const std::vector<std::int32_t>& queries, const std::vector<std::int32_t>& targets,
            const Vector3& direction, const Context& context);

  PointsView points_;
  const std::vector<std::int32_t>& names_;
  Vector3 centre_;
  double scale_ = 1;
  PlanePlaces places_;
  PlaneCurve curve_;
  BoxTree targets_;
  std::vector<Query> queries_;  // along the curve
  std::vector<std::int32_t> rows_;
  std::vector<double> squared_;
};

}  // namespace symsurf
