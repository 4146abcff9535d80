#include "score/rematching.h"

#include <vector>

#include "score/matching.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

// The methods that find such mirrors project surface points onto them.
bool has_any_shape(const Mirror& mirror) {
  return mirror.kind() == "free-form" || mirror.kind() == "quadric";
}

void put_on_mirror(Result& result, const Context& context) {
  result.surface_points = result.mirror->project(result.surface_points, context);
  std::vector<Index> reached;
  for (Index row = 0; row < result.pairs.rows(); ++row)
    if (result.surface_points.row(row).allFinite()) reached.push_back(row);
  keep_pairs(result, reached);
}

}  // namespace

void match_again(Result& result, const Cloud& cloud, const ParameterValues& values,
                 const Context& context) {
  if (!result.mirror) return;
  const Values parameters = result.parameters.empty() ? values.all() : result.parameters;
  const double pair_distance = std::get<double>(parameters.at("pair_distance"));
  add_pairs(result, cloud.points, PointTree(cloud.points, context), *result.mirror,
            pair_distance * cloud.diagonal, context);
  if (has_any_shape(*result.mirror)) put_on_mirror(result, context);
  count_unpaired(result, cloud.points.size());
  const auto mean = result.statistics.find("mean_residual");
  if (mean != result.statistics.end())
    mean->second = result.residuals.size() > 0 ? result.residuals.mean() : 0.0;
}

}  // namespace symsurf
