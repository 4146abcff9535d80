#include <symsurf/free_form.h>

#include <algorithm>

#include "../matching.h"
#include "../perpendicular/assembly.h"
#include "../perpendicular/exploration.h"
#include "../perpendicular/search_cloud.h"
#include "../perpendicular/seeds.h"
#include "methods.h"

namespace symsurf {

namespace {

using namespace perpendicular;

// A point is not its own partner. Where partners are exact they agree about each other.
void drop_false_pairs(Result& result, Index size, bool mutual) {
  std::vector<Index> partner(size, -1);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    partner[result.pairs(row, 0)] = result.pairs(row, 1);
  Index kept = 0;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    const Index i = result.pairs(row, 0), j = result.pairs(row, 1);
    if (j == i || (mutual && partner[j] != i)) continue;
    result.pairs.row(kept) = result.pairs.row(row);
    result.residuals[kept] = result.residuals[row];
    result.surface_points.row(kept++) = result.surface_points.row(row);
  }
  result.pairs.conservativeResize(kept, 2);
  result.residuals.conservativeResize(kept);
  result.surface_points.conservativeResize(kept, 3);
}

struct Trials {
  std::vector<Growth> along, across;

  bool exact() const {
    const auto is_exact = [](const Growth& growth) {
      return growth.exact() && growth.closeness() > 0.6;
    };
    return std::any_of(along.begin(), along.end(), is_exact) ||
           std::any_of(across.begin(), across.end(), is_exact);
  }
};

// What the search starts from: seeds and the first steps from them.
Trials begin(const SearchCloud& cloud, std::uint64_t seed, const Context& context) {
  const Seeds seeds = find_seeds(cloud, seed, context);
  return {trials(cloud, seeds.along), trials(cloud, seeds.across)};
}

Result run_perpendicular(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  SearchCloud search(cloud, values.integer("sample_size"), context.stage(0, 0.1));
  Trials begun = begin(search, cloud.seed, context.stage(0.1, 0.3));
  if (search.noisy() && !begun.exact()) {
    search.smooth();
    begun = begin(search, cloud.seed, context.stage(0.3, 0.4));
  }
  std::vector<Sheet> sheets = explore(search, std::move(begun.along), context.stage(0.4, 0.5));
  for (Sheet& sheet : explore(search, std::move(begun.across), context.stage(0.5, 0.6)))
    sheets.push_back(std::move(sheet));
  sheets = assemble(search, std::move(sheets), context.stage(0.6, 0.8));
  Result result;
  result.method = "perpendicular";
  if (sheets.empty()) return result;
  const Sheet& best = sheets.front();
  result.score = best.explained;
  result.statistics["typical_miss"] = best.typical_miss;
  result.statistics["exact"] = best.exact;
  result.mirror = best.mirror->transformed(search.diagonal, Matrix3::Identity(), search.centroid);
  const PointTree tree(cloud.points, context.stage(0.8, 0.85));
  // Farther off there are only mere neighbours.
  const double limit =
      std::min(values.real("pair_distance"), (best.exact ? 0.8 : 1.3) * search.spacing);
  add_pairs(result, cloud.points, tree, *result.mirror, limit * cloud.diagonal,
            context.stage(0.85, 1));
  drop_false_pairs(result, cloud.points.size(), best.exact);
  if (!best.exact) result.surface_points = result.mirror->project(result.surface_points);
  return result;
}

}  // namespace

Method perpendicular_method() {
  Method method;
  method.name = "perpendicular";
  method.title = "Curved mirror, perpendicular mapping";
  method.summary =
      "Finds a curved mirror of any shape that maps points along its normals, by growing a sheet "
      "of oriented midpoints.";
  method.parameters = {
      Parameter::integer("sample_size", 2500, 200, 20000, "points",
                         "Points that the search works on; larger clouds are thinned to it."),
      Parameter::real("pair_distance", 0.02, 0, 1, "diagonal",
                      "A point whose image has no point of the cloud nearer than this has no "
                      "partner."),
  };
  method.minimum_points = 12;
  method.automatic = true;
  method.run = run_perpendicular;
  return method;
}

}  // namespace symsurf
