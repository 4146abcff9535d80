#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>

#include "base/math.h"
#include "base/named_values.h"
#include "cloud/cloud.h"

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

namespace {

// About the axis across both; v is a unit vector.
Matrix3 turn_of_z_to(const Vector3& v) {
  const double x = v.x(), y = v.y(), z = v.z();
  const double above = z > 0 ? 1 + z : (x * x + y * y) / (1 - z);  // 1 + z, its digits kept
  if (above == 0) return Vector3(1, -1, -1).asDiagonal();
  Matrix3 turn;
  turn << 1 - x * x / above, -x * y / above, x, -x * y / above, 1 - y * y / above, y, -x, -y, z;
  return turn;
}

// P, then P', of the points that have an image.
Sample joined(const std::vector<Vector3>& points, const std::vector<Vector3>& images,
              std::shared_ptr<const Mirror> truth, Index skipped) {
  const auto count = static_cast<Index>(points.size());
  Sample sample;
  sample.truth = std::move(truth);
  sample.skipped = skipped;
  sample.points.resize(2 * count, 3);
  sample.pairs.resize(count, 2);
  for (Index i = 0; i < count; ++i) {
    sample.points.row(i) = points[i].transpose();
    sample.points.row(count + i) = images[i].transpose();
    sample.pairs.row(i) << i, count + i;
  }
  return sample;
}

// Calls visit(x, y) on the grid, x in the outer loop; returns how many visits refused.
Index over_grid(double extent, Index resolution, const std::function<bool(double, double)>& visit) {
  if (!(extent > 0) || !std::isfinite(extent))
    throw InvalidParameter("extent is " + to_string(Value(extent)) + "; allowed is (0, inf)");
  if (resolution < 2 || resolution > finest_grid)
    throw InvalidParameter("resolution is " + std::to_string(resolution) + "; allowed is [2, " +
                           std::to_string(finest_grid) + "]");
  Index refused = 0;
  const auto position = [&](Index i) {
    // Symmetric about 0 to the last bit.
    return extent * static_cast<double>(2 * i - (resolution - 1)) /
           static_cast<double>(resolution - 1);
  };
  for (Index i = 0; i < resolution; ++i)
    for (Index j = 0; j < resolution; ++j) refused += !visit(position(i), position(j));
  return refused;
}

void require_some(const std::vector<Vector3>& kept, const Surface& surface, const char* where) {
  if (kept.empty())
    throw InvalidInput("surface " + surface.name + " = " + surface.formula +
                       " is undefined everywhere " + where);
}

}  // namespace

Points sampled_surface(const Surface& surface, double extent, Index resolution) {
  std::vector<Vector3> kept;
  over_grid(extent, resolution, [&](double x, double y) {
    const double z = surface(x, y);
    if (!std::isfinite(z)) return false;
    kept.emplace_back(x, y, z);
    return true;
  });
  require_some(kept, surface, "on the grid");
  Points points(static_cast<Index>(kept.size()), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = kept[i].transpose();
  return points;
}

Sample mirror_fixed(PointsView points, const Surface& surface, double shift,
                    const Vector3& direction) {
  require_points(points);
  if (!direction.allFinite() || direction.isZero(0))
    throw InvalidParameter("direction is " + to_string(Value(direction)) +
                           "; allowed is any finite vector but (0, 0, 0)");
  if (!std::isfinite(shift))
    throw InvalidParameter("shift is " + to_string(Value(shift)) + "; it must be finite");
  const Vector3 v = direction.normalized();
  const Matrix3 turn = turn_of_z_to(v);
  const SurfaceMirror standing(surface, Mapping::Fixed);
  std::shared_ptr<const Mirror> truth = standing.transformed(1, turn, Vector3::Zero());

  std::vector<Vector3> kept, images;
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 p = points[i] + shift * v, image = truth->reflect(p);
    if (!image.allFinite()) continue;
    kept.push_back(p);
    images.push_back(image);
  }
  require_some(kept, surface, "on the points");
  return joined(kept, images, truth, points.size() - static_cast<Index>(kept.size()));
}

Sample mirror_perpendicular(const Surface& surface, double extent, Index resolution,
                            double min_distance, double max_distance, Index waves) {
  const auto require_distance = [](const char* name, double value) {
    if (!(value >= 0) || !std::isfinite(value))
      throw InvalidParameter(std::string(name) + " is " + to_string(Value(value)) +
                             "; allowed is [0, inf)");
  };
  if (waves < 0)
    throw InvalidParameter("waves is " + std::to_string(waves) + "; allowed is [0, inf)");
  require_distance("min_distance", min_distance);
  if (waves > 0) {
    require_distance("max_distance", max_distance);
    if (max_distance < min_distance)
      throw InvalidParameter("max_distance is " + to_string(Value(max_distance)) +
                             ", below min_distance, " + to_string(Value(min_distance)));
  }

  const auto distance = [&](double x) {
    if (waves == 0) return min_distance;
    const double phase = (x + extent) / (2 * extent) * static_cast<double>(waves);
    const double leg = std::fmod(phase, 2);
    return min_distance + (max_distance - min_distance) * (leg <= 1 ? leg : 2 - leg);
  };
  std::vector<Vector3> kept, images;
  const Index skipped = over_grid(extent, resolution, [&](double x, double y) {
    const Vector3 s(x, y, surface(x, y));
    const Eigen::Vector2d gradient = surface.gradient(x, y);
    if (!s.allFinite() || !gradient.allFinite()) return false;
    const Vector3 normal = Vector3(gradient.x(), gradient.y(), -1).normalized();
    kept.push_back(s + distance(x) * normal);
    images.push_back(s - distance(x) * normal);
    return true;
  });
  require_some(kept, surface, "on the grid");
  return joined(kept, images, std::make_shared<SurfaceMirror>(surface, Mapping::Perpendicular),
                skipped);
}

Sample mirror_spherical(PointsView points, const Sphere& sphere) {
  require_points(points);
  std::vector<Vector3> kept, images;
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 image = sphere.reflect(points[i]);
    if (!(sphere.signed_distance(points[i]) < 0) || !image.allFinite()) continue;
    kept.push_back(points[i]);
    images.push_back(image);
  }
  if (kept.empty())
    throw InvalidInput("none of the " + std::to_string(points.size()) +
                       " points lies inside the sphere with centre " +
                       to_string(Value(sphere.centre())) + " and radius " +
                       to_string(Value(sphere.radius())));
  return joined(kept, images, std::make_shared<Sphere>(sphere),
                points.size() - static_cast<Index>(kept.size()));
}

Sphere sphere_between(const Vector3& first, const Vector3& second, double radius) {
  const Vector3 chord = first - second;
  if (!chord.allFinite() || chord.isZero(0))
    throw InvalidInput("a sphere between two points needs two that differ; given " +
                       to_string(Value(first)) + " and " + to_string(Value(second)));
  return {(first + second) / 2 + radius * chord.normalized(), radius};
}

}  // namespace symsurf
