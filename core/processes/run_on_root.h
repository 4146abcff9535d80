#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/points.h>

#include <functional>
#include <span>

namespace symsurf {

/// A result but for its pairs and all that belongs to them, as bytes for other processes.
Communicator::Bytes serialize(const Result& result);

/// The result that serialize() was given: the same numbers, to the bit.
Result deserialize(std::span<const std::byte> bytes);

/// Runs on the points and normals of all processes, in the order of their ranks, on rank 0, the
/// root. Each process gets the result with the pairs of its own points, or the root's error.
/// Collective.
Result run_on_root(PointsView own, PointsView normals, const Communicator& processes,
                   const std::function<Result(PointsView, PointsView)>& run);

}  // namespace symsurf
