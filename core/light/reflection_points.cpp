#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "reflection_search.h"

namespace symsurf {

namespace {

using Found = std::vector<SurfacePoint>;

Found on_plane(const Plane& plane, const LightPath& path) {
  const double s = plane.signed_distance(path.source), e = plane.signed_distance(path.eye);
  if (!(s * e > 0)) return {};
  const Vector3 position = (e * plane.foot(path.source) + s * plane.foot(path.eye)) / (s + e);
  return {{position, plane.normal(), Matrix3::Zero()}};
}

// In the plane through both ends and the centre.
Found on_sphere(const Sphere& sphere, const LightPath& path) {
  const Vector3 s = (path.source - sphere.centre()) / sphere.radius();
  const Vector3 e = (path.eye - sphere.centre()) / sphere.radius();
  const Vector3& longer = s.squaredNorm() > e.squaredNorm() ? s : e;
  if (longer.isZero(0)) return {};
  const Vector3 first = longer.normalized(), other = longer == s ? e : s;
  Vector3 second = other - other.dot(first) * first;
  constexpr double rounding = 1e-14;
  second = second.norm() > rounding * longer.norm() ? Vector3(second.normalized())
                                                    : Vector3(orthogonal_to(first).col(0));
  Found found;
  for (const Eigen::Vector2d& z :
       circle_reflection({s.dot(first), s.dot(second)}, {e.dot(first), e.dot(second)})) {
    const Vector3 normal = z.x() * first + z.y() * second;
    const Matrix3 shape = (Matrix3::Identity() - normal * normal.transpose()) / sphere.radius();
    found.push_back({sphere.centre() + sphere.radius() * normal, normal, shape});
  }
  return found;
}

// As the circle does across the axis; along it the path is straight when unrolled.
Found on_cylinder(const Cylinder& cylinder, const LightPath& path) {
  const auto across = orthogonal_to(cylinder.axis());
  const auto flat = [&](const Vector3& x) -> Eigen::Vector2d {
    return across.transpose() * (x - cylinder.point()) / cylinder.radius();
  };
  const auto height = [&](const Vector3& x) { return (x - cylinder.point()).dot(cylinder.axis()); };
  const Eigen::Vector2d s = flat(path.source), e = flat(path.eye);
  Found found;
  for (const Eigen::Vector2d& z : circle_reflection(s, e)) {
    const double from = (s - z).norm(), to = (e - z).norm();
    const Vector3 normal = across * z, around = cylinder.axis().cross(normal);
    const double along = (to * height(path.source) + from * height(path.eye)) / (from + to);
    found.push_back({cylinder.point() + cylinder.radius() * normal + along * cylinder.axis(),
                     normal, around * around.transpose() / cylinder.radius()});
  }
  return found;
}

std::function<Found(const LightPath&)> finder_of(const Mirror& mirror, const Vector3& eye) {
  if (const auto* plane = dynamic_cast<const Plane*>(&mirror))
    return [plane](const LightPath& path) { return on_plane(*plane, path); };
  if (const auto* sphere = dynamic_cast<const Sphere*>(&mirror))
    return [sphere](const LightPath& path) { return on_sphere(*sphere, path); };
  if (const auto* cylinder = dynamic_cast<const Cylinder*>(&mirror))
    return [cylinder](const LightPath& path) { return on_cylinder(*cylinder, path); };
  if (const auto* quadric = dynamic_cast<const Quadric*>(&mirror))
    return [search = QuadricReflection(*quadric, eye)](const LightPath& path) {
      return search(path.source);
    };
  return [search = std::make_shared<FootprintReflection>(mirror, eye)](const LightPath& path) {
    return (*search)(path.source);
  };
}

struct Reflection {
  Index source;
  double length, irradiance;
  Vector3 position;
};

// Each point once, by path length.
void add(const LightPath& path, Index source, const Found& found, std::vector<Reflection>& all) {
  constexpr double same = 1e-7;     // of the path: two points nearer to each other are one
  constexpr double at_end = 1e-12;  // of the path: a point nearer to an end is the end
  std::vector<Reflection> own;
  for (const SurfacePoint& at : found) {
    const double length = path.length(at.position);
    const double nearer =
        std::min((path.source - at.position).norm(), (path.eye - at.position).norm());
    if (!(nearer > at_end * length) || !path.is_reflected(at)) continue;
    const bool is_known = std::any_of(own.begin(), own.end(), [&](const Reflection& other) {
      return (other.position - at.position).norm() <= same * length;
    });
    if (!is_known) own.push_back({source, length, path.irradiance(at), at.position});
  }
  std::sort(own.begin(), own.end(), [](const Reflection& a, const Reflection& b) {
    if (a.length != b.length) return a.length < b.length;
    return std::lexicographical_compare(a.position.begin(), a.position.end(), b.position.begin(),
                                        b.position.end());
  });
  all.insert(all.end(), own.begin(), own.end());
}

}  // namespace

ReflectionPoints reflection_points(const Mirror& mirror, PointsView sources, const Vector3& eye,
                                   const Context& context) {
  require_finite(sources, "source");
  if (!eye.allFinite())
    throw InvalidInput("the eye is " + to_string(Value(eye)) + "; coordinates must be finite");
  const auto find = finder_of(mirror, eye);
  constexpr Index grain = 64;
  std::vector<std::vector<Reflection>> parts((sources.size() + grain - 1) / grain);
  parallel_for(context, sources.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      context.check();  // over a quadric near two planes a source takes long
      const LightPath path{sources[i], eye};
      add(path, i, find(path), parts[begin / grain]);
    }
  });
  Index count = 0;
  for (const auto& part : parts) count += static_cast<Index>(part.size());
  ReflectionPoints all{Points(count, 3), {}, Eigen::VectorXd(count), Eigen::VectorXd(count)};
  all.sources.resize(count);
  Index row = 0;
  for (const auto& part : parts)
    for (const Reflection& one : part) {
      all.positions.row(row) = one.position.transpose();
      all.sources[row] = one.source;
      all.path_lengths[row] = one.length;
      all.irradiance[row++] = one.irradiance;
    }
  return all;
}

std::vector<double> TurnPolynomial::zeros() const {
  const auto at = [&](double angle, double& slope) {
    const double c = std::cos(angle), s = std::sin(angle), cc = c * c - s * s, ss = 2 * s * c;
    slope = s1 * c - c1 * s + 2 * (s2 * cc - c2 * ss);
    return constant + c1 * c + s1 * s + c2 * cc + s2 * ss;
  };
  // The tangent of half the angle is infinite opposite to where it is reckoned from: of five
  // angles, one more than there are zeros, that farthest from one.
  double farthest = 0, from = 0, slope;
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5 + 0.1, value = std::abs(at(angle, slope));
    if (!(value > farthest)) continue;
    farthest = value;
    from = angle + std::numbers::pi;
  }
  const double size =
      std::abs(constant) + std::abs(c1) + std::abs(s1) + std::abs(c2) + std::abs(s2);
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  if (!(farthest > rounding * size)) return {};
  const std::complex<double> one = std::polar(1.0, -from) * std::complex(c1, s1),
                             two = std::polar(1.0, -2 * from) * std::complex(c2, s2);
  // Times (1 + t^2)^2.
  Eigen::Vector<double, 5> quartic;
  quartic << constant + two.real() + one.real(), 4 * two.imag() + 2 * one.imag(),
      2 * constant - 6 * two.real(), 2 * one.imag() - 4 * two.imag(),
      constant + two.real() - one.real();
  Matrix4 companion = Matrix4::Zero();
  companion.bottomLeftCorner<3, 3>().setIdentity();
  companion.col(3) = -quartic.head<4>() / quartic[4];
  std::vector<double> angles;
  for (const std::complex<double>& t : companion.eigenvalues()) {
    constexpr double real = 1e-6;  // of a double root's halves: the root of rounding
    if (std::abs(t.imag()) > real * (1 + std::abs(t))) continue;
    double angle = from + 2 * std::atan(t.real());
    for (int step = 0; step < 3; ++step) {
      const double move = at(angle, slope) / slope;
      if (std::abs(move) < real) angle -= move;
    }
    angles.push_back(angle);
  }
  return angles;
}

std::vector<Eigen::Vector2d> circle_reflection(const Eigen::Vector2d& source,
                                               const Eigen::Vector2d& eye) {
  using Complex = std::complex<double>;
  const Complex s(source.x(), source.y()), e(eye.x(), eye.y());
  const Complex p = s * e, q = s + e;
  const TurnPolynomial condition{0, -q.imag(), q.real(), p.imag(), -p.real()};
  std::vector<Eigen::Vector2d> found;
  for (const double angle : condition.zeros()) {
    const Complex z = std::polar(1.0, angle);
    const Complex product = (s / z - 1.0) * (e / z - 1.0);
    if (product.real() > 0) found.emplace_back(z.real(), z.imag());
  }
  return found;
}

namespace {

constexpr int cells = 32;          // of the mesh, along the longer side
constexpr double beyond = 0.5;     // of a triangle, up to which its gradient is continued
constexpr double compared = 1e-5;  // of the footprint, between normals for the curvature

// What is known of the mirror's extent: its footprint, its nodes or its patches.
Mesh mesh_of(const Mirror& mirror) {
  if (!mirror.footprint().empty()) return mirror.mesh(cells);
  if (const auto* field = dynamic_cast<const HeightField*>(&mirror))
    return mirror.mesh(field->nodes(), cells);
  if (const auto* form = dynamic_cast<const FreeForm*>(&mirror)) {
    std::vector<Vector3> centres;
    for (const Patch& patch : form->patches()) centres.push_back(patch.centre);
    return mirror.mesh(rows_of(centres), cells);
  }
  return mirror.mesh(cells);
}

}  // namespace

FootprintReflection::Tangent FootprintReflection::tangent_of(const Mirror& mirror) {
  if (const auto* form = dynamic_cast<const FreeForm*>(&mirror))
    return [form](const Vector3& x, Vector3& foot, Vector3& normal) {
      constexpr double full_precision = 1e-14;
      return form->foot(x, full_precision, foot, normal);
    };
  if (const auto* field = dynamic_cast<const HeightField*>(&mirror))
    return [field](const Vector3& x, Vector3& foot, Vector3& normal) {
      foot = field->foot(x);
      normal = field->normal(x);
      return foot.allFinite() && normal.allFinite();
    };
  const auto& known = dynamic_cast<const SurfaceMirror&>(mirror);
  return [&known](const Vector3& x, Vector3& foot, Vector3& normal) {
    const Vector3 at = known.to_frame(x);
    const double height = known.surface()(at.x(), at.y());
    const Eigen::Vector2d slope = known.surface().gradient(at.x(), at.y());
    foot = x + known.scale() * (height - at.z()) * known.direction();
    // z - f(x, y) grows along the normal: its gradient, through the frame's directions.
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 d = known.to_frame(x + known.scale() * Vector3::Unit(axis)) - at;
      normal[axis] = d.z() - slope.dot(d.head<2>());
    }
    normal.normalize();
    return foot.allFinite() && normal.allFinite();
  };
}

FootprintReflection::FootprintReflection(const Mirror& mirror, const Vector3& eye)
    : eye_(eye), tangent_(tangent_of(mirror)) {
  const Mesh mesh = mesh_of(mirror);
  for (const auto& vertex : mesh.vertices.rowwise()) {
    Vector3 foot = vertex.transpose(), normal;
    if (!tangent_(vertex.transpose(), foot, normal)) normal.setConstant(std::nan(""));
    feet_.push_back(foot);
    normals_.push_back(normal);
  }
  triangles_ = mesh.triangles;
  step_ =
      mesh.vertices.rows() == 0
          ? 0
          : compared *
                (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).norm();
}

bool FootprintReflection::at(const Vector3& x, SurfacePoint& found) const {
  if (!tangent_(x, found.position, found.normal)) return false;
  const auto across = orthogonal_to(found.normal);
  Eigen::Matrix<double, 3, 2> turn;
  for (int k = 0; k < 2; ++k) {
    Vector3 foot, ahead, behind;
    if (!tangent_(found.position + step_ * across.col(k), foot, ahead) ||
        !tangent_(found.position - step_ * across.col(k), foot, behind))
      return false;
    turn.col(k) = (ahead - behind) / (2 * step_);
  }
  const Eigen::Matrix2d bend = across.transpose() * turn;
  found.shape = across * (bend + bend.transpose()) / 2 * across.transpose();
  return true;
}

std::vector<SurfacePoint> FootprintReflection::operator()(const Vector3& source) const {
  const LightPath path{source, eye_};
  const auto surface = [this](const Vector3& x, SurfacePoint& point) { return at(x, point); };
  std::vector<Vector3> descents;
  for (std::size_t i = 0; i < feet_.size(); ++i)
    descents.push_back(path.descent(feet_[i], normals_[i]));
  std::vector<SurfacePoint> found;
  for (const auto& triangle : triangles_.rowwise()) {
    const Vector3 &a = feet_[triangle[0]], &b = feet_[triangle[1]], &c = feet_[triangle[2]];
    // Barycentric coordinates of the point at which the interpolated gradient is 0.
    const auto basis = orthogonal_to((b - a).cross(c - a).stableNormalized());
    Eigen::Matrix<double, 2, 3> w;
    for (int k = 0; k < 3; ++k) w.col(k) = basis.transpose() * descents[triangle[k]];
    const auto minor = [&](int i, int j) { return w(0, i) * w(1, j) - w(1, i) * w(0, j); };
    Vector3 parts(minor(1, 2), minor(2, 0), minor(0, 1));
    parts /= parts.sum();
    if (!(parts.minCoeff() >= -beyond)) continue;
    const Vector3 start = parts[0] * a + parts[1] * b + parts[2] * c;
    const double side = std::max((b - a).norm(), (c - a).norm());
    SurfacePoint point;
    if (converges(path, surface, start, side, point) && (point.position - start).norm() <= 2 * side)
      found.push_back(point);
  }
  return found;
}

}  // namespace symsurf
