#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/points.h>

#include <functional>

namespace symsurf {

/// Runs on the points and normals of all processes, in the order of their ranks, on rank 0, the
/// root. Each process gets the result with the pairs of its own points, or the root's error.
/// Collective.
Result run_on_root(PointsView own, PointsView normals, const Communicator& processes,
                   const std::function<Result(PointsView, PointsView)>& run);

}  // namespace symsurf
