#pragma once

#include <vector>

#include "growth.h"
#include "refinement.h"
#include "seeds.h"

namespace symsurf::perpendicular {

/// The first steps of growths from the best seeds, the most promising first.
std::vector<Growth> trials(const SearchCloud& cloud, const std::vector<Seed>& seeds);

/// Grows sheets from the trials, each from one that no sheet before explains, and refines those
/// that may come near the best share explained so far. In the order found.
std::vector<Sheet> explore(const SearchCloud& cloud, std::vector<Growth> trials, double best,
                           const Context& context);

}  // namespace symsurf::perpendicular
