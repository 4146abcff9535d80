#pragma once

#include <vector>

#include "refinement.h"

namespace symsurf::perpendicular {

/// The sheets over which a cloud is mirrored perpendicularly, best first, and the points that were
/// searched.
struct Search {
  SearchCloud cloud;
  std::vector<Sheet> sheets;
};

Search search(const Cloud& cloud, Index sample_size, const Context& context);

}  // namespace symsurf::perpendicular
