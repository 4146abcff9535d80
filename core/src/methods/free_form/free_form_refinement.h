#pragma once

#include <symsurf/free_form.h>

#include <functional>
#include <memory>
#include <vector>

#include "methods/free_form/growth.h"

namespace symsurf::perpendicular {

/// A sheet fitted to all points that mirror over it.
struct Sheet {
  std::shared_ptr<const FreeForm> mirror;  ///< in the search's frame; null when the sheet dissolved
  std::vector<Carried> carried;            ///< one a point that found a partner
  std::vector<std::int32_t> points, partners;
  double typical_miss = 0;  ///< median distance from an image to its partner, in spacings
  bool exact = false;       ///< the partners are the images themselves
  bool bent = false;        ///< smoother than patches that are fitted each to what is near it
  double explained = 0;     ///< share of the points that are carried onto the cloud
};

/// Mirror, match, refit: starts from the sheet's mirror or, without one, from what it has carried.
/// The sheet has no mirror afterwards when it dissolved.
void refine(const SearchCloud& cloud, int rounds, Sheet& sheet);

/// Carries all points over a mirror: gives its foot for x and its normal there, or false.
using FootOf = std::function<bool(const Vector3& x, Vector3& foot, Vector3& normal)>;
/// Fills what the sheet has carried with the points whose images fall within its reach of a partner
/// whose normal fits.
void match(const SearchCloud& cloud, const FootOf& foot_of, Sheet& sheet);
/// The same over the sheet's own mirror, feet to a precision relative to its patches.
void match(const SearchCloud& cloud, double precision, Sheet& sheet);

/// How far from its image a partner may be, in spacings.
double reach(const Sheet& sheet);

/// How nearly parallel its normals are: the greatest mean square of their products with a
/// direction.
double flatness(const Sheet& sheet);

/// Whether it is nearly a plane, for which there is a method of its own.
bool is_flat(const Sheet& sheet);

/// The share of the points that the sheet carries onto the cloud; points on the sheet itself, which
/// are their own images, do not count.
double explained(const SearchCloud& cloud, const Sheet& sheet);

}  // namespace symsurf::perpendicular
