#pragma once

#include <symsurf/method.h>

namespace symsurf {

/// checked_cloud() of a cloud of which each process has a part, maybe an empty one. Collective; the
/// errors are the same on all.
Cloud checked_shared_cloud(PointsView own, Index minimum_points, const Context& context);

}  // namespace symsurf
