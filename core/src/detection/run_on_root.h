#pragma once

#include <symsurf/communicator.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>

#include <functional>

namespace symsurf {

/// Runs on the points and normals of all processes, in the order of their ranks, on rank 0, the
/// root. Each process gets the result with the pairs of its own points, or the root's error.
/// Collective.
Result run_on_root(PointsView own, PointsView normals, const Communicator& processes,
                   const std::function<Result(PointsView, PointsView)>& run);

}  // namespace symsurf
