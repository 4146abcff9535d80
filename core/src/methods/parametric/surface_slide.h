#pragma once

#include <vector>

#include "methods/parametric/refinement.h"

namespace symsurf {

/// Mirrors around one, over the plane of its two loosest changes (ParametricRefinement::loosest):
/// from one to the next, images move by half the spacing of the points.
template <typename Shape>
std::vector<Shape> shapes_around(const Shape& shape,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 2>& loosest,
                                 double spacing);

/// Where noise or a dent hides which points are partners, surfaces alone distinguish mirrors that
/// slide along them, and a fit creeps: slides the mirror over the plane of its loosest changes, for
/// as long as another position explains clearly more.
template <typename Shape>
Candidate<Shape> slid_along_surfaces(Candidate<Shape> candidate,
                                     const ParametricRefinement& refinement);

}  // namespace symsurf
