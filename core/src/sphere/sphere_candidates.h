#pragma once

#include <vector>

#include "../parametric/candidate.h"
#include "unit_sphere.h"

namespace symsurf {

using SphereCandidate = Candidate<UnitSphere>;

/// Spheres closer than this are one, by Action::difference.
constexpr double alike_spheres = 0.04;

/// The best `count` spheres that differ, on the thinned cloud alone: from pairs of surfels, of any
/// radius, settled on the surfels; the first of them at a maximum of Hruda's measure.
std::vector<SphereCandidate> promising_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context);

/// Drops spheres so large that a plane explains as much; where there is nothing else, they stay.
void drop_planes(const Surfels& surfels, const SurfelMap& map,
                 std::vector<SphereCandidate>& candidates);

}  // namespace symsurf
