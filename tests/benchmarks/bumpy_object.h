#pragma once

#include <symsurf/points.h>

namespace symsurf::benchmarks {

/// A closed bumpy surface with one mirror plane, sampled at random, in a pose of its own. Rows 2i
/// and 2i + 1 are mirror images; the plane passes through the origin.
Points bumpy_object(Index count, unsigned seed = 1);

}  // namespace symsurf::benchmarks
