#pragma once

#include <symsurf/surface.h>

namespace symsurf {

/// The point of the graph z = f(x, y) closest to p.
Vector3 closest_point(const Surface& surface, const Vector3& p);

}  // namespace symsurf
