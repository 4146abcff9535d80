#pragma once

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <functional>
#include <memory>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/surface_points.h"

namespace symsurf::perpendicular {

/// The points a search works on: actual points of the cloud, evenly thinned when there are many, in
/// the principal frame, rounded to 1e-9 of it and in the order of their coordinates there. So the
/// same bits come of a cloud in any order, pose and unit, and what is drawn or grown from them.
struct SearchCloud : SurfacePoints {
  SearchCloud(const Cloud& cloud, Index most_points, const Context& context);

  Context context;  ///< checked in long loops
  // In input units.
  Vector3 centroid;
  Matrix3 axes;  ///< columns; right-handed
  double diagonal = 0;

  /// Whether the points scatter about their surface by enough to hide it.
  bool noisy() const;
  /// Draws every point to the surface it scatters about. The noise stays that of before.
  void smooth(const Context& progress);

 private:
  bool given_normals_;
};

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

/// Gives neighbours normals of one side, from the most alike on (Hoppe et al. 1992).
void orient(SearchCloud& cloud);

/// The surface on which the points themselves lie, which orient() has seen; null where no patches
/// could be fitted. Each is fitted to so many points.
std::shared_ptr<FreeForm> surface_through(const SearchCloud& cloud);
Index points_a_patch(const SearchCloud& cloud);

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

/// Adds the planes that map the whole cloud onto itself, of which a thinned cloud does not have the
/// partners. False: there are none.
bool lay_exact_planes(const Cloud& cloud, const SearchCloud& search,
                      std::vector<GrownSurface>& surfaces, const Context& context);

/// Adds the surfaces that the best mirror planes and the principal planes of the cloud become when
/// they are bent until they mirror it. Unlike surfaces that grow they need no partners that stand
/// close to the images, and take hold of what both sides have in common by and by; but they have to
/// be within reach of a plane.
void bend_planes(const Cloud& cloud, const SearchCloud& search, std::vector<GrownSurface>& surfaces,
                 const Context& context);

/// The surfaces over which a cloud is mirrored perpendicularly, best first, and the points that
/// were searched.
struct Search {
  SearchCloud cloud;
  std::vector<GrownSurface> surfaces;
};

Search search(const Cloud& cloud, Index sample_size, const Context& context);

/// Whether points have exact partners. Those inside a volumetric cloud then have as many as those
/// of its boundary.
bool has_exact_partners(const Cloud& cloud, const ParameterValues& values, const Context& context);

/// Of methods that search in this way.
constexpr Index least_points = 12;

/// A mirror in input units, and the surface it comes from.
struct Found {
  std::shared_ptr<Mirror> mirror;
  GrownSurface surface;
};

/// A mirror of the search's frame in input units.
std::shared_ptr<Mirror> in_input_units(const Mirror& mirror, const SearchCloud& searched);

/// Ranks the first of the mirrors, as many as "max_candidates" allows, and pairs the points over
/// the best; without mirrors the result stays as it is. Partners are no farther from the images
/// than the surface's own, never the point itself and, where partners are exact, only those that
/// agree. Where they are not, the surface points are the midpoints' feet on the mirror.
void fill(Result& result, const Cloud& cloud, const SearchCloud& searched,
          const std::vector<Found>& found, const ParameterValues& values, const Context& context);

/// The parameters of the methods that search in this way.
std::vector<Parameter> search_parameters();

}  // namespace symsurf::perpendicular
