#pragma once

#include <symsurf/mirror.h>

#include <memory>

namespace symsurf {

/// The plane, or else the sphere, that all the points lie on: how a mirror comes back from its
/// triangles alone. `tolerance`: how far off a point may be, as a fraction of the points' own
/// diagonal. Null where they lie on neither, and where they all lie on one line.
/// Throws InvalidInput for non-finite points.
std::shared_ptr<Mirror> mirror_through(PointsView points, double tolerance = 1e-5);

}  // namespace symsurf
