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

using Complex = std::complex<double>;

std::vector<double> TurnPolynomial::zeros() const {
  const auto at = [&](double angle, double& slope) {
    const Complex a = std::polar(1.0, -angle) * one, b = std::polar(1.0, -2 * angle) * two;
    slope = a.imag() + 2 * b.imag();
    return constant + a.real() + b.real();
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
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  if (!(farthest > rounding * (std::abs(constant) + std::abs(one) + std::abs(two)))) return {};
  const Complex a = std::polar(1.0, -from) * one, b = std::polar(1.0, -2 * from) * two;
  // Times (1 + t^2)^2.
  Eigen::Vector<double, 5> quartic;
  quartic << constant + b.real() + a.real(), 4 * b.imag() + 2 * a.imag(),
      2 * constant - 6 * b.real(), 2 * a.imag() - 4 * b.imag(), constant + b.real() - a.real();
  Matrix4 companion = Matrix4::Zero();
  companion.bottomLeftCorner<3, 3>().setIdentity();
  companion.col(3) = -quartic.head<4>() / quartic[4];
  std::vector<double> angles;
  for (const Complex& t : companion.eigenvalues()) {
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

namespace {

// The points of the unit circle, as unit vectors, at which light is reflected from a source to an
// eye in its plane (Alhazen's problem): at most four.
//
// With complex numbers s, e and z on the circle, s / z - 1 and e / z - 1 are where they are seen
// from z along the normal. Light is reflected where these have opposite angles, so that their
// product is real and positive: Im(s e / z^2 - (s + e) / z) = 0.
std::vector<Eigen::Vector2d> circle_reflection(const Eigen::Vector2d& source,
                                               const Eigen::Vector2d& eye) {
  const Complex s(source.x(), source.y()), e(eye.x(), eye.y()), i(0, 1);
  std::vector<Eigen::Vector2d> found;
  for (const double angle : TurnPolynomial{0, i * (s + e), -i * s * e}.zeros()) {
    const Complex z = std::polar(1.0, angle);
    const Complex product = (s / z - 1.0) * (e / z - 1.0);
    if (product.real() > 0) found.emplace_back(z.real(), z.imag());
  }
  return found;
}

using Found = std::vector<SurfacePoint>;

Found on_plane(const Plane& plane, const LightPath& path) {
  const Foot s = *plane.at(path.source), e = *plane.at(path.eye);
  if (!(s.distance * e.distance > 0)) return {};
  return {{(e.distance * s.point + s.distance * e.point) / (s.distance + e.distance),
           plane.normal(), Matrix3::Zero()}};
}

// As the circle does in a plane; across it the path is straight when unrolled.
Found on_circle(const Vector3& centre, double radius, const Eigen::Matrix<double, 3, 2>& plane,
                const LightPath& path, bool is_sphere) {
  const Vector3 axis = plane.col(0).cross(plane.col(1));
  const Vector3 source = (path.source - centre) / radius, eye = (path.eye - centre) / radius;
  const Eigen::Vector2d s = plane.transpose() * source, e = plane.transpose() * eye;
  Found found;
  for (const Eigen::Vector2d& z : circle_reflection(s, e)) {
    const double from = (s - z).norm(), to = (e - z).norm();
    const Vector3 normal = plane * z, around = axis.cross(normal);
    const double along = axis.dot(to * source + from * eye) / (from + to);
    Matrix3 shape = around * around.transpose();
    if (is_sphere) shape += axis * axis.transpose();
    found.push_back({centre + radius * (normal + along * axis), normal, shape / radius});
  }
  return found;
}

// In the plane through both ends and the centre.
Found on_sphere(const Sphere& sphere, const LightPath& path) {
  const Vector3 s = path.source - sphere.centre(), e = path.eye - sphere.centre();
  const Vector3& longer = s.squaredNorm() > e.squaredNorm() ? s : e;
  if (longer.isZero(0)) return {};
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = longer.normalized();
  const Vector3& other = &longer == &s ? e : s;
  const Vector3 second = other - other.dot(plane.col(0)) * plane.col(0);
  constexpr double rounding = 1e-14;
  plane.col(1) = second.norm() > rounding * longer.norm()
                     ? Vector3(second.normalized())
                     : Vector3(orthogonal_to(plane.col(0)).col(0));
  return on_circle(sphere.centre(), sphere.radius(), plane, path, true);
}

constexpr int cells = 32;          // of the mesh, along the longer side
constexpr double beyond = 0.5;     // of a triangle, up to which its gradient is continued
constexpr double compared = 1e-5;  // of the footprint, between normals for the curvature

// Over what is known of the mirror's extent: its footprint, its nodes or its patches.
Mesh mesh_of(const Mirror& mirror) {
  const Values numbers = mirror.footprint().empty() ? mirror.numbers() : Values();
  for (const char* name : {"nodes", "centres"})
    if (const auto found = numbers.find(name); found != numbers.end())
      return mirror.mesh(Points(std::get<Eigen::MatrixXd>(found->second)), cells);
  return mirror.mesh(cells);
}

// Beside a known surface its point along a direction is found sooner than the closest one.
std::shared_ptr<const Mirror> mapping_fast(const Mirror& mirror) {
  if (mirror.kind() != "surface") return {std::shared_ptr<void>(), &mirror};
  Values numbers = mirror.numbers();
  numbers["mapping"] = std::string("fixed");
  return make_mirror(mirror.kind(), numbers);
}

// The points at which a mirror without a formula reflects light to an eye: Newton's steps from the
// triangles of a mesh over its footprint on which the path length, whose gradient is interpolated,
// is stationary or nearly so.
class FootprintReflection {
 public:
  // Height fields, free forms and surface mirrors. Throws InvalidInput where there is no footprint,
  // nor nodes or patches to stand for it.
  explicit FootprintReflection(const Mirror& mirror) : mirror_(mapping_fast(mirror)) {
    const Mesh mesh = mesh_of(mirror);
    for (const auto& vertex : mesh.vertices.rowwise()) {
      const std::optional<Foot> foot = mirror_->at(vertex);
      feet_.push_back(foot ? *foot : Foot{vertex, Vector3::Constant(NAN), 0});
    }
    triangles_ = mesh.triangles;
    step_ = feet_.empty() ? 0 : compared * diagonal_of(mesh.vertices);
  }

  Found operator()(const LightPath& path) const {
    const auto surface = [this](const Vector3& x) { return at(x); };
    std::vector<Vector3> descents;
    for (const Foot& foot : feet_) descents.push_back(path.descent(foot.point, foot.normal));
    Found found;
    for (const auto& triangle : triangles_.rowwise()) {
      const auto corner = [&](int k) -> const Vector3& { return feet_[triangle[k]].point; };
      const Vector3 &a = corner(0), &b = corner(1), &c = corner(2);
      // Barycentric coordinates of the point at which the interpolated gradient is 0.
      const auto basis = orthogonal_to((b - a).cross(c - a).stableNormalized());
      Eigen::Matrix<double, 3, 2> w;
      for (int k = 0; k < 3; ++k) w.row(k) = descents[triangle[k]].transpose() * basis;
      Vector3 parts = w.col(0).cross(w.col(1));
      parts /= parts.sum();
      if (!(parts.minCoeff() >= -beyond)) continue;
      const Vector3 start = parts[0] * a + parts[1] * b + parts[2] * c;
      const double side = std::max((b - a).norm(), (c - a).norm());
      const std::optional<SurfacePoint> point = converged(path, surface, start, side);
      if (point && (point->position - start).norm() <= 2 * side) found.push_back(*point);
    }
    return found;
  }

 private:
  std::optional<SurfacePoint> at(const Vector3& x) const {
    const std::optional<Foot> foot = mirror_->at(x);
    if (!foot) return std::nullopt;
    const auto across = orthogonal_to(foot->normal);
    Eigen::Matrix<double, 3, 2> turn;
    for (int k = 0; k < 2; ++k) {
      const Vector3 step = step_ * across.col(k);
      const std::optional<Foot> ahead = mirror_->at(foot->point + step),
                                behind = mirror_->at(foot->point - step);
      if (!ahead || !behind) return std::nullopt;
      turn.col(k) = (ahead->normal - behind->normal) / (2 * step_);
    }
    const Eigen::Matrix2d bend = across.transpose() * turn;
    return SurfacePoint{foot->point, foot->normal,
                        across * (bend + bend.transpose()) / 2 * across.transpose()};
  }

  std::shared_ptr<const Mirror> mirror_;
  std::vector<Foot> feet_;  // of the mesh's vertices
  Triangles triangles_;
  double step_;  // over which normals are compared
};

ReflectionFinder finder_of(const Mirror& mirror, const Vector3& eye) {
  if (const auto* plane = dynamic_cast<const Plane*>(&mirror))
    return [plane](const LightPath& path) { return on_plane(*plane, path); };
  if (const auto* sphere = dynamic_cast<const Sphere*>(&mirror))
    return [sphere](const LightPath& path) { return on_sphere(*sphere, path); };
  if (const auto* cylinder = dynamic_cast<const Cylinder*>(&mirror))
    return [cylinder, across = orthogonal_to(cylinder->axis())](const LightPath& path) {
      return on_circle(cylinder->point(), cylinder->radius(), across, path, false);
    };
  if (const auto* quadric = dynamic_cast<const Quadric*>(&mirror))
    return quadric_reflection(*quadric, eye);
  return FootprintReflection(mirror);
}

struct Reflection {
  double length, irradiance;
  Vector3 position;
};

// Each point once, by path length.
std::vector<Reflection> distinct(const LightPath& path, const Found& found) {
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
    if (!is_known) own.push_back({length, path.irradiance(at), at.position});
  }
  std::sort(own.begin(), own.end(), [](const Reflection& a, const Reflection& b) {
    if (a.length != b.length) return a.length < b.length;
    return std::lexicographical_compare(a.position.begin(), a.position.end(), b.position.begin(),
                                        b.position.end());
  });
  return own;
}

}  // namespace

ReflectionPoints reflection_points(const Mirror& mirror, PointsView sources, const Vector3& eye,
                                   const Context& context) {
  require_finite(sources, "source");
  if (!eye.allFinite())
    throw InvalidInput("the eye is " + to_string(Value(eye)) + "; coordinates must be finite");
  const auto find = finder_of(mirror, eye);
  std::vector<std::vector<Reflection>> found(sources.size());
  parallel_for(context, sources.size(), 64, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      context.check();  // over a quadric near two planes a source takes long
      const LightPath path{sources[i], eye};
      found[i] = distinct(path, find(path));
    }
  });
  Index count = 0, row = 0;
  for (const auto& of_source : found) count += static_cast<Index>(of_source.size());
  ReflectionPoints all{Points(count, 3), {}, Eigen::VectorXd(count), Eigen::VectorXd(count)};
  all.sources.resize(count);
  for (Index i = 0; i < sources.size(); ++i)
    for (const Reflection& one : found[i]) {
      all.positions.row(row) = one.position;
      all.sources[row] = i;
      all.path_lengths[row] = one.length;
      all.irradiance[row++] = one.irradiance;
    }
  return all;
}

}  // namespace symsurf
