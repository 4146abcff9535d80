#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"

namespace symsurf {

namespace {

double checked_diagonal(PointsView object) {
  if (object.empty()) throw InvalidInput("0 points of the object given; at least 1 is needed");
  const Vector3 extent =
      object.matrix().colwise().maxCoeff() - object.matrix().colwise().minCoeff();
  if (!extent.allFinite()) throw InvalidInput("points of the object are not finite");
  if (!(extent.norm() > 0))
    throw InvalidInput("all " + std::to_string(object.size()) + " points of the object are equal");
  return extent.norm();
}

// The closest point of the mirror: a fixed direction's foot is not.
Vector3 closest(const Mirror& mirror, const Vector3& x) {
  const auto* surface = dynamic_cast<const SurfaceMirror*>(&mirror);
  return surface ? surface->closest(x) : mirror.foot(x);
}

template <typename Frame>
SurfaceErrors errors_in_frame(PointsView surface_points, const Surface& surface,
                              const Frame& frame) {
  if (surface_points.empty()) throw InvalidInput("0 surface points given; at least 1 is needed");
  SurfaceErrors errors;
  double squared = 0;
  for (Index i = 0; i < surface_points.size(); ++i) {
    const Vector3 x = frame(surface_points[i]);
    const double error = x.z() - surface(x.x(), x.y());
    if (!std::isfinite(error)) {
      ++errors.skipped;
      continue;
    }
    ++errors.counted;
    squared += error * error;
    errors.bias += error;
    errors.e_avg += std::abs(error);
    errors.e_max = std::max(errors.e_max, std::abs(error));
  }
  if (errors.counted == 0)
    throw InvalidInput("surface " + surface.name + " = " + surface.formula +
                       " is undefined at all " + std::to_string(surface_points.size()) +
                       " surface points");
  const auto count = static_cast<double>(errors.counted);
  errors.rmse = std::sqrt(squared / count);
  errors.bias /= count;
  errors.e_avg /= count;
  return errors;
}

}  // namespace

SurfaceErrors surface_errors(PointsView surface_points, const Surface& surface) {
  return errors_in_frame(surface_points, surface, [](const Vector3& x) { return x; });
}

SurfaceErrors surface_errors(PointsView surface_points, const SurfaceMirror& surface) {
  return errors_in_frame(surface_points, surface.surface(),
                         [&](const Vector3& x) { return surface.to_frame(x); });
}

SphereErrors sphere_errors(const Sphere& found, const Sphere& truth, PointsView object) {
  const double size = checked_diagonal(object);
  return {(found.centre() - truth.centre()).norm() / size,
          std::abs(found.radius() - truth.radius()) / size};
}

double surface_distance(PointsView surface_points, const Mirror& truth, PointsView object) {
  const double size = checked_diagonal(object);
  double squared = 0;
  Index counted = 0;
  for (Index i = 0; i < surface_points.size(); ++i) {
    const double distance = (surface_points[i] - closest(truth, surface_points[i])).norm();
    if (!std::isfinite(distance)) continue;
    squared += distance * distance;
    ++counted;
  }
  if (counted == 0)
    throw InvalidInput("none of the " + std::to_string(surface_points.size()) +
                       " surface points has a foot on the true mirror");
  return std::sqrt(squared / static_cast<double>(counted)) / size;
}

double coverage(PointsView surface_points, const Mirror& truth, PointsView object,
                double tolerance) {
  if (!(tolerance >= 0))
    throw InvalidParameter("tolerance is " + to_string(Value(tolerance)) + "; allowed is [0, inf)");
  double reach = tolerance * checked_diagonal(object);
  const Points feet = finite_rows(truth.project(object));
  const Index rows = feet.rows();
  if (rows == 0)
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has a foot on the true mirror");
  const Points covering = finite_rows(surface_points.matrix());
  if (covering.rows() == 0) return 0;

  constexpr double spacings = 3;
  constexpr Index copies = 2;  // a point and its image share a foot
  if (tolerance == 0) reach = spacings * surface_spacing(feet, PointTree(feet), copies);
  const PointTree tree(covering);
  Index covered = 0;
  for (Index i = 0; i < rows; ++i) covered += tree.nearest(feet.row(i), reach * reach).index >= 0;
  return static_cast<double>(covered) / static_cast<double>(rows);
}

}  // namespace symsurf
