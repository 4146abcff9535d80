#pragma once

#include <vector>

#include "methods/parametric/refinement.h"
#include "methods/sphere/sphere_candidates.h"

namespace symsurf {

/// Spheres around one, over the plane of its two loosest changes (ParametricRefinement::loosest):
/// from one to the next, images move by half the spacing of the points.
std::vector<UnitSphere> spheres_around(const UnitSphere& sphere,
                                       const Eigen::Matrix<double, 4, 2>& loosest, double spacing);

/// Where noise hides which points are partners, surfaces alone tell spheres apart that slide along
/// them, and a fit creeps: slides the sphere over the plane of its loosest changes, for as long as
/// another position explains clearly more.
SphereCandidate slid_along_surfaces(SphereCandidate candidate,
                                    const ParametricRefinement& refinement);

/// Fits a quadratic to what positions over the same plane explain, near the sphere, and goes where
/// it is highest: many positions together tell more than each, which noise moves up and down. The
/// candidate as it was where it explains no more there.
SphereCandidate settled_on_surfaces(const SphereCandidate& candidate,
                                    const ParametricRefinement& refinement);

}  // namespace symsurf
