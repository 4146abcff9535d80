#pragma once

#include <symsurf/parameter.h>
#include <symsurf/points_view.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace symsurf {

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

}  // namespace symsurf
