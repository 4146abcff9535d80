#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/principal_frame.h"

namespace symsurf {

namespace {

// A foot of a free-form mirror takes some ten microseconds.
constexpr Index grain = 1024;

// Cells along the longer side of a mesh, which holds their square: some gigabytes.
constexpr int finest = 4096;

template <typename Function>
void for_each(PointsView points, const Context& context, const Function& take) {
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) take(i, points[i]);
  });
}

// Eigen compares matrices of one size only.
bool are_equal(const Value& a, const Value& b) {
  const auto* one = std::get_if<Eigen::MatrixXd>(&a);
  const auto* other = std::get_if<Eigen::MatrixXd>(&b);
  if (one && other && (one->rows() != other->rows() || one->cols() != other->cols())) return false;
  return a == b;
}

}  // namespace

Vector3 Mirror::foot(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot ? foot->point : Vector3::Constant(NAN);
}

double Mirror::signed_distance(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot ? foot->distance : NAN;
}

Vector3 Mirror::reflect(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot && has_image(*foot) ? Vector3(x + 2 * (foot->point - x)) : Vector3::Constant(NAN);
}

// Of x = y + d v, y on the mirror: along a perpendicular one, whose v is the normal n, steps dx are
// (I + d dn) dy, and across it the foot stays.
Matrix3 Mirror::foot_jacobian(const Foot& foot) const {
  const Vector3 v = direction(foot), &n = foot.normal;
  const Matrix3 along = Matrix3::Identity() + foot.distance * shape_operator(foot);
  return along.inverse() - v * n.transpose() / n.dot(v);
}

Matrix3 Mirror::jacobian(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  if (!foot || !has_image(*foot)) return Matrix3::Constant(NAN);
  return 2 * foot_jacobian(*foot) - Matrix3::Identity();
}

Points Mirror::reflect(PointsView points, const Context& context) const {
  Points images(points.size(), 3);
  for_each(points, context, [&](Index i, const Vector3& x) { images.row(i) = reflect(x); });
  return images;
}

Points Mirror::project(PointsView points, const Context& context) const {
  Points feet(points.size(), 3);
  for_each(points, context, [&](Index i, const Vector3& x) { feet.row(i) = foot(x); });
  return feet;
}

Eigen::VectorXd Mirror::signed_distance(PointsView points, const Context& context) const {
  Eigen::VectorXd distances(points.size());
  for_each(points, context, [&](Index i, const Vector3& x) { distances[i] = signed_distance(x); });
  return distances;
}

bool Mirror::operator==(const Mirror& other) const {
  if (kind() != other.kind()) return false;
  const Values own = numbers(), others = other.numbers();
  return std::equal(own.begin(), own.end(), others.begin(), others.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && are_equal(a.second, b.second);
                    });
}

Mesh Mirror::mesh(PointsView object, int resolution, const Context& context) const {
  if (object.empty())
    throw InvalidInput(
        "there are no points to lay the mesh over: a mirror made by hand has no "
        "footprint of its own, give the points of the object");
  require_finite(object, "point");
  require_extent(object, "points");
  if (resolution < 1 || resolution > finest)
    throw InvalidParameter("resolution is " + std::to_string(resolution) + "; allowed is 1 to " +
                           std::to_string(finest));
  std::vector<std::optional<Foot>> all(object.size());
  for_each(object, context.stage(0, 0.3), [&](Index i, const Vector3& x) { all[i] = at(x); });
  std::vector<Foot> feet;
  for (const std::optional<Foot>& foot : all)
    if (foot && foot->point.allFinite() && has_image(*foot)) feet.push_back(*foot);
  if (feet.empty())
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has an image over this " + std::string(kind()));
  Mesh mesh = mesh_over(feet, resolution, context.stage(0.3, 1));
  require_finite(mesh.vertices, "vertex of the mirror's mesh");
  return mesh;
}

namespace {

bool lie_on(const Mirror& mirror, PointsView points, double limit) {
  return (mirror.signed_distance(points).array().abs() <= limit).all();
}

}  // namespace

std::shared_ptr<Mirror> mirror_through(PointsView points, double tolerance) {
  if (!points.matrix().allFinite()) throw InvalidInput("the points of a mirror must be finite");
  if (points.size() < 3) return nullptr;
  const PrincipalFrame frame = principal_frame(points, Context());
  const double limit = tolerance * frame.size;
  if (!(std::sqrt(frame.variance[1]) > limit)) return nullptr;
  const Vector3 normal = frame.axes.col(2);
  auto plane = std::make_shared<Plane>(normal, -normal.dot(frame.centroid));
  if (lie_on(*plane, points, limit)) return plane;
  // In the frame, where the numbers are about 1.
  const Eigen::Vector4d round =
      sphere_through((points.matrix().rowwise() - frame.centroid.transpose()) / frame.size);
  if (!std::isfinite(round[3]) || !(round[3] > 0)) return nullptr;
  auto sphere = std::make_shared<Sphere>(frame.centroid + frame.size * round.head<3>(),
                                         frame.size * round[3]);
  return lie_on(*sphere, points, limit) ? sphere : nullptr;
}

}  // namespace symsurf
