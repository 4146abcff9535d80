#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

Plane::Plane(const Vector3& normal, double offset) {
  const double length = length_of(normal);
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(offset / length))
    throw InvalidInput(
        "a plane needs a normal of finite length above 0 and a finite offset; given " +
        to_string(Value(normal)) + " and " + to_string(Value(offset)));
  normal_ = normal / length;
  offset_ = offset / length;
}

Matrix4 Plane::matrix() const {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() -= 2 * normal_ * normal_.transpose();
  m.topRightCorner<3, 1>() = -2 * offset_ * normal_;
  return m;
}

Matrix3 Plane::axes() const {
  Matrix3 rows;
  rows << orthogonal_to(normal_).transpose(), normal_.transpose();
  return rows;
}

Values Plane::numbers() const { return {{"normal", normal_}, {"offset", offset_}}; }

std::unique_ptr<Mirror> Plane::transformed(double scale, const Matrix3& rotation,
                                           const Vector3& translation) const {
  const Vector3 normal = rotation * normal_;
  return std::make_unique<Plane>(normal, scale * offset_ - normal.dot(translation));
}

// The rectangle along the footprint's principal axes, so that it turns with the object.
Mesh Plane::mesh_over(PointsView object, int resolution, const Context& context) const {
  const Points feet = project(object);
  const Eigen::RowVector3d centre = feet.colwise().mean();
  const Points centred = feet.rowwise() - centre;
  const Vector3 u = eigen_of_scatter(centred).vectors.col(2);
  const Vector3 v = normal_.cross(u).normalized();
  const Eigen::VectorXd along_u = centred * u, along_v = centred * v;
  const double u0 = along_u.minCoeff(), v0 = along_v.minCoeff();
  const double width = along_u.maxCoeff() - u0, height = along_v.maxCoeff() - v0;
  return grid_mesh(grid_cells(width, height, resolution), context,
                   [&](double s, double t) -> Vector3 {
                     return centre.transpose() + (u0 + s * width) * u + (v0 + t * height) * v;
                   });
}

namespace {

// From the unit square to the unit disc as (radius, angle), squares to circles (Shirley and Chiu,
// "A low distortion map between disk and square", 1997).
std::pair<double, double> disc_from_square(double s, double t) {
  constexpr double quarter = std::numbers::pi / 4;
  const double a = 2 * s - 1, b = 2 * t - 1;
  if (a == 0 && b == 0) return {0, 0};
  if (std::abs(a) > std::abs(b)) return {a, quarter * b / a};
  return {b, 2 * quarter - quarter * a / b};
}

}  // namespace

Sphere::Sphere(const Vector3& centre, double radius) : centre_(centre), radius_(radius) {
  if (!centre.allFinite() || !(radius > 0) || !std::isfinite(radius))
    throw InvalidInput("a sphere needs a finite centre and a finite radius above 0; given " +
                       to_string(Value(centre)) + " and " + to_string(Value(radius)));
}

Vector3 Sphere::foot(const Vector3& x) const {
  const Vector3 u = x - centre_;
  const double distance = u.norm();
  return distance > 0 ? Vector3(centre_ + radius_ / distance * u) : no_point();
}

double Sphere::signed_distance(const Vector3& x) const {
  const double distance = (x - centre_).norm();
  return distance > 0 ? distance - radius_ : std::numeric_limits<double>::quiet_NaN();
}

bool Sphere::has_image(const Vector3& x) const {
  const double distance = (x - centre_).norm();
  return distance > 0 && distance <= 2 * radius_;
}

Values Sphere::numbers() const { return {{"centre", centre_}, {"radius", radius_}}; }

std::unique_ptr<Mirror> Sphere::transformed(double scale, const Matrix3& rotation,
                                            const Vector3& translation) const {
  return std::make_unique<Sphere>(scale * rotation * centre_ + translation, scale * radius_);
}

Mesh Sphere::mesh_over(PointsView object, int resolution, const Context& context) const {
  constexpr double pi = std::numbers::pi;
  std::vector<Vector3> directions;
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < object.size(); ++i) {
    if (!has_image(object[i])) continue;
    directions.push_back((object[i] - centre_).normalized());
    sum += directions.back();
  }
  if (directions.empty())
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has an image over this sphere");

  const bool balanced = sum.norm() < 1e-9 * static_cast<double>(directions.size());
  const Vector3 pole = balanced ? Vector3(Vector3::UnitZ()) : Vector3(sum.normalized());
  double opening = 0;
  for (const Vector3& u : directions)
    opening = std::max(opening, std::atan2(pole.cross(u).norm(), pole.dot(u)));
  if (opening > 0.9 * pi) opening = pi;

  const Vector3 e1 = pole.unitOrthogonal(), e2 = pole.cross(e1);
  const Mesh mesh =
      grid_mesh({resolution, resolution}, context, [&](double s, double t) -> Vector3 {
        const auto [rho, angle] = disc_from_square(s, t);
        const double polar = opening * rho;
        return centre_ +
               radius_ * (std::cos(polar) * pole +
                          std::sin(polar) * (std::cos(angle) * e1 + std::sin(angle) * e2));
      });
  // Where the cap closes to the whole sphere its rim is one point.
  if (opening < pi) return mesh;
  const double side = radius_ * pi / resolution;
  return part_of(mesh, [&](Index t) {
    const Matrix3 corners = mesh.vertices(mesh.triangles.row(t), Eigen::indexing::all);
    const Vector3 one = corners.row(1) - corners.row(0), other = corners.row(2) - corners.row(0);
    return one.cross(other).norm() >= 1e-9 * side * side;
  });
}

Cylinder::Cylinder(const Vector3& point, const Vector3& axis, double radius)
    : point_(point), axis_(axis / length_of(axis)), radius_(radius) {
  const double length = length_of(axis);
  if (!point.allFinite() || !(length > 0) || !std::isfinite(length) || !(radius > 0) ||
      !std::isfinite(radius))
    throw InvalidInput(
        "a cylinder needs a finite point, an axis of finite length above 0 and a finite radius "
        "above 0; given " +
        to_string(Value(point)) + ", " + to_string(Value(axis)) + " and " +
        to_string(Value(radius)));
}

Vector3 Cylinder::foot(const Vector3& x) const {
  const Vector3 v = from_axis(x);
  const double distance = v.norm();
  return distance > 0 ? Vector3(x + (radius_ / distance - 1) * v) : no_point();
}

double Cylinder::signed_distance(const Vector3& x) const {
  const double distance = from_axis(x).norm();
  return distance > 0 ? distance - radius_ : std::numeric_limits<double>::quiet_NaN();
}

bool Cylinder::has_image(const Vector3& x) const {
  const double distance = from_axis(x).norm();
  return distance > 0 && distance <= 2 * radius_;
}

Values Cylinder::numbers() const {
  return {{"point", point_}, {"axis", axis_}, {"radius", radius_}};
}

std::unique_ptr<Mirror> Cylinder::transformed(double scale, const Matrix3& rotation,
                                              const Vector3& translation) const {
  return std::make_unique<Cylinder>(scale * (rotation * point_) + translation, rotation * axis_,
                                    scale * radius_);
}

Mesh Cylinder::mesh_over(PointsView object, int resolution, const Context& context) const {
  constexpr double pi = std::numbers::pi;
  std::vector<Vector3> feet;
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < object.size(); ++i) {
    if (!has_image(object[i])) continue;
    feet.push_back(foot(object[i]) - point_);
    sum += from_axis(object[i]).normalized();
  }
  if (feet.empty())
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has an image over this cylinder");
  // Angles are counted from the mean direction, so that the shell's gap falls opposite to it.
  const bool balanced = sum.norm() < 1e-9 * static_cast<double>(feet.size());
  const Vector3 e1 = balanced ? Vector3(axis_.unitOrthogonal()) : Vector3(sum.normalized());
  const Vector3 e2 = axis_.cross(e1);
  double first = pi, last = -pi, low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3& y : feet) {
    const double angle = std::atan2(y.dot(e2), y.dot(e1));
    first = std::min(first, angle);
    last = std::max(last, angle);
    low = std::min(low, y.dot(axis_));
    high = std::max(high, y.dot(axis_));
  }
  const double arc = radius_ * (last - first), height = high - low;
  return grid_mesh(grid_cells(arc, height, resolution), context,
                   [&](double s, double t) -> Vector3 {
                     const double angle = first + s * (last - first);
                     return point_ + (low + t * height) * axis_ +
                            radius_ * (std::cos(angle) * e1 + std::sin(angle) * e2);
                   });
}

Quadric::Quadric(const Matrix3& matrix, const Vector3& linear, double constant)
    : Quadric(matrix, Vector3::Zero(), linear, constant) {}

Quadric::Quadric(const Matrix3& matrix, const Vector3& origin, const Vector3& gradient,
                 double value)
    : origin_(origin),
      matrix_((matrix + matrix.transpose()) / 2),
      linear_(gradient),
      constant_(value) {
  // Not only those given, but also those about the coordinates' own origin, which numbers() names.
  if (!matrix_.allFinite() || !origin.allFinite() || !gradient.allFinite() ||
      !std::isfinite(value) || !linear().allFinite() || !std::isfinite(constant()) ||
      (matrix_.isZero(0) && gradient.isZero(0)))
    throw InvalidInput("a quadric needs finite numbers, and not all of A and b zero");
  const SymmetricEigen<3> eigen = eigen_of(matrix_);
  axes_ = eigen.vectors;
  curves_ = eigen.values;
}

Vector3 Quadric::foot(const Vector3& x) const {
  // In the eigenvectors' frame: y_i = (x_i - l b_i) / (1 + 2 l a_i). Between the poles f(y(l))
  // falls monotonically, so its zero there, if any, is one, and the closest point.
  const Vector3 p = axes_.transpose() * (x - origin_), b = axes_.transpose() * linear_;
  const auto at = [&](double l) -> Vector3 {
    return (p - l * b).array() / (1 + 2 * l * curves_.array());
  };
  const auto f = [&](double l, double& slope) {
    const Vector3 y = at(l);
    const Vector3 g = 2 * curves_.cwiseProduct(y) + b;
    slope = -(g.array().square() / (1 + 2 * l * curves_.array())).sum();
    return (curves_.array() * y.array().square()).sum() + b.dot(y) + constant_;
  };
  const double most = curves_.maxCoeff(), least = curves_.minCoeff();
  double low = most > 0 ? -1 / (2 * most) : -infinity;
  double high = least < 0 ? -1 / (2 * least) : infinity;

  double slope, l = 0, value = f(0, slope);
  for (int step = 0; step < 200; ++step) {
    if (value == 0 || slope == 0) break;
    (value > 0 ? low : high) = l;
    double next = l - value / slope;
    if (next == l) break;
    if (!(next > low && next < high)) {
      if (std::isinf(low) || std::isinf(high)) return no_point();
      next = (low + high) / 2;
    }
    const double moved = std::abs(next - l);
    l = next;
    value = f(l, slope);
    if (moved <= 1e-16 * std::abs(l)) break;
  }
  const Vector3 y = at(l);
  const Vector3 g = 2 * curves_.cwiseProduct(y) + b;
  const double size = g.norm() * (y.norm() + (p - y).norm()) + std::abs(constant_);
  return y.allFinite() && std::abs(value) <= 1e-9 * size ? Vector3(origin_ + axes_ * y)
                                                         : no_point();
}

double Quadric::signed_distance(const Vector3& x) const {
  const double distance = (x - foot(x)).norm();
  return value(x) < 0 ? -distance : distance;
}

Values Quadric::numbers() const {
  return {{"matrix", Eigen::MatrixXd(matrix_)},
          {"linear", linear()},
          {"constant", constant()},
          {"origin", origin_},
          {"gradient", linear_},
          {"value", constant_}};
}

std::unique_ptr<Mirror> Quadric::transformed(double scale, const Matrix3& rotation,
                                             const Vector3& translation) const {
  // f((R'(x - t)) / s), times s^2.
  return std::make_unique<Quadric>(rotation * matrix_ * rotation.transpose(),
                                   scale * (rotation * origin_) + translation,
                                   scale * (rotation * linear_), scale * scale * constant_);
}

Mesh Quadric::mesh_over(PointsView object, int resolution, const Context& context) const {
  const Points feet = finite_rows(project(object, context.stage(0, 0.3)));
  if (feet.rows() == 0)
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has a foot on this quadric");
  return surface_net(
      feet, resolution, [this](const Vector3& x) { return value(x); },
      [this](const Vector3& x) { return foot(x); }, context);
}

}  // namespace symsurf
