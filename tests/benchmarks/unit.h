#pragma once

#include <symsurf/points.h>

namespace symsurf::benchmarks {

/// Seconds of processor time for one nanoflann KD-tree and one nearest-neighbour query a point:
/// what the cost of a method is measured in. The queries are the points moved by a hundredth of
/// their extent, in their own order.
double unit_seconds(PointsView points);

}  // namespace symsurf::benchmarks
