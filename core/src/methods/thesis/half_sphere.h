#pragma once

#include <symsurf/types.h>

#include <vector>

namespace symsurf {

/// The normals of the planes that Algorithms 1 and 2 try: (sin f cos t, sin f sin t, cos f), f and
/// t from 0 below pi in `steps` steps each, f-major; the copies of the pole once. 10 steps: 91.
std::vector<Vector3> half_sphere(Index steps);

}  // namespace symsurf
