#include "detection/pipeline.h"

#include "base/named_values.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "score/mirror_score.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

// Whether a mirror of all points of a body, each with an exact partner, is worth a search beside
// the one that was found of its boundary. That of a lattice may have none where the lattice has
// one.
bool may_hide_exact_mirror(const Result& of_boundary, const Cloud& body) {
  constexpr double by_chance = 0.4;  // score that bodies without a mirror do not reach
  constexpr Index few = 20'000;      // points, or the second search takes too long
  return of_boundary.score > by_chance && !is_exact(of_boundary) && body.points.size() <= few;
}

Cloud cloud_of(PointsView points, PointsView normals, const Options& options,
               double tolerance = usual_tolerance) {
  Cloud cloud(points, normals);
  cloud.seed = options.seed;
  cloud.tolerance = tolerance;
  return cloud;
}

}  // namespace

void report_pairs(Result& result, const MethodImplementation& finder, Index paired, Index total,
                  double residuals) {
  if (finder.reports_unpaired_points) result.statistics["unpaired_points"] = total - paired;
  if (finder.reports_mean_residual)
    result.statistics["mean_residual"] = paired > 0 ? residuals / static_cast<double>(paired) : 0.0;
}

Finder finder_of(const Result& result, const MethodImplementation& method,
                 const ParameterValues& values) {
  const bool is_own = result.method == method.name || result.method.empty();
  const MethodImplementation& finder = is_own ? method : heart_method(result.method);
  if (values.all().contains("pairs") && !values.boolean("pairs")) return {finder, {}};
  const ParameterValues defaults(finder.name, finder.parameters, {});
  const ParameterValues& used = is_own ? values : defaults;
  if (!used.all().contains("pair_distance")) return {finder, 0.0};
  return {finder, used.real("pair_distance")};
}

Result run_pipeline(const MethodImplementation& method, const ParameterValues& values, Cloud cloud,
                    bool refuse_nonfinite, const Context& context) {
  const Context before_run = context.stage(0, 0), after_run = context.stage(1, 1);
  const Index total = cloud.points.size();
  const Preprocessing policy = method.preprocessing;
  require_corners(cloud.faces, cloud.points.size());
  if (!policy.sample_faces) cloud.faces = {};

  const auto stages = make_stages(policy, method.minimum_points, values, refuse_nonfinite);
  std::vector<const Stage*> applied;
  Cloud before_last;
  for (const auto& stage : stages) {
    const Cloud before = cloud;
    const bool changed = stage->apply(cloud, before_run);
    if (changed) {
      applied.push_back(stage.get());
      before_last = before;
    }
    const Index needed = needed_points(cloud, method.minimum_points);
    if (changed || stage == stages.front())
      validate(cloud, needed, before_run);
    else
      require_count(cloud.points.size(), needed);
  }
  context.report(0);

  Result result = method.run(cloud, values, context);
  const bool of_boundary =
      policy.extract_boundary && !applied.empty() && applied.back() == stages.back().get();
  if (of_boundary && may_hide_exact_mirror(result, before_last)) {
    Result of_all = method.run(before_last, values, after_run);
    if (is_exact(of_all)) {
      result = std::move(of_all);
      applied.pop_back();
    }
  }
  const Finder finder = finder_of(result, method, values);
  const bool pairs_anew = result.mirror && (policy.sample_faces || policy.extract_boundary);
  const PairDistance pair_distance = pairs_anew ? finder.pair_distance : std::nullopt;
  set_footprint(result, cloud);
  for (auto stage = applied.rbegin(); stage != applied.rend(); ++stage)
    (*stage)->map_back(result, pair_distance, after_run);
  if (finder.pair_distance && result.mirror)
    report_pairs(result, finder.method, result.pairs.rows(), total, result.residuals.sum());
  drop_nonfinite(result.statistics);
  for (Result& candidate : result.candidates) drop_nonfinite(candidate.statistics);
  return result;
}

Result detect_in_one(PointsView points, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context) {
  Cloud cloud = cloud_of(points, options.normals, options, values.real("tolerance"));
  cloud.faces = options.faces;
  Result result = run_pipeline(method, values, cloud, options.refuse_nonfinite, context);
  judge(result, result.mirror.get(), values.real("minimum_score"));
  return result;
}

double diagonal_of(PointsView points, const Options& options, const MethodImplementation& method,
                   const Context& context) {
  double found = 0;
  MethodImplementation measuring;  // in place of the method
  measuring.name = method.name;
  measuring.minimum_points = method.minimum_points;
  measuring.preprocessing = Preprocessing::none();
  measuring.preprocessing.remove_outliers = method.preprocessing.remove_outliers;
  measuring.run = [&found](const Cloud& cloud, const ParameterValues&, const Context&) {
    found = cloud.diagonal;
    return Result{};
  };
  run_pipeline(measuring, {}, cloud_of(points, {}, options), options.refuse_nonfinite, context);
  return found;
}

}  // namespace symsurf
