#pragma once

// Shapes made to have a known mirror, damage to them, and how far a result is from the truth.

#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// Points made to have a known mirror (thesis 5.1): P, then their images P'.
struct Sample {
  Points points;
  std::shared_ptr<const Mirror> truth;
  Pairs pairs;        ///< (row of p, row of its image)
  Index skipped = 0;  ///< points left out: f undefined there, or outside the sphere
};

/// Positions of a grid along x, and along y: their square is some gigabytes of samples.
inline constexpr Index finest_grid = 4096;

/// Points (x, y, f(x, y)) on a grid of resolution x resolution positions, x and y from -extent to
/// extent; those where f is undefined are left out. Throws InvalidParameter for an extent that is
/// not finite and above 0 or a resolution out of 2 to finest_grid, InvalidInput where no point is
/// left.
Points sampled_surface(const Surface& surface, double extent, Index resolution);

/// 5.1.1: P moved by `shift` along the direction, and its images along it over the graph of the
/// surface, whose z axis is turned to the direction. Throws InvalidInput for no or non-finite
/// points or where f is undefined at all of them, InvalidParameter for a zero or non-finite
/// direction or a non-finite shift.
Sample mirror_fixed(PointsView points, const Surface& surface, double shift = 0,
                    const Vector3& direction = Vector3::UnitZ());

/// 5.1.2: the surface sampled as by sampled_surface, and each of its points moved by d along the
/// normal to either side. d runs from min_distance to max_distance and back in `waves` legs along
/// x, linearly; without waves it is min_distance. Throws InvalidParameter for distances that are
/// not finite and at least 0, waves below 0, max_distance missing (NaN) where there are waves.
Sample mirror_perpendicular(const Surface& surface, double extent, Index resolution,
                            double min_distance, double max_distance, Index waves = 0);

/// 5.1.3: the points inside the sphere and their images. Throws InvalidInput where there are none.
Sample mirror_spherical(PointsView points, const Sphere& sphere);

/// The sphere of that radius through the midpoint of two points, its centre on their line on the
/// first one's side. Throws InvalidInput for equal points.
Sphere sphere_between(const Vector3& first, const Vector3& second, double radius);

/// The one description of a generator, as Method is of a method.
struct Generator {
  std::string name;
  std::string title;    ///< for menus
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  bool mirrors_points = false;  ///< mirrors given points; where none are given, a sampled surface
  Sample (*run)(PointsView points, const ParameterValues& values) = nullptr;
};

/// "fixed", "perpendicular", "spherical".
const std::vector<Generator>& generators();

/// Runs a generator; parameters not given keep their defaults. Throws InvalidParameter for an
/// unknown name or a value out of range, and what the generator throws.
Sample generate(std::string_view name, const Values& parameters = {}, PointsView points = {});

/// An axis-aligned box, bounds included; without bounds it holds everything.
struct Box {
  Vector3 low = Vector3::Constant(-std::numeric_limits<double>::infinity());
  Vector3 high = Vector3::Constant(std::numeric_limits<double>::infinity());

  bool holds(const Vector3& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
};

/// Points after damage, and which of the input's rows they are.
struct Damaged {
  Points points;
  std::vector<Index> kept;
};

// The thesis's damage (5.3). The same seed gives the same numbers on every machine. All throw
// InvalidInput for no or non-finite points, InvalidParameter for a box with low above high or NaN
// and for values out of the ranges named.

/// Moves the points in the box in a random direction by a distance uniform in [low, high], input
/// units, 0 <= low <= high.
Points add_noise(PointsView points, double low, double high, const Box& box = {},
                 std::uint64_t seed = 0);

/// Removes each point in the box with a probability in [0, 1].
Damaged remove_points(PointsView points, double probability, const Box& box = {},
                      std::uint64_t seed = 0);

/// Turns about the origin by angles in degrees, about x, then y, then z.
Points rotate(PointsView points, double roll, double pitch, double yaw);
/// The rotation it applies.
Matrix3 rotation_matrix(double roll, double pitch, double yaw);

/// Uneven density: of the points beyond the middle of their bounding box along the direction,
/// keeps one in `ratio`, at random; ratio at least 1, direction not zero.
Damaged thin(PointsView points, double ratio, const Vector3& direction = Vector3::UnitX(),
             std::uint64_t seed = 0);

/// The one description of a kind of damage, as Method is of a method.
struct Damage {
  std::string name;
  std::string title;    ///< for menus
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  Damaged (*run)(PointsView points, const ParameterValues& values, std::uint64_t seed) = nullptr;
};

/// "noise", "removal", "rotation", "thinning".
const std::vector<Damage>& damages();

/// Runs one; parameters not given keep their defaults. Throws InvalidParameter for an unknown name
/// or a value out of range, and what the damage throws.
Damaged damage(std::string_view name, PointsView points, const Values& parameters = {},
               std::uint64_t seed = 0);

/// One case of the benchmark of curved mirrors: a shape, how its mirror is bent, what is done to
/// it.
struct BenchmarkCase {
  std::string name;      ///< "creature-waved-noise-1"
  std::string shape;     ///< "creature", "head", "part", "mask", "sheets"
  std::string bend;      ///< "straight", "bent", "domed", "waved", "twisted"; "none": no mirror
  std::string damage;    ///< "exact", "clean", "noise-0.5", "noise-1", "noise-2", "hole", "half",
                         ///< "density"
  double asymmetry = 0;  ///< root mean square of a smooth displacement, over the diagonal
};

/// The points of a case with its truth.
struct BenchmarkSample {
  Points points;
  Points images;                ///< of the points over the true mirror; no rows without a mirror
  std::vector<Index> partners;  ///< the row that a point's image is; -1: none
  /// The diagonal of the box of as many points before damage: the unit of all errors.
  double diagonal = 0;
  /// "plane", "cylinder", "sphere", or "graph": z = f(x, y) in a frame of its own; "none".
  std::string kind;
  /// Of a plane, cylinder or sphere, those of Mirror::numbers. Of a graph "formula", "amplitude",
  /// "frequency", "phase" (turns) or "slope", and x -> scale * rotation * x + translation from its
  /// frame.
  Values mirror;
};

/// All cases: every shape bent in every way under every damage and with smooth asymmetry of 1 and
/// 3 %, and shapes without a mirror.
const std::vector<BenchmarkCase>& benchmark_cases();

/// The case of that name with so many points. Its shape, pose and scale follow from the seed alone,
/// whatever the count and the damage. The same bits from one build of the library; another compiler
/// may round a sum otherwise and then draw other points. Throws InvalidParameter for a name that
/// is no case or a count below 100.
BenchmarkSample benchmark_sample(std::string_view name, Index count, std::uint64_t seed);

/// Errors of surface points along z in the surface's own frame, in its unit.
struct SurfaceErrors {
  double rmse = 0;   ///< (5.1)
  double e_max = 0;  ///< (5.3)
  double e_avg = 0;  ///< mean absolute error; (5.2) is printed without the absolute value
  double bias = 0;   ///< mean signed error: (5.2) as printed
  Index counted = 0;
  Index skipped = 0;  ///< points where the surface is undefined
};

/// Throws InvalidInput where no point can be counted.
SurfaceErrors surface_errors(PointsView surface_points, const Surface& surface);
SurfaceErrors surface_errors(PointsView surface_points, const SurfaceMirror& surface);

/// Over the diagonal of the object's bounding box.
struct SphereErrors {
  double e_c = 0;  ///< distance of the centres (5.4)
  double e_r = 0;  ///< difference of the radii (5.5)
};

/// Throws InvalidInput for no object or one without extent.
SphereErrors sphere_errors(const Sphere& found, const Sphere& truth, PointsView object);

/// Root mean square of the distances of the surface points from the closest points of the true
/// mirror, over the diagonal of the object's box; needs no frame. Points that have no foot on the
/// mirror are left out. Throws InvalidInput where no point counts.
double surface_distance(PointsView surface_points, const Mirror& truth, PointsView object);

/// Which share of the object's footprint on the true mirror the surface points cover, 0 to 1: of
/// the feet of the object's points, those with a surface point nearer than `tolerance` times the
/// object's diagonal; by default (0) three times the spacing of the feet. Surface points that are
/// not finite cover nothing. Throws InvalidInput for no object or one without feet,
/// InvalidParameter for a tolerance below 0.
double coverage(PointsView surface_points, const Mirror& truth, PointsView object,
                double tolerance = 0);

}  // namespace symsurf
