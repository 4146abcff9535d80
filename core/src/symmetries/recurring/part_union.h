#pragma once

#include <vector>

#include "symmetries/recurring/seed_part.h"

namespace symsurf {

/// Joins parts whose instances lie to each other the same way, as a frame and its panes do.
std::vector<RecurringPart> united(std::vector<RecurringPart> parts, const FeatureLines& graph,
                                  double tolerance);

}  // namespace symsurf
