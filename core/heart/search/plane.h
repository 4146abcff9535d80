#pragma once

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "fit/candidate.h"
#include "fit/refinement.h"
#include "fit/shapes.h"
#include "score/mirror_score.h"

namespace symsurf {

using PlaneCandidate = Candidate<UnitPlane>;

/// How much a surfel's image beside the cloud counts against a plane: for support_share().
inline constexpr double contradiction = 0.9;

/// Planes between pairs of surfels whose normals mirror each other, the best `count` that
/// differ first.
std::vector<PlaneCandidate> candidate_planes(const Surfels& surfels, const SurfelMap& map,
                                             Index count);

/// The same, refined on the surfels alone; at least one.
std::vector<PlaneCandidate> promising_planes(const Surfels& surfels, const SurfelMap& map,
                                             const Context& context);

inline constexpr Index refined_at_most = 4;
inline constexpr double alike_planes = 0.05;  // planes closer than this are one

/// Drops planes that mirror the cloud nearly as a better one does; best first.
template <typename Shape>
void suppress_non_maxima(std::vector<Candidate<Shape>>& candidates, double distance, Index count) {
  // The corners of a tetrahedron as wide as the cloud.
  static const std::vector<Vector3> probes{Vector3(0.2, 0.2, 0.2), Vector3(0.2, -0.2, -0.2),
                                           Vector3(-0.2, 0.2, -0.2), Vector3(-0.2, -0.2, 0.2)};
  suppress_non_maxima(probes, candidates, distance, count);
}

/// Drops what is below the best by more than a share of it.
template <typename Shape>
void drop_far_below_best(std::vector<Candidate<Shape>>& candidates, double share) {
  constexpr double least_best = 0.3;  // a best that explains less has the margins of one like this
  const double best = candidates.front().support;
  const double least = best - share * std::max(best, least_best);
  std::erase_if(candidates, [&](const auto& c) { return c.support < least; });
}

/// Each by itself.
template <typename Shape, typename Step>
void improve(std::vector<Candidate<Shape>>& candidates, const Context& context, const Step& step) {
  parallel_for(context, static_cast<Index>(candidates.size()), 1,
               [&](Index i, Index) { candidates[i] = step(candidates[i]); });
}

/// Fitted to the full cloud, and ranked by the share of it that they map. `first`: the fit of all
/// of them.
template <typename Shape>
void fit_to_all(std::vector<Candidate<Shape>>& candidates, const Refinement& refinement,
                const MirrorScore& score, const PrincipalFrame& frame, const Fit& first,
                const Context& context) {
  constexpr Index finalists = 6;  // are fitted carefully
  struct Look {
    Fit fit;
    Index stride;      // of the score's samples
    double far_below;  // the best by this share of it: not worth another look
  };
  double done = 0;
  for (const Look& look : {Look{first, 9, 0.5}, {careful, 3, 0.2}}) {
    improve(candidates, context.stage(done, done + 0.5), [&](const Candidate<Shape>& c) {
      const Shape shape = refinement.fitted(c.shape, look.fit);
      return Candidate<Shape>{shape, score.fit(in_input_units(shape, frame), look.stride).share};
    });
    suppress_non_maxima(candidates, alike_planes, finalists);
    drop_far_below_best(candidates, look.far_below);
    done += 0.5;
  }
}

}  // namespace symsurf
