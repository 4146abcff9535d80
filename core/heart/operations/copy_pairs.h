#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

namespace symsurf {

/// Chooses among copies of points, which soups, flat shading and seams of textures have, so that
/// partners pair one to one wherever there are as many copies on both sides: those that mirrored
/// faces have at the same corner, the others by their order. `partners`: of each point one at the
/// position of its mirror point, or -1.
void pair_copies(PointsView points, TrianglesView faces, std::vector<Index>& partners,
                 const Context& context);

}  // namespace symsurf
