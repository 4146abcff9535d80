#pragma once

#include <symsurf/mirrors.h>

#include <functional>
#include <memory>
#include <vector>

#include "search/growth.h"

namespace symsurf::perpendicular {

/// A surface fitted to all points that mirror over it.
struct GrownSurface {
  std::shared_ptr<const FreeForm>
      mirror;                    ///< in the search's frame; null where no patches could be fitted
  std::vector<Carried> carried;  ///< one a point that found a partner
  std::vector<std::int32_t> points, partners;
  double typical_miss = 0;  ///< median distance from an image to its partner, in spacings
  bool exact = false;       ///< the partners are the images themselves
  bool bent = false;        ///< smoother than patches that are fitted each to what is near it
  double support = 0;       ///< share of the points that are carried onto the cloud
};

/// Mirror, match, refit: starts from the surface's mirror or, without one, from what it has
/// carried. The surface has no mirror afterwards where too few points match.
void refine(const SearchCloud& cloud, int rounds, GrownSurface& surface);

/// Carries all points over a mirror: gives its foot for x and its normal there, or false.
using FootOf = std::function<bool(const Vector3& x, Vector3& foot, Vector3& normal)>;
/// Fills what the surface has carried with the points whose images fall within its reach of a
/// partner whose normal fits.
void match(const SearchCloud& cloud, const FootOf& foot_of, GrownSurface& surface);
/// The same over the surface's own mirror, feet to a precision relative to its patches.
void match(const SearchCloud& cloud, double precision, GrownSurface& surface);

/// How far from its image a partner may be, in spacings.
double reach(const GrownSurface& surface);

/// How nearly parallel its normals are: the greatest mean square of their products with a
/// direction.
double flatness(const GrownSurface& surface);

/// Whether it is nearly a plane, for which there is a method of its own.
bool is_flat(const GrownSurface& surface);

/// The share of the points that the surface carries onto the cloud; points on the surface itself,
/// which are their own images, do not count.
double support(const SearchCloud& cloud, const GrownSurface& surface);

}  // namespace symsurf::perpendicular
