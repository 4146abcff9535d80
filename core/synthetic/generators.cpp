#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include "base/find_named.h"
#include "base/math.h"

namespace symsurf {

namespace {

Parameter mirror_surface() {
  return Parameter::choice("surface", "f1", surface_names(),
                           "The thesis's function whose graph is the mirror.");
}

// The cloud to mirror, where none is given.
std::vector<Parameter> sampled_cloud(std::string_view default_surface) {
  return {
      Parameter::choice("cloud", std::string(default_surface), surface_names(),
                        "The thesis's function whose sampled graph is mirrored when no points are "
                        "given."),
      Parameter::real("extent", 2, 0, infinity, "",
                      "The graph is sampled for x and y from minus to plus this."),
      Parameter::integer("resolution", 40, 2, finest_grid, "", "Samples along x, and along y."),
  };
}

Points cloud_or(PointsView points, const ParameterValues& values) {
  if (!points.empty()) return points.matrix();
  return sampled_surface(surface(values.choice("cloud")), values.real("extent"),
                         values.integer("resolution"));
}

Sample run_fixed(PointsView points, const ParameterValues& values) {
  return mirror_fixed(cloud_or(points, values), surface(values.choice("surface")),
                      values.real("shift"), values.vector("direction"));
}

Generator fixed() {
  Generator generator;
  generator.name = "fixed";
  generator.title = "Sample mirrored in a fixed direction";
  generator.summary = "Mirrors a cloud over a surface along one direction (thesis 5.1.1).";
  generator.parameters = sampled_cloud("f5");
  generator.parameters.insert(generator.parameters.begin(), mirror_surface());
  Parameter direction = Parameter::direction(
      "direction", "Direction of mapping; the surface's z axis is turned to it.");
  direction.default_value = Vector3(0, 0, 1);
  generator.parameters.push_back(
      Parameter::real("shift", 3, -infinity, infinity, "",
                      "The cloud is moved by this along the direction before it is mirrored."));
  generator.parameters.push_back(direction);
  generator.mirrors_points = true;
  generator.run = run_fixed;
  return generator;
}

Sample run_perpendicular(PointsView, const ParameterValues& values) {
  return mirror_perpendicular(surface(values.choice("surface")), values.real("extent"),
                              values.integer("resolution"), values.real("min_distance"),
                              values.real("max_distance"), values.integer("waves"));
}

Generator perpendicular() {
  Generator generator;
  generator.name = "perpendicular";
  generator.title = "Sample mirrored perpendicularly";
  generator.summary =
      "Moves samples of a surface along its normals to either side, at a constant distance or in "
      "waves (thesis 5.1.2).";
  generator.parameters = {
      mirror_surface(),
      Parameter::real("extent", 2, 0, infinity, "",
                      "The surface is sampled for x and y from minus to plus this."),
      Parameter::integer("resolution", 40, 2, finest_grid, "", "Samples along x, and along y."),
      Parameter::real("min_distance", 0.5, 0, infinity, "",
                      "Distance of the points from the surface, the least where there are waves."),
      Parameter::real("max_distance", 1, 0, infinity, "",
                      "The greatest distance; counts only where there are waves."),
      Parameter::integer("waves", 0, 0, 1000, "",
                         "How many times the distance changes along x between least and "
                         "greatest; 0 keeps it constant."),
  };
  generator.run = run_perpendicular;
  return generator;
}

Sample run_spherical(PointsView points, const ParameterValues& values) {
  const Points cloud = cloud_or(points, values);
  const double diagonal = (cloud.colwise().maxCoeff() - cloud.colwise().minCoeff()).norm();
  const double radius = diagonal / values.real("radius_divisor");
  const Index first = values.integer("first_vertex"), second = values.integer("second_vertex");
  if (first < 0 || second < 0)
    return mirror_spherical(cloud, Sphere(values.vector("centre"), radius));
  for (const Index vertex : {first, second})
    if (vertex >= cloud.rows())
      throw InvalidParameter("vertex " + std::to_string(vertex) + " is not among the " +
                             std::to_string(cloud.rows()) + " points");
  return mirror_spherical(cloud, sphere_between(cloud.row(first), cloud.row(second), radius));
}

Generator spherical() {
  Generator generator;
  generator.name = "spherical";
  generator.title = "Sample mirrored over a sphere";
  generator.summary = "Mirrors the part of a cloud inside a sphere over it (thesis 5.1.3).";
  generator.parameters = sampled_cloud("f1");
  generator.parameters.push_back(
      Parameter::position("centre", "Centre of the sphere, unless it lies between two vertices."));
  generator.parameters.push_back(
      Parameter::real("radius_divisor", 4, 1e-3, 1e3, "",
                      "The cloud's diagonal is divided by this to give the radius."));
  generator.parameters.push_back(Parameter::integer(
      "first_vertex", -1, -1, std::numeric_limits<std::int32_t>::max(), "",
      "With the second vertex: the sphere passes midway between the two, its centre on the first "
      "one's side; -1: it has the centre given."));
  generator.parameters.push_back(Parameter::integer("second_vertex", -1, -1,
                                                    std::numeric_limits<std::int32_t>::max(), "",
                                                    "See the first vertex."));
  generator.mirrors_points = true;
  generator.run = run_spherical;
  return generator;
}

}  // namespace

const std::vector<Generator>& generators() {
  static const std::vector<Generator> list{fixed(), perpendicular(), spherical()};
  return list;
}

Sample generate(std::string_view name, const Values& parameters, PointsView points) {
  const Generator& generator = find_named(generators(), name, "generator");
  return generator.run(points, ParameterValues(generator.name, generator.parameters, parameters));
}

}  // namespace symsurf
