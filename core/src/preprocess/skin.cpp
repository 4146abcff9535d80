#include "preprocess/skin.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/quantile.h"
#include "cloud/surroundings.h"
#include "preprocess/fills_bodies.h"
#include "score/rematching.h"
#include "spatial/cells.h"

namespace symsurf {

namespace {

// What makes a point one of the skin, by more others: of those inside hardly one in a hundred has
// as many on one side.
constexpr Index around_skin = 48;
constexpr double at_skin = 0.21;

// Places along the tree's curve of the points that may be skin: of a large cloud not those of cells
// among others that hold as many as most.
std::vector<Index> outer_places(const Cloud& cloud, const PointTree& tree, const Context& context) {
  constexpr Index large = 20000;
  constexpr double in_cell = 16, full = 0.5;  // of the median cell
  std::vector<Index> places(cloud.points.size());
  std::iota(places.begin(), places.end(), 0);
  if (cloud.points.size() < large) return places;

  const PrincipalFrame& frame = cloud.frame;
  const double volume = (frame.high - frame.low).prod() / static_cast<double>(places.size());
  const Cells cells(frame.low, frame.high, std::cbrt(in_cell * volume));
  const auto cell_of = [&](Index i) { return cells.cell_of(frame.enter(cloud.points[i])); };
  std::vector<Index> held(cells.count()), occupied;
  interruptible_for(context, cloud.points.size(),
                    [&](Index i) { ++held[cells.number(cell_of(i))]; });
  std::copy_if(held.begin(), held.end(), std::back_inserter(occupied),
               [](Index n) { return n > 0; });
  const double least = full * static_cast<double>(median(std::move(occupied)));
  std::vector<char> deep(cells.count());
  interruptible_for(context, cells.count(), [&](Index number) {
    int around = 0;
    cells.for_each_row_touching(cells.numbered(number), [&](Index begin, Index end) {
      for (Index k = begin; k < end; ++k) around += static_cast<double>(held[k]) >= least;
    });
    deep[number] = around == 27;
  });
  std::erase_if(places,
                [&](Index place) { return deep[cells.number(cell_of(tree.order()[place]))]; });
  return places;
}

// Share of the points whose partner is their image, to the rounding of single precision.
double exactly_paired(const Result& result, const Cloud& cloud) {
  constexpr double rounding = 1e-6;
  const Index exact = (result.residuals.array() < rounding * cloud.diagonal).count();
  return static_cast<double>(exact) / static_cast<double>(cloud.points.size());
}

}  // namespace

std::optional<Skin> Skin::where_filled(const Cloud& cloud, const Method& method,
                                       const ParameterValues& values, const Context& context) {
  if (method.sees_inside || !fills_bodies(cloud, context)) return std::nullopt;
  Skin skin(cloud, values, context);
  if (skin.size() < method.minimum_points) return std::nullopt;
  return skin;
}

Skin::Skin(const Cloud& cloud, const ParameterValues& values, const Context& context)
    : cloud_(cloud), values_(values), context_(context) {
  const PointTree tree(cloud.points, context);
  const std::vector<Index> places = outer_places(cloud, tree, context);
  std::vector<char> is_skin(places.size());
  visit_surroundings(
      cloud.points, tree, around_skin, places, context,
      [&](Index v, const Surroundings& around) { is_skin[v] = around.one_sided() > at_skin; });
  for (std::size_t v = 0; v < places.size(); ++v)
    if (is_skin[v]) points_.push_back(tree.order()[places[v]]);
  std::sort(points_.begin(), points_.end());
}

Points Skin::rows(PointsView all) const { return all.matrix()(points_, Eigen::indexing::all); }

void Skin::hand_on(Result& result) const {
  result.statistics["skin_points"] = size();
  match_again(result, cloud_, values_, context_);
  if (result.mirror) result.score = std::max(result.score, exactly_paired(result, cloud_));
}

}  // namespace symsurf
