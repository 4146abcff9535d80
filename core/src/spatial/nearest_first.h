#pragma once

#include <vector>

#include "spatial/point_tree.h"

namespace symsurf {

/// Leaves of the first `count` found, at least k, the k nearest, nearest first.
void keep_nearest(std::vector<Neighbour>& found, std::size_t count, std::size_t k);

}  // namespace symsurf
