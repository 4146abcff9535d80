#include <symsurf/free_form.h>

#include <algorithm>

#include "methods/free_form/free_form_pairing.h"
#include "methods/free_form/parametric_method.h"
#include "methods/free_form/search.h"
#include "methods/registry.h"
#include "score/mirror_score.h"

namespace symsurf {

namespace {

std::shared_ptr<Mirror> in_input_units(const perpendicular::SearchCloud& cloud,
                                       const perpendicular::GrownSurface& surface) {
  return surface.mirror->transformed(cloud.diagonal, Matrix3::Identity(), cloud.centroid);
}

Result run_perpendicular(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  const perpendicular::Search search =
      perpendicular::search(cloud, values.integer("sample_size"), context.stage(0, 0.7));
  Result result;
  result.method = "perpendicular";
  result.statistics["noise"] = search.cloud.noise * search.cloud.diagonal;
  if (search.surfaces.empty()) return result;

  const PointTree tree(cloud.points, context.stage(0.7, 0.75));
  const NearestPoints points(cloud.points, tree, context);
  const MirrorScore score(cloud, points, context.stage(0.75, 0.8));
  const auto most = 1 + static_cast<std::size_t>(values.integer("max_candidates"));
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (std::size_t k = 0; k < std::min(most, search.surfaces.size()); ++k)
    mirrors.push_back(in_input_units(search.cloud, search.surfaces[k]));
  Values statistics = std::move(result.statistics);
  result = score.ranked(result.method, mirrors);
  result.statistics.merge(statistics);
  const perpendicular::GrownSurface& surface =
      search.surfaces[std::find(mirrors.begin(), mirrors.end(), result.mirror) - mirrors.begin()];
  result.statistics["typical_miss"] =
      surface.typical_miss * search.cloud.spacing * search.cloud.diagonal;
  perpendicular::add_pairs(result, cloud, search.cloud, surface, values.real("pair_distance"),
                           context.stage(0.8, 1));
  return result;
}

}  // namespace

MethodImplementation perpendicular_method() {
  MethodImplementation method;
  method.name = "perpendicular";
  method.title = "Curved mirror, perpendicular mapping";
  method.summary =
      "Finds a curved mirror of any shape that maps points along its normals, by growing surfaces "
      "of oriented midpoints and by bending planes.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.preprocessing.keep_interior = perpendicular::has_exact_partners;
  method.automatic = true;
  method.run = run_perpendicular;
  return method;
}

}  // namespace symsurf
