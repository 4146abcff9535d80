#include "methods/free_form/free_form_pairing.h"

#include <algorithm>
#include <vector>

#include "base/math.h"
#include "score/matching.h"

namespace symsurf::perpendicular {

namespace {

// Where partners are exact they agree about each other, and a point as near to its own image as
// others to theirs lies on the mirror. Elsewhere no point is its own partner, and the surface may
// end before it reaches the middle between two.
void drop_false_pairs(Result& result, const Cloud& cloud, bool exact) {
  constexpr double as_near = 2, rounding = 1e-9;
  if (result.pairs.rows() == 0) return;
  const std::vector<double> residuals(result.residuals.begin(), result.residuals.end());
  const double on_mirror =
      exact ? std::max(rounding * cloud.diagonal, as_near * median(residuals)) : -1;
  std::vector<Index> partner(cloud.points.size(), -1);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    partner[result.pairs(row, 0)] = result.pairs(row, 1);
  std::vector<Index> kept;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    const Index i = result.pairs(row, 0), j = result.pairs(row, 1);
    if ((j == i && result.residuals[row] > on_mirror) || (exact && partner[j] != i)) continue;
    if (result.surface_points.row(row).allFinite()) kept.push_back(row);
  }
  keep_pairs(result, kept);
}

}  // namespace

void add_pairs(Result& result, const Cloud& cloud, const SearchCloud& searched,
               const GrownSurface& surface, double pair_distance, const Context& context) {
  PointTree tree(cloud.points, context.stage(0, 0.2));
  // Farther off there are only mere neighbours.
  const double limit = std::min(pair_distance, reach(surface) * searched.spacing);
  symsurf::add_pairs(result, cloud.points, std::move(tree), *result.mirror, limit * cloud.diagonal,
                     context.stage(0.2, 0.7));
  if (!surface.exact)
    result.surface_points = result.mirror->project(result.surface_points, context.stage(0.7, 1));
  drop_false_pairs(result, cloud, surface.exact);
}

}  // namespace symsurf::perpendicular
