#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/semidefinite_solve.h"
#include "cloud/principal_frame.h"

namespace symsurf {

namespace {

bool lie_on(const Mirror& mirror, PointsView points, double limit) {
  return (mirror.signed_distance(points).array().abs() <= limit).all();
}

// |x|^2 = 2 c . x + d by least squares, in the frame, where the numbers are about 1.
std::shared_ptr<Mirror> fitted_sphere(PointsView points, const PrincipalFrame& frame) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 x = frame.to_frame(points[i]);
    const Eigen::Vector4d row(2 * x.x(), 2 * x.y(), 2 * x.z(), 1);
    normal += row * row.transpose();
    right += x.squaredNorm() * row;
  }
  const Eigen::Vector4d solution = solved(normal, right);
  const Vector3 centre = solution.head<3>();
  const double radius = std::sqrt(solution[3] + centre.squaredNorm());
  if (!std::isfinite(radius) || !(radius > 0)) return nullptr;
  return std::make_shared<Sphere>(frame.from_frame(centre), frame.size * radius);
}

}  // namespace

std::shared_ptr<Mirror> mirror_through(PointsView points, double tolerance) {
  if (!points.matrix().allFinite()) throw InvalidInput("the points of a mirror must be finite");
  if (points.size() < 3) return nullptr;
  const PrincipalFrame frame = principal_frame(points, Partition(points.size()), Context());
  const double limit = tolerance * frame.size;
  if (!(std::sqrt(frame.variance[1]) > limit)) return nullptr;
  const Vector3 normal = frame.axes.col(2);
  auto plane = std::make_shared<Plane>(normal, -normal.dot(frame.centroid));
  if (lie_on(*plane, points, limit)) return plane;
  auto sphere = fitted_sphere(points, frame);
  return sphere && lie_on(*sphere, points, limit) ? sphere : nullptr;
}

}  // namespace symsurf
