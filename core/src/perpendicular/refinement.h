#pragma once

#include <symsurf/free_form.h>

#include <memory>
#include <vector>

#include "growth.h"

namespace symsurf::perpendicular {

/// A sheet fitted to all points that mirror over it.
struct Sheet {
  std::shared_ptr<const FreeForm> mirror;  ///< in the search's frame; null when the sheet dissolved
  std::vector<Carried> carried;            ///< one a point that found a partner
  std::vector<std::int32_t> points, partners;
  double typical_miss = 0;  ///< median distance from an image to its partner, in spacings
  bool exact = false;       ///< the partners are the images themselves
  double explained = 0;     ///< share of the points that are carried onto the cloud
};

/// Mirror, match, refit: starts from the sheet's mirror or, without one, from what it has carried.
/// The sheet has no mirror afterwards when it dissolved.
void refine(const SearchCloud& cloud, int rounds, Sheet& sheet);

/// The share of the points that the sheet carries onto the cloud; points on the sheet itself, which
/// are their own images, do not count.
double explained(const SearchCloud& cloud, const Sheet& sheet);

}  // namespace symsurf::perpendicular
