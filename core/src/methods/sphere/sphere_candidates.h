#pragma once

#include <vector>

#include "methods/parametric/candidate.h"
#include "methods/parametric/unit_sphere.h"

namespace symsurf {

using SphereCandidate = Candidate<UnitSphere>;

/// Spheres closer than this are one, for suppress_non_maxima.
constexpr double alike_spheres = 0.04;

/// The best `count` spheres that differ, on the thinned cloud alone: from pairs of surfels, of any
/// radius, refined on the surfels. Behind them
/// the best of those that fit the surfels no better than a plane.
std::vector<SphereCandidate> promising_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context);

}  // namespace symsurf
