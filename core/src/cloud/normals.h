#pragma once

#include <symsurf/points.h>

#include "spatial/point_tree.h"

namespace symsurf {

/// estimate_normals() of points whose tree is there already.
Points estimate_normals(PointsView points, const PointTree& tree, Index neighbours,
                        std::string_view method, const Context& context);

}  // namespace symsurf
