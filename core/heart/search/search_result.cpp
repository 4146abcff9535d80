#include "search/search_result.h"

#include <algorithm>
#include <utility>

#include "base/math.h"
#include "cloud/voxel_grid.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/registry.h"

namespace symsurf::perpendicular {

namespace {

// Farther than `beyond` from the feet of pairs a mirror is extrapolated; points closer to each
// other than `close` are no pair for that. In diagonals, and in spacings where these are longer.
constexpr double beyond = 0.05, close = 0.03, sparse = 3;
constexpr double voxels_within = 0.4;  // of what is near: edges that a voxel's middle stands for

// Where partners are exact they agree about each other, or lie on the image: beside a crease the
// nearest part of the mirror is another for the partner. A point as near to its own image as others
// to theirs lies on the mirror. Where partners are not exact no point is its own, and the surface
// may end before it reaches the middle between two.
void drop_false_pairs(Result& result, const Cloud& cloud, bool exact, double spacing) {
  constexpr double on_image = 0.15;  // spacings
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
    const double residual = result.residuals[row];
    if (j == i && residual > on_mirror) continue;
    if (exact && partner[j] != i && residual > on_image * spacing) continue;
    if (result.surface_points.row(row).allFinite()) kept.push_back(row);
  }
  keep_pairs(result, kept);
}

void pair_points(Result& result, const Cloud& cloud, PointTree tree, const SearchCloud& searched,
                 const GrownSurface& surface, double pair_distance, const Context& context) {
  const double spacing = searched.spacing * searched.diagonal;
  // Farther off there are only mere neighbours.
  const double limit = std::min(pair_distance * cloud.diagonal, reach(surface) * spacing);
  add_pairs(result, cloud.points, std::move(tree), *result.mirror, limit, context.stage(0, 0.6));
  if (!surface.exact)
    result.surface_points = result.mirror->project(result.surface_points, context.stage(0.6, 1));
  drop_false_pairs(result, cloud, surface.exact, spacing);
}

// The voxels, in the search's frame and of an edge in its unit, that hold any of the points.
std::vector<Vector3> occupied_voxels(Points points, const SearchCloud& searched, double edge) {
  if (points.rows() == 0) return {};
  points = (points.rowwise() - searched.centroid.transpose()) * searched.axes / searched.diagonal;
  const VoxelGrid grid(points.colwise().minCoeff(), points.colwise().maxCoeff(), edge);
  std::vector<Index> voxels;
  for (Index k = 0; k < points.rows(); ++k)
    voxels.push_back(grid.index(grid.cell_of(points.row(k).transpose())));
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  std::vector<Vector3> middles;
  for (const Index voxel : voxels)
    middles.push_back(searched.axes * grid.middle(grid.cell(voxel)) * searched.diagonal +
                      searched.centroid);
  return middles;
}

// How much of the mirror under the points is far from the feet of all pairs: it goes on there as it
// bends elsewhere, and nothing says that it is right. Points next to the mirror, whose neighbours
// are their images', are no evidence. By area: where one side is missing there are fewer points.
void tell_extrapolated(Result& result, const Cloud& cloud, const SearchCloud& searched,
                       const Context& context) {
  const double near = std::max(beyond, sparse * searched.spacing);
  const double next_to = std::max(close, sparse * searched.spacing) * searched.diagonal;
  std::vector<char> paired(cloud.points.size(), 0);
  std::vector<Index> evidence, others;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    const Index i = result.pairs(row, 0), j = result.pairs(row, 1);
    if ((cloud.points[i] - cloud.points[j]).norm() < next_to) continue;
    evidence.push_back(row);
    paired[i] = paired[j] = 1;
  }
  for (Index i = 0; i < cloud.points.size(); ++i)
    if (!paired[i]) others.push_back(i);
  const Points pairs = chosen_rows(result.surface_points, evidence);
  const Points feet =
      finite_rows(result.mirror->project(chosen_rows(cloud.points, others), context.stage(0, 0.7)));
  Points all(pairs.rows() + feet.rows(), 3);
  all << pairs, feet;
  const std::vector<Vector3> mirror =
      occupied_voxels(std::move(all), searched, voxels_within * near);
  const PointTree tree(pairs, context.stage(0.7, 1));
  const double squared = near * near * searched.diagonal * searched.diagonal;
  const auto far = std::count_if(mirror.begin(), mirror.end(), [&](const Vector3& x) {
    return tree.nearest(x, squared).index < 0;
  });
  const auto voxels = static_cast<double>(std::max<std::size_t>(1, mirror.size()));
  result.statistics["extrapolated_share"] = static_cast<double>(far) / voxels;
}

// What chance explains has no score to rank by: then the search's own order holds.
void put_first(const std::shared_ptr<Mirror>& mirror, Result& best) {
  const auto at = std::find_if(best.candidates.begin(), best.candidates.end(),
                               [&](const Result& other) { return other.mirror == mirror; });
  if (at == best.candidates.end()) return;
  Result first = std::move(*at);
  best.candidates.erase(at);
  first.candidates = std::move(best.candidates);
  best.candidates.clear();
  first.candidates.insert(first.candidates.begin(), std::move(best));
  best = std::move(first);
  cap_candidates(best);
}

}  // namespace

std::shared_ptr<Mirror> in_input_units(const Mirror& mirror, const SearchCloud& searched) {
  return mirror.transformed(searched.diagonal, searched.axes, searched.centroid);
}

void fill(Result& result, const Cloud& cloud, const SearchCloud& searched,
          const std::vector<Found>& found, const ParameterValues& values, const Context& context) {
  if (found.empty()) return;
  PointTree tree(cloud.points, context.stage(0, 0.2));
  const NearestPoints points(cloud.points, tree, context);
  const MirrorScore score(cloud, points, context.stage(0.2, 0.4));
  const auto most = 1 + static_cast<std::size_t>(values.integer("max_candidates"));
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (std::size_t k = 0; k < std::min(most, found.size()); ++k) mirrors.push_back(found[k].mirror);
  Values statistics = std::move(result.statistics);
  result = score.ranked(result.method, mirrors);
  if (statistic(result, "evidence") < 0) put_first(mirrors.front(), result);
  const GrownSurface& surface =
      found[std::find(mirrors.begin(), mirrors.end(), result.mirror) - mirrors.begin()].surface;
  statistics["typical_miss"] = surface.typical_miss * searched.spacing * searched.diagonal;
  result.statistics.merge(statistics);
  if (!values.boolean("pairs")) return;
  pair_points(result, cloud, std::move(tree), searched, surface, values.real("pair_distance"),
              context.stage(0.4, 0.9));
  tell_extrapolated(result, cloud, searched, context.stage(0.9, 1));
}

std::vector<Parameter> search_parameters() {
  return {
      Parameter::integer("sample_size", 12000, 200, 100000, "points",
                         "Points that the search works on; larger clouds are thinned to it."),
      max_candidates(10, 1000, "mirrors"),
      pair_distance(),
  };
}

}  // namespace symsurf::perpendicular
