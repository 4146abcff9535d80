#include "symmetries/orbit_vote.h"

#include <algorithm>

namespace symsurf {

OrbitVote orbit_vote(const MirrorScore& score, const GroupPose& pose,
                     const std::vector<Matrix3>& elements) {
  constexpr std::size_t images = 12'000, points = 500;
  constexpr double confirmed = 0.6;  // of the orbit
  const std::size_t stride = std::max<std::size_t>(1, elements.size() * points / images);
  struct Orbit {
    double weight = 0, support = 0, missing = 0, size = 0;
  };
  std::vector<Orbit> orbits;
  for (const Matrix3& element : elements) {
    if (element.isIdentity()) continue;
    for (const PointFit& fit : score.point_fits(pose.placed(element), stride)) {
      if (fit.point >= orbits.size()) orbits.resize(fit.point + 1);
      Orbit& orbit = orbits[fit.point];
      orbit.weight += fit.weight;
      orbit.support += fit.support;
      orbit.missing += fit.missing;
      ++orbit.size;
    }
  }
  double weights = 0, support = 0, missing = 0, all = 0, outliers = 0;
  for (const Orbit& orbit : orbits) {
    if (!(orbit.weight > 0)) continue;
    weights += orbit.weight;
    support += orbit.support;
    missing += orbit.missing;
    const double own = orbit.weight / orbit.size;
    all += own;
    if (own + orbit.support < confirmed * (own + orbit.weight)) outliers += own;
  }
  if (!(weights > 0)) return {};
  return {support / std::max(weights - missing, 1e-9), missing / weights, outliers / all};
}

}  // namespace symsurf
