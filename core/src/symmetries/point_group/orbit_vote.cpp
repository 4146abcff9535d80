#include "symmetries/point_group/orbit_vote.h"

#include <algorithm>

namespace symsurf {

OrbitVote orbit_vote(const MirrorScore& score, const GroupPose& pose,
                     const std::vector<Matrix3>& elements, std::size_t most_images) {
  constexpr std::size_t points = 500;  // that the score is measured at
  constexpr double confirmed = 0.58;   // of the orbit: more than half, less than two of three
  constexpr double on_surface = 0.3;   // support from which on an image lies on the surface
  constexpr double rims = 4;           // what lies at the rim of a hole is judged less by this
  const std::size_t stride = std::max<std::size_t>(1, elements.size() * points / most_images);
  struct Orbit {
    double moved = 0, rim = 0, size = 0;  // weights
    double confirming = 0, missing = 0, images = 0;
  };
  std::vector<Orbit> orbits;
  double images = 0, confirming = 0, supports = 0, missing = 0;
  for (const Matrix3& element : elements) {
    if (element.isIdentity()) continue;
    for (const PointFit& fit : score.point_fits(pose.placed(element), stride)) {
      if (fit.point >= orbits.size()) orbits.resize(fit.point + 1);
      Orbit& orbit = orbits[fit.point];
      const double weight = fit.weight - fit.rim;
      const double there = weight - fit.missing;
      const double yes = fit.support > on_surface * there ? there : 0;
      orbit.moved += fit.weight;
      orbit.rim += fit.rim;
      ++orbit.size;
      orbit.images += weight;
      orbit.confirming += yes;
      images += weight;
      confirming += yes;
      supports += fit.support;
      missing += fit.missing;
    }
  }
  if (!(images > 0)) return {};
  const double there = std::max(images - missing, 1e-9);
  OrbitVote vote{confirming / there, supports / there, missing / images};
  double all = 0, outliers = 0;
  for (const Orbit& orbit : orbits) {
    if (!(orbit.moved > 0)) continue;
    const double weight =
        orbit.moved / orbit.size * std::clamp(1 - rims * orbit.rim / orbit.moved, 0.0, 1.0);
    const double own = orbit.images / orbit.size;
    all += weight;
    if (own + orbit.confirming < confirmed * (own + orbit.images)) outliers += weight;
  }
  if (all > 0) vote.outliers = outliers / all;
  return vote;
}

}  // namespace symsurf
