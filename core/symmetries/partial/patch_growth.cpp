#include "partial/patch_growth.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace symsurf {

PatchGrowth::PatchGrowth(const SurfaceFit& fit)
    : fit_(fit), tolerance_(fit.surface().tolerance()), ceilings_(fit.surface().size()) {
  const SurfacePoints& all = fit.surface().points();
  for (Index i = 0; i < all.size(); ++i) {
    const Index other = all.neighbours(i, 0);
    const double off = (all.point(i) - all.point(other)).dot(all.normal(other));
    ceilings_[i] = biweight(std::abs(off) / tolerance_);
  }
}

// The points reached from the seeds over neighbours on which the map holds.
std::vector<Index> PatchGrowth::agreeing(const Eigen::Affine3d& map,
                                         const std::vector<Index>& seeds) const {
  const SurfacePoints& all = fit_.surface().points();
  std::vector<char> seen(all.size(), 0);
  std::vector<Index> reached;
  const auto visit = [&](Index i) {
    if (seen[i]) return;
    seen[i] = 1;
    if (fit_.landing(map, i, tolerance_).agrees) reached.push_back(i);
  };
  for (const Index i : seeds) visit(i);
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (int n = 0; n < SurfacePoints::ring; ++n) visit(all.neighbours(reached[k], n));
  std::sort(reached.begin(), reached.end());
  return reached;
}

std::optional<PatchPair> PatchGrowth::grown(const Eigen::Affine3d& map,
                                            const std::vector<Index>& seeds, Index least,
                                            const Context& context) const {
  constexpr double wide = 4, most_of_seeds = 0.5;
  PatchPair pair;
  pair.map = map;
  for (const double width : {wide, 2.0, 1.5})
    pair.map = fit_.fitted(pair.map, seeds, width * tolerance_, 2).map;
  if (fit_.share(pair.map, seeds, tolerance_) < most_of_seeds) return {};
  constexpr int rounds = 8, last_steps = 4, slides = 2;
  for (int round = 0; round < rounds; ++round) {
    context.check();
    const std::size_t before = pair.from.size();
    pair.from = agreeing(pair.map, round == 0 ? seeds : pair.from);
    if (pair.from.empty()) return {};
    pair.map = fit_.fitted(pair.map, pair.from, tolerance_, 2).map;
    constexpr double grows = 1.02;
    if (static_cast<double>(pair.from.size()) < grows * static_cast<double>(before)) break;
  }
  if (static_cast<Index>(pair.from.size()) < least) return {};
  const SurfaceFit::Fit last = fit_.fitted(pair.map, pair.from, tolerance_, last_steps);
  pair.hold = fit_.hold(last, pair.from, tolerance_, slides);
  pair.map = fit_.simplest(last.map, pair.from, tolerance_);
  score(pair);
  return pair;
}

// What the images come to the surface, of what the surface comes to itself (MirrorScore).
void PatchGrowth::score(PatchPair& pair) const {
  double ceiling = 0;
  for (const Index i : pair.from) {
    const SurfaceFit::Landing landing = fit_.landing(pair.map, i, tolerance_);
    if (landing.partner >= 0) pair.onto.push_back(landing.partner);
    if (landing.agrees) pair.score += biweight(std::abs(landing.off) / tolerance_);
    ceiling += ceilings_[i];
  }
  pair.score = ceiling > 0 ? std::min(1.0, pair.score / ceiling) : 0;
  std::sort(pair.onto.begin(), pair.onto.end());
  pair.onto.erase(std::unique(pair.onto.begin(), pair.onto.end()), pair.onto.end());
}

}  // namespace symsurf
