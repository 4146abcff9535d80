#pragma once

#include <vector>

#include "symmetries/recurring/seed_part.h"

namespace symsurf {

/// Parts of closed lines without corners, as the rims of holes are: circles of one size, and other
/// curves by their principal axes.
std::vector<RecurringPart> closed_line_parts(const FeatureLines& graph, double tolerance,
                                             const Context& context);

}  // namespace symsurf
