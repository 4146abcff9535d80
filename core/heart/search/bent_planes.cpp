#include "search/bent_planes.h"

#include <cmath>

#include "pairing/matching.h"

namespace symsurf {

namespace {

constexpr Index sample_size = 700;   // surfels, as many as the searches for these kinds take
constexpr double least_bend = 0.01;  // inverse diagonals: over half a diagonal, .1 % high

}  // namespace

BentPlanes::BentPlanes(const Cloud& cloud, const Context& context)
    : cloud_(cloud),
      surfels_(cloud, sample_size, context.stage(0, 0.2)),
      fine_(cloud, samples_a_patch * sample_size, context.stage(0.2, 0.3)),
      tree_(cloud.points, context.stage(0.3, 0.6)),
      points_(cloud.points, tree_, context),
      refinement_(cloud, points_, surfels_, fine_),
      score_(cloud, points_, context.stage(0.6, 1)) {}

Result BentPlanes::best_of(const Kinds& kinds, const Plane& plane) const {
  const PlaneBend bend = bend_of(plane);
  return std::abs(bend.greater) < least_bend ? Result() : best_of(kinds, bend);
}

Result BentPlanes::best_of(const Kinds& kinds, const PlaneBend& bend) const {
  Result best;
  MirrorFit most{.share = -1};
  for (const MethodImplementation* kind : kinds) {
    const std::shared_ptr<Mirror> mirror = kind->bent_from(bend, refinement_, cloud_.frame);
    const MirrorFit fit = score_.fit(*mirror);
    if (fit.share <= most.share) continue;
    most = fit;
    best.method = kind->name;
    best.mirror = mirror;
  }
  if (best.mirror) score_.fill(*best.mirror, most, best);
  return best;
}

Result BentPlanes::with_pairs(const MethodImplementation& kind, const Plane& plane,
                              const ParameterValues& values, const Context& context) && {
  Result result = best_of({&kind}, bend_of(plane));
  result.parameters = values.all();
  add_pairs(result, cloud_, std::move(tree_), values, context);
  return result;
}

PlaneBend BentPlanes::bend_of(const Plane& plane) const {
  return refinement_.bend_of(in_frame(plane, cloud_.frame));
}

}  // namespace symsurf
