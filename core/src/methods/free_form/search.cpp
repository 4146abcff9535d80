#include "methods/free_form/search.h"

#include <algorithm>
#include <utility>

#include "methods/free_form/assembly.h"
#include "methods/free_form/bending.h"
#include "methods/free_form/exploration.h"
#include "methods/free_form/seeds.h"

namespace symsurf::perpendicular {

namespace {

constexpr std::size_t few_trials = 6;
constexpr double settled = 0.85, settled_exactly = 0.3;  // shares of the points

// Whether points have exact partners: smoothing would spoil them.
bool has_exact_partners(const SearchCloud& cloud, const Seeds& seeds) {
  for (const std::vector<Seed>* kind : {&seeds.along, &seeds.across})
    for (const Growth& growth : trials(cloud, *kind, few_trials))
      if (growth.exact() && growth.closeness() > 0.6) return true;
  return false;
}

}  // namespace

Search search(const Cloud& cloud, Index sample_size, const Context& context) {
  Search search{SearchCloud(cloud, sample_size, context.stage(0, 0.2)), {}};
  Seeds seeds = find_seeds(search.cloud, cloud.seed, context.stage(0.2, 0.4));
  if (search.cloud.noisy() && !has_exact_partners(search.cloud, seeds)) {
    search.cloud.smooth();
    seeds = find_seeds(search.cloud, cloud.seed, context.stage(0.4, 0.6));
  }
  explore(search.cloud, seeds.along, search.surfaces, context.stage(0.6, 0.7));
  explore(search.cloud, seeds.across, search.surfaces, context.stage(0.7, 0.75));
  const bool found =
      std::any_of(search.surfaces.begin(), search.surfaces.end(), [](const GrownSurface& surface) {
        return surface.support > (surface.exact ? settled_exactly : settled);
      });
  if (!found) bend_planes(cloud, search.cloud, search.surfaces, context.stage(0.75, 0.85));
  search.surfaces = assemble(search.cloud, std::move(search.surfaces), context.stage(0.85, 1));
  return search;
}

bool has_exact_partners(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const SearchCloud all(cloud, values.integer("sample_size"), context);
  return has_exact_partners(all, find_seeds(all, cloud.seed, context));
}

}  // namespace symsurf::perpendicular
