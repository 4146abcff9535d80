#include <symsurf/free_form.h>

#include "../mirror_score.h"
#include "../perpendicular/pairing.h"
#include "../perpendicular/parametric_method.h"
#include "../perpendicular/search.h"
#include "methods.h"

namespace symsurf {

namespace {

std::shared_ptr<Mirror> in_input_units(const perpendicular::SearchCloud& cloud,
                                       const perpendicular::Sheet& sheet) {
  return sheet.mirror->transformed(cloud.diagonal, Matrix3::Identity(), cloud.centroid);
}

Result find_free_form(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const perpendicular::Search search =
      perpendicular::search(cloud, values.integer("sample_size"), context.stage(0, 0.7));
  Result result;
  result.method = "perpendicular";
  result.statistics["noise"] = search.cloud.noise * search.cloud.diagonal;
  if (search.sheets.empty()) return result;

  const perpendicular::Sheet& best = search.sheets.front();
  result.mirror = in_input_units(search.cloud, best);
  const PointTree tree(cloud.points, context.stage(0.7, 0.75));
  const NearestPoints points(cloud.points, tree, context);
  const MirrorScore score(cloud, points, context.stage(0.75, 0.8));
  score.fill(result);
  result.statistics["typical_miss"] =
      best.typical_miss * search.cloud.spacing * search.cloud.diagonal;
  perpendicular::add_pairs(result, cloud, search.cloud, best, values.real("pair_distance"),
                           context.stage(0.8, 1));
  const auto most = static_cast<std::size_t>(values.integer("max_candidates"));
  for (std::size_t k = 1; k < search.sheets.size() && result.candidates.size() < most; ++k) {
    Result other;
    other.method = result.method;
    other.mirror = in_input_units(search.cloud, search.sheets[k]);
    score.fill(other);
    result.candidates.push_back(std::move(other));
  }
  return result;
}

Result run_perpendicular(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  return perpendicular::run_on_what_tells(cloud, values, context, find_free_form);
}

}  // namespace

Method perpendicular_method() {
  Method method;
  method.name = "perpendicular";
  method.title = "Curved mirror, perpendicular mapping";
  method.summary =
      "Finds a curved mirror of any shape that maps points along its normals, by growing sheets of "
      "oriented midpoints and by bending planes.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.sees_inside = true;
  method.automatic = true;
  method.run = run_perpendicular;
  return method;
}

}  // namespace symsurf
