#include <symsurf/detect.h>

#include <algorithm>
#include <chrono>

#include "cloud.h"

namespace symsurf {

namespace {

// Enough to outline the object; every k-th point, and the extreme ones, so that nothing sticks out.
std::shared_ptr<const Points> outline(PointsView points) {
  constexpr Index enough = 2000;
  const Index step = std::max<Index>(1, points.size() / enough);
  std::vector<Index> chosen;
  for (Index i = 0; i < points.size(); i += step) chosen.push_back(i);
  for (int axis = 0; axis < 3; ++axis) {
    Index low, high;
    points.matrix().col(axis).minCoeff(&low);
    points.matrix().col(axis).maxCoeff(&high);
    chosen.insert(chosen.end(), {low, high});
  }
  auto sample = std::make_shared<Points>(static_cast<Index>(chosen.size()), 3);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    sample->row(static_cast<Index>(i)) = points[chosen[i]].transpose();
  return sample;
}

// For methods that cannot do with fewer pairs than all.
void keep_pairs_of(Result& result, const Rows& rows) {
  std::vector<Index> kept;
  for (Index row = 0; row < result.pairs.rows(); ++row)
    if (rows.contains(result.pairs(row, 0))) kept.push_back(row);
  if (static_cast<Index>(kept.size()) == result.pairs.rows()) return;
  result.pairs = Pairs(result.pairs(kept, Eigen::all));
  result.residuals = Eigen::VectorXd(result.residuals(kept));
  result.surface_points = Points(result.surface_points(kept, Eigen::all));
}

}  // namespace

Result detect(PointsView points, const Options& options, const Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const Method& chosen = method(options.method);
  const ParameterValues values(chosen.name, chosen.parameters, options.parameters);
  Cloud cloud = checked_cloud(points, options.normals, chosen.minimum_points, context.stage(0, 0));
  cloud.seed = options.seed;

  context.report(0);
  Result result = chosen.run(cloud, values, context);
  keep_pairs_of(result, context.paired_rows());
  const std::shared_ptr<const Points> footprint = outline(points);
  if (result.mirror) result.mirror->set_footprint(footprint);
  for (Result& candidate : result.candidates)
    if (candidate.mirror) candidate.mirror->set_footprint(footprint);
  if (result.parameters.empty()) result.parameters = values.all();
  context.report(1);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
