#pragma once

#include <symsurf/mirrors.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "cloud/cloud.h"
#include "fit/candidate.h"
#include "fit/refinement.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/methods.h"

namespace symsurf {

/// Candidates closer to each other are one, for suppress_non_maxima.
inline constexpr double alike_shapes = 0.04;

template <typename Shape>
std::shared_ptr<Mirror> mirror_of(const Shape& shape, const PrincipalFrame& frame) {
  return std::make_shared<decltype(in_input_units(shape, frame))>(in_input_units(shape, frame));
}

/// Mirrors of few numbers that pairs of patches ask for, refined on the patches and fitted to the
/// full cloud, the best first. `Kind` has
/// - name, widest, radius(shape): of the method; the greatest radius, diagonals;
/// - through: of hypotheses_of_pairs;
/// - taken_planes(...): takes out what is rather a plane, and returns the best of it;
/// - fitted(candidate), closely(candidate): fitted to the full cloud, and to more of it;
/// - rest(candidate): the points that it does not pair, where these may have a mirror of their own;
/// - drop_planes(score, all): drops what scores no better than a plane.
template <typename Kind>
class ParametricSearch {
 public:
  using Shape = typename Kind::Shape;
  using Candidates = std::vector<Candidate<Shape>>;

  ParametricSearch(const Cloud& cloud, Index sample_size, const Context& context)
      : surfels_(cloud.patches(sample_size, context.stage(0, 0.1))),
        points_(cloud, context.stage(0.1, 0.2)),
        refinement_(cloud, points_, surfels_,
                    cloud.patches(samples_a_patch * sample_size, context.stage(0.2, 0.3))),
        kind_(cloud, points_, refinement_, context) {}

  const Kind& kind() const { return kind_; }

  Candidates candidates(std::uint64_t seed, const Context& context) const {
    constexpr Index pairs_tried = 40000, pairs_kept = 4000, started = 48;
    const SurfelMap map(surfels_);
    Candidates found = best_of_each_size(
        hypotheses_of_pairs<Shape>(surfels_, seed, pairs_tried, pairs_kept, Kind::through, context),
        Kind::radius, surfels_, map, started, context);
    const auto replace = [&](const auto& step) {
      silent_parallel_for(context, static_cast<Index>(found.size()), 1,
                          [&](Index i, Index) { found[i] = step(found[i]); });
    };
    const auto refine = [&](double widest, double narrowest, Index stride) {
      replace([&](const Candidate<Shape>& candidate) {
        return refined_on_surfels(surfels_, map, candidate, widest, narrowest, 4, stride);
      });
    };
    refine(0.04, 0.02, 3);
    const Candidates planes = Kind::taken_planes(surfels_, map, found);
    suppress_non_maxima(surfels_, found, alike_shapes, started);
    refine(0.02, 0.012, 1);
    suppress_non_maxima(surfels_, found, alike_shapes, 2 * fitted_to_all);
    replace([&](const Candidate<Shape>& candidate) { return kind_.fitted(candidate); });
    for (const Candidate<Shape>& plane : planes)
      if (const auto fitted = kind_.fitted(plane); fitted.partnered > 0 || found.empty())
        found.push_back(fitted);
    sort_best_first(found);
    return found;
  }

  // The best of them fitted closely, as many as asked for.
  void finish(Candidates& found, Index count) const {
    constexpr std::size_t closely_fitted = 3;
    constexpr double chance_explains = 0.35;  // what mirrors explain of random solids before that
    constexpr double least_support = 0.6;  // of the best: without it 6 of 10 dented balls are lost
    suppress_non_maxima(surfels_, found, alike_shapes, fitted_to_all);
    for (std::size_t i = 0; i < std::min(closely_fitted, found.size()); ++i)
      if (i == 0 || found[i].merit() > chance_explains) found[i] = kind_.closely(found[i]);
    suppress_non_maxima(surfels_, found, alike_shapes, count);
    std::erase_if(found, [](const auto& c) { return !(Kind::radius(c.shape) < Kind::widest); });
    if (found.empty()) return;
    const double least = least_support * found.front().merit();
    std::erase_if(found, [&](const auto& c) { return c.merit() < least; });
  }

 private:
  static constexpr Index fitted_to_all = 8;

  const Surfels& surfels_;
  NearestPoints points_;
  Refinement refinement_;
  Kind kind_;
};

template <typename Kind>
Result searched(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  Result best;
  best.method = Kind::name;
  const Index sample_size = values.integer("sample_size");
  const ParametricSearch<Kind> search(cloud, sample_size, context.stage(0, 0.3));
  auto found = search.candidates(cloud.seed, context.stage(0.3, 0.6));
  if (found.empty()) return best;
  if (const std::optional<Points> rest = search.kind().rest(found.front())) {
    Cloud others = cloud;
    others.set_points(*rest, {});
    const ParametricSearch<Kind> again(others, sample_size, context.stage(0.6, 0.6));
    for (const auto& candidate : again.candidates(cloud.seed, context.stage(0.6, 0.7)))
      if (candidate.partnered > 0) found.push_back(search.kind().fitted(candidate));
  }
  search.finish(found, 1 + values.integer("max_candidates"));
  const MirrorScore score(cloud, context.stage(0.7, 0.75));
  search.kind().drop_planes(score, found);
  if (found.empty()) return best;
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const auto& candidate : found) mirrors.push_back(mirror_of(candidate.shape, cloud.frame));
  best = score.ranked(Kind::name, mirrors);
  add_pairs(best, cloud, values, context.stage(0.75, 1));
  return best;
}

}  // namespace symsurf
