#pragma once

#include <vector>

#include "symmetries/recurring/seed_part.h"

namespace symsurf {

/// The recurring parts of a graph of feature lines (Bokeloh et al. 2009), those that save most
/// first, at most `count`. No line is in two instances.
std::vector<RecurringPart> part_search(const FeatureLines& graph, double tolerance, Index count,
                                       const Context& context);

}  // namespace symsurf
