#include <symsurf/synthetic.h>

#include <numeric>

#include "base/find_named.h"
#include "base/math.h"

namespace symsurf {

namespace {

void add_box(std::vector<Parameter>& parameters) {
  parameters.push_back(Parameter::position(
      "box_low", "Lowest corner of the box of points affected; equal corners: all points."));
  parameters.push_back(Parameter::position(
      "box_high", "Highest corner of the box of points affected; equal corners: all points."));
}

Box box(const ParameterValues& values) {
  const Vector3 low = values.vector("box_low"), high = values.vector("box_high");
  return low == high ? Box{} : Box{low, high};
}

Damaged all_kept(Points points) {
  Damaged damaged;
  damaged.kept.resize(points.rows());
  std::iota(damaged.kept.begin(), damaged.kept.end(), Index{0});
  damaged.points = std::move(points);
  return damaged;
}

Damage noise() {
  Damage damage;
  damage.name = "noise";
  damage.title = "Random noise";
  damage.summary = "Moves the points in a box in random directions (thesis 5.3).";
  damage.parameters = {
      Parameter::real("low", 0, 0, infinity, "", "The least distance a point is moved by."),
      Parameter::real("high", 0.1, 0, infinity, "", "The greatest distance a point is moved by."),
  };
  add_box(damage.parameters);
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t seed) {
    return all_kept(add_noise(points, values.real("low"), values.real("high"), box(values), seed));
  };
  return damage;
}

Damage removal() {
  Damage damage;
  damage.name = "removal";
  damage.title = "Remove points";
  damage.summary = "Removes points in a box at random (thesis 5.3).";
  damage.parameters = {Parameter::real("probability", 1, 0, 1, "",
                                       "Chance of each point in the box to be removed.")};
  add_box(damage.parameters);
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t seed) {
    return remove_points(points, values.real("probability"), box(values), seed);
  };
  return damage;
}

Damage rotation() {
  Damage damage;
  damage.name = "rotation";
  damage.title = "Rotate points";
  damage.summary = "Turns the points about the origin: about x, then y, then z.";
  damage.parameters = {
      Parameter::real("roll", 0, -infinity, infinity, "degrees", "Angle about the x axis."),
      Parameter::real("pitch", 0, -infinity, infinity, "degrees", "Angle about the y axis."),
      Parameter::real("yaw", 0, -infinity, infinity, "degrees", "Angle about the z axis."),
  };
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t) {
    return all_kept(rotate(points, values.real("roll"), values.real("pitch"), values.real("yaw")));
  };
  return damage;
}

Damage thinning() {
  Damage damage;
  damage.name = "thinning";
  damage.title = "Uneven density";
  damage.summary = "Keeps only some of the points of one half of the box.";
  Parameter direction =
      Parameter::direction("direction", "The half that lies this way is thinned.");
  direction.default_value = Vector3(1, 0, 0);
  damage.parameters = {
      Parameter::real("ratio", 10, 1, infinity, "", "One point in so many is kept there."),
      direction,
  };
  damage.run = [](PointsView points, const ParameterValues& values, std::uint64_t seed) {
    return thin(points, values.real("ratio"), values.vector("direction"), seed);
  };
  return damage;
}

}  // namespace

const std::vector<Damage>& damages() {
  static const std::vector<Damage> list{noise(), removal(), rotation(), thinning()};
  return list;
}

Damaged damage(std::string_view name, PointsView points, const Values& parameters,
               std::uint64_t seed) {
  const Damage& kind = find_named(damages(), name, "damage");
  return kind.run(points, ParameterValues(kind.name, kind.parameters, parameters), seed);
}

}  // namespace symsurf
