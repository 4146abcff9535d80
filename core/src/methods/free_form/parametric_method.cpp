#include "methods/free_form/parametric_method.h"

#include <algorithm>

#include "methods/common_parameters.h"
#include "methods/free_form/free_form_pairing.h"
#include "methods/free_form/search.h"
#include "score/mirror_score.h"

namespace symsurf::perpendicular {

Result find_parametric(const std::string& method,
                       std::unique_ptr<Model> (*model)(const GrownSurface&), const Cloud& cloud,
                       const ParameterValues& values, const Context& context) {
  constexpr std::size_t most_fitted = 5;
  Search found = search(cloud, values.integer("sample_size"), context.stage(0, 0.6));
  struct Fitted {
    std::unique_ptr<Mirror> mirror;
    GrownSurface surface;
  };
  std::vector<Fitted> fits;
  const std::size_t count = std::min(found.surfaces.size(), most_fitted);
  for (std::size_t k = 0; k < count; ++k) {
    context.stage(0.6, 0.7).report(static_cast<double>(k) / static_cast<double>(count));
    Fitted f{nullptr, found.surfaces[k]};
    f.mirror = fit(found.cloud, model(f.surface), f.surface);
    if (f.mirror) fits.push_back(std::move(f));
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Fitted& a, const Fitted& b) {
    return a.surface.support > b.surface.support;
  });

  const PointTree tree(cloud.points, context.stage(0.7, 0.75));
  const NearestPoints points(cloud.points, tree, context);
  const MirrorScore score(cloud, points, context.stage(0.75, 0.8));
  Result result;
  result.method = method;
  const auto most = static_cast<std::size_t>(values.integer("max_candidates"));
  if (fits.size() > 1 + most) fits.resize(1 + most);
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const Fitted& f : fits)
    mirrors.push_back(
        f.mirror->transformed(found.cloud.diagonal, Matrix3::Identity(), found.cloud.centroid));
  if (mirrors.empty()) return result;
  result = score.ranked(method, mirrors);
  const GrownSurface& surface =
      fits[std::find(mirrors.begin(), mirrors.end(), result.mirror) - mirrors.begin()].surface;
  result.statistics["typical_miss"] =
      surface.typical_miss * found.cloud.spacing * found.cloud.diagonal;
  add_pairs(result, cloud, found.cloud, surface, values.real("pair_distance"),
            context.stage(0.8, 1));
  return result;
}

std::vector<Parameter> search_parameters() {
  return {
      Parameter::integer("sample_size", 12000, 200, 100000, "points",
                         "Points that the search works on; larger clouds are thinned to it."),
      max_candidates(10, 1000, "mirrors"),
      pair_distance(0.02),
  };
}

}  // namespace symsurf::perpendicular
