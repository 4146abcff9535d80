#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <chrono>

#include "base/math.h"
#include "detection/pipeline.h"
#include "pairing/matching.h"
#include "preprocess/boundary.h"
#include "score/mirror_score.h"
#include "score/verdict.h"
#include "search/methods.h"

namespace symsurf {

FoundMirror found_mirror(const Result& result, bool require_found) {
  const bool found = result.verdict() == "found";
  if (!found && (require_found || !result.mirror))
    throw InvalidInput("the shape has no mirror: " + result.reason());
  if (!result.mirror) throw InvalidInput("the result of " + result.method + " has no mirror");
  if (found) return {result.mirror, ""};
  return {result.mirror, "the verdict on the mirror is \"none\": " + result.reason() +
                             "; it is used all the same, with require_found this is an error"};
}

const Parameter& require_found_parameter() {
  static const Parameter parameter = Parameter::boolean(
      "require_found", false,
      "Refuse a mirror that is found with the verdict \"none\"; otherwise it is used, with a "
      "warning.");
  return parameter;
}

Values candidate_values(const Result& result) {
  const auto count = static_cast<Index>(result.candidates.size());
  if (count == 0) return {};
  Eigen::MatrixXd scores(count, 1), normals(count, 3), offsets(count, 1);
  bool planes = true;
  for (Index row = 0; row < count; ++row) {
    const Result& candidate = result.candidates[row];
    scores(row, 0) = candidate.score;
    planes = planes && candidate.mirror && candidate.mirror->kind() == "plane";
    if (!planes) continue;
    const Foot origin = *candidate.mirror->at(Vector3::Zero());
    normals.row(row) = origin.normal;
    offsets(row) = origin.distance;
  }
  if (!planes) return {{"candidate_scores", scores}};
  return {
      {"candidate_scores", scores}, {"candidate_normals", normals}, {"candidate_offsets", offsets}};
}

namespace {

Result scored(const Cloud& cloud, const Mirror& mirror, const Context& context) {
  Result result;
  MirrorScore(cloud, context).fill(mirror, result);
  return result;
}

// A volumetric cloud by itself or by its boundary, whichever scores more.
Result scored_over(const Cloud& cloud, const Mirror& mirror, const Context& context) {
  Result whole = scored(cloud, mirror, context);
  if (is_exact(whole) || !is_volumetric(cloud, context)) return whole;
  const Points rows = chosen_rows(cloud.points, boundary_of(cloud, context));
  Cloud boundary = checked_cloud(rows, {}, 1, context);
  boundary.tolerance = cloud.tolerance;
  Result outer = scored(boundary, mirror, context);
  return outer.score > whole.score ? outer : whole;
}

// A known mirror in place of a method that finds one.
MethodImplementation matching(const std::shared_ptr<Mirror>& known, double pair_distance) {
  MethodImplementation method;
  method.name = "match";
  method.minimum_points = 1;
  method.preprocessing = Preprocessing::none();
  method.preprocessing.remove_outliers = method.preprocessing.merge_duplicates =
      method.preprocessing.sample_faces = true;
  method.run = [known, pair_distance](const Cloud& cloud, const ParameterValues&,
                                      const Context& context) {
    Result result = scored_over(cloud, *known, context.stage(0, 0.2));
    result.method = "match";
    result.mirror = known;
    add_pairs(result, cloud, *known, pair_distance * cloud.diagonal, context.stage(0.2, 1));
    return result;
  };
  return method;
}

}  // namespace

Result match(PointsView points, const Mirror& mirror, double pair_distance, const Context& context,
             bool refuse_nonfinite, double tolerance, TrianglesView faces) {
  const ParameterValues values(
      "match", {symsurf::tolerance(), Parameter::real("pair_distance", 0, 0, infinity, "", "")},
      {{"tolerance", tolerance}, {"pair_distance", pair_distance}});
  const auto start = std::chrono::steady_clock::now();
  Cloud cloud(points);
  cloud.tolerance = values.real("tolerance");
  cloud.faces = faces;
  // Its owner keeps it.
  const std::shared_ptr<Mirror> known(std::shared_ptr<Mirror>(), const_cast<Mirror*>(&mirror));
  Result result =
      run_pipeline(matching(known, pair_distance), values, cloud, refuse_nonfinite, context);
  result.mirror = nullptr;
  result.parameters = values.all();
  judge(result, &mirror, usual_minimum_score);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
