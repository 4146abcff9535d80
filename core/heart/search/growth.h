#pragma once

#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <vector>

#include "search/search_cloud.h"

namespace symsurf::perpendicular {

/// A point carried over the mirror as it was known then, and where it ought to have landed.
struct Carried {
  Vector3 foot;     ///< of the point on the mirror
  Vector3 normal;   ///< of the mirror at the foot
  double distance;  ///< of the point from the foot, signed by the normal
  Vector3 miss;     ///< partner - image
  Vector3 partner_normal;
  double turned = 0;  ///< sine of the angle between the partner's normal and the image's
  double weight = 1;
};

/// How well an image fits its partner, 0 to 1: across the partner's surface, along it (where exact
/// partners differ from mere neighbours), and by the angle between the normals.
double closeness(const Carried& carried, double spacing);

/// How a quadratic patch weighs what it is fitted to.
struct FitWeights {
  double radius;        ///< data farther than this from the centre weigh nothing
  double along = 0.08;  ///< weight of a miss along the partner's surface, against one across it
  double robust_scale;  ///< at the least; a miss above 4.7 of these is an outlier (Tukey 1960)
  int passes = 2;
};

/// The quadratic patch that mends the misses best (Hermite moving least squares: a shift of the
/// mirror by q moves the image by 2 q n + 2 d grad q, so each miss is an equation for height and
/// slope). False where the data do not determine one.
bool fit_patch(const Vector3& centre, const Vector3& normal, const std::vector<Carried>& data,
               const FitWeights& weights, Patch& patch);

/// The foot of x on one patch and the normal there; false where it leaves the patch's reach.
bool patch_foot(const Patch& patch, const Vector3& x, Vector3& foot, Vector3& normal);

/// Two points that may mirror each other, and how well their surroundings do (0 to 1).
struct Seed {
  std::int32_t first, second;
  double support = 0;
};

/// Pairs whose normals mirror each other about the plane that bisects them, best supported first:
/// the neighbours of one end, mirrored over that plane, should land on the cloud.
struct Seeds {
  std::vector<Seed> along;   ///< chords about along the normals: two surfaces face each other
  std::vector<Seed> across;  ///< the others: far more, and most of them by chance
};

Seeds find_seeds(const SearchCloud& cloud, std::uint64_t seed, const Context& context);

/// A coherent surface of oriented midpoints while it grows outwards from one pair.
class Growth {
 public:
  Growth(const SearchCloud& cloud, const Seed& seed);

  /// Rings of points around what is known, until nothing more fits or `most` points do.
  void grow(Index most);

  /// Carries every accepted point over its own patch and fits the patches again.
  void refine();

  /// Points that have found a partner, in the order found.
  const std::vector<std::int32_t>& accepted() const { return accepted_; }
  std::int32_t partner(Index i) const { return partner_[i]; }
  const Patch& patch(Index i) const { return patches_[patch_of_[i]]; }
  const Carried& carried(Index i) const { return carried_[patch_of_[i]]; }

  /// Of the accepted points, in the mean.
  double closeness() const;
  /// Whether the partners are the images themselves, as of the last refine().
  bool exact() const { return exact_; }

 private:
  bool carry(std::int32_t i, const Patch& guide, Carried& carried, std::int32_t& partner) const;
  bool accept(std::int32_t i, const Patch& guide);
  void guide_neighbours(std::int32_t i);
  void refit(std::int32_t i);
  double nearest_squared(std::int32_t i, std::int32_t by) const;

  const SearchCloud* cloud_;
  std::vector<std::int32_t> accepted_, frontier_;
  std::vector<std::int32_t> partner_, guide_, patch_of_;
  std::vector<std::int32_t> slot_of_;  // in the data of the latest patch fitted to them
  std::vector<char> tries_;
  std::vector<Patch> patches_;
  std::vector<Carried> carried_;
  bool exact_ = false;
  double along_ = 0.3;
  std::size_t fresh_ = 0;  // accepted_ from here on have not guided their neighbours yet
};

}  // namespace symsurf::perpendicular
