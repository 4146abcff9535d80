#pragma once

#include <symsurf/mirror.h>
#include <symsurf/parameter.h>
#include <symsurf/sphere.h>
#include <symsurf/surface.h>

#include <memory>
#include <string>
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

}  // namespace symsurf
