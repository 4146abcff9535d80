#pragma once

#include <symsurf/types.h>

namespace symsurf::benchmarks {

/// A closed bumpy surface with one mirror plane, sampled at random, in a pose of its own.
Points bumpy_object(Index count);

}  // namespace symsurf::benchmarks
