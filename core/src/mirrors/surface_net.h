#pragma once

#include <symsurf/mirror.h>

#include <functional>

namespace symsurf {

/// Triangulates the zero set of `value` around the given points on it: surface nets (Gibson 1998)
/// on a grid along the points' principal axes, `resolution` cells along the longest, in cells that
/// hold a point or touch one that does, and from there on as far as the points stand from each
/// other. `value` is NaN where the function is not defined. Vertices are moved to their feet, where
/// they have one near by. Throws InvalidInput for points that extend over more than 1e50, where
/// squared distances no longer bound the net.
Mesh surface_net(const Points& on_surface, int resolution,
                 const std::function<double(const Vector3& x)>& value,
                 const std::function<Vector3(const Vector3& x)>& foot, const Context& context);

}  // namespace symsurf
