#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>

#include "cloud/cloud.h"

namespace symsurf {

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
