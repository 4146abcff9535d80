#pragma once

#include <vector>

#include "methods/free_form/free_form_refinement.h"
#include "methods/free_form/growth.h"
#include "methods/free_form/seeds.h"

namespace symsurf::perpendicular {

/// The first steps of at most so many growths from the best seeds, the most promising first.
std::vector<Growth> trials(const SearchCloud& cloud, const std::vector<Seed>& seeds,
                           std::size_t most);

/// Adds the surfaces grown from trials, each from one that no surface before explains, and refines
/// those that may come near the best support so far. In the order found.
void explore(const SearchCloud& cloud, const std::vector<Seed>& seeds,
             std::vector<GrownSurface>& surfaces, const Context& context);

}  // namespace symsurf::perpendicular
