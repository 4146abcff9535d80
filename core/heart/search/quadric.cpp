#include <symsurf/mirrors.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "fit/candidate.h"
#include "search/methods.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {

namespace {

constexpr int steps = 30;
constexpr std::size_t least_matches = 20;  // of points: two a coefficient

using Coefficients = Eigen::Matrix<double, 10, 1>;
using Jacobian = Eigen::Matrix<double, 3, 10>;

// x^2, y^2, z^2, xy, yz, zx, x, y, z, 1
Coefficients monomials(const Vector3& p) {
  Coefficients m;
  m << p.cwiseAbs2(), p.x() * p.y(), p.y() * p.z(), p.z() * p.x(), p, 1;
  return m;
}

Jacobian gradient_slopes(const Vector3& p) {
  Jacobian s = Jacobian::Zero();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    s(a, a) = 2 * p[a];
    s(a, 3 + a) = p[b];
    s(b, 3 + a) = p[a];
    s(a, 6 + a) = 1;
  }
  return s;
}

Quadric quadric_from(const Coefficients& q) {
  Matrix3 matrix;
  matrix << q[0], q[3] / 2, q[5] / 2, q[3] / 2, q[1], q[4] / 2, q[5] / 2, q[4] / 2, q[2];
  return Quadric(matrix, q.segment<3>(6), q[9]);
}

// By its ten coefficients, one of which is the scale.
struct UnitQuadric {
  using Change = Coefficients;
  static constexpr double ridge = 1e-9;  // the scale is free
  static constexpr bool is_rigid = false;

  explicit UnitQuadric(const Coefficients& q)
      : coefficients(q / q.norm()), quadric(quadric_from(coefficients)) {}

  double distance(const Vector3& x) const { return quadric.signed_distance(x); }
  Vector3 reflect(const Vector3& x) const { return 2 * quadric.foot(x) - x; }
  Vector3 reflect_direction(const Vector3& x, const Vector3& n) const {
    const Vector3 up = quadric.gradient(quadric.foot(x)).normalized();
    return n - 2 * up.dot(n) * up;
  }

  // From the conditions of the closest point, y - x + l g(y) = 0 and f(y) = 0.
  Jacobian slopes(const Vector3& x) const {
    const Vector3 y = quadric.foot(x), g = quadric.gradient(y);
    const double l = g.dot(x - y) / g.squaredNorm();
    Matrix4 matrix = Matrix4::Zero();
    matrix.topLeftCorner<3, 3>() = Matrix3::Identity() + 2 * l * quadric.matrix();
    matrix.topRightCorner<3, 1>() = g;
    matrix.bottomLeftCorner<1, 3>() = g.transpose();
    Eigen::Matrix<double, 4, 10> right;
    right.topRows<3>() = -l * gradient_slopes(y);
    right.bottomRows<1>() = -monomials(y).transpose();
    return 2 * matrix.partialPivLu().solve(right).topRows<3>();
  }

  std::pair<UnitQuadric, double> stepped(const Change& by) const {
    return {UnitQuadric(coefficients + by), by.norm()};
  }
  void follow(const UnitQuadric& moved) { *this = moved; }

  Coefficients coefficients;
  Quadric quadric;
};

// f = 0 and grad f = n at the feet, by least squares: linear in the coefficients.
std::optional<UnitQuadric> nearest_to(const GrownSurface& surface) {
  if (surface.carried.size() < 10) return std::nullopt;
  Eigen::Matrix<double, 10, 10> matrix = Eigen::Matrix<double, 10, 10>::Zero();
  Coefficients right = Coefficients::Zero();
  constexpr double slope_weight = 0.01;
  for (const Carried& c : surface.carried) {
    const Coefficients m = monomials(c.foot);
    const Jacobian s = gradient_slopes(c.foot);
    matrix += m * m.transpose() + slope_weight * s.transpose() * s;
    right += slope_weight * s.transpose() * c.normal;
  }
  matrix.diagonal().array() += 1e-9 * matrix.trace();
  const Coefficients q = solved(matrix, right);
  if (!q.allFinite() || !(q.head<9>().norm() > 0)) return std::nullopt;
  return UnitQuadric(q);
}

// The quadric nearest to a surface, fitted to the cloud, to rounding where partners are exact. The
// surface gets its pairs and support; none when it has too few points or nothing fits.
std::optional<Quadric> fitted_quadric(const SearchCloud& cloud, GrownSurface& surface) {
  const std::optional<UnitQuadric> start = nearest_to(surface);
  if (!start) return std::nullopt;
  surface.mirror = nullptr;
  const double spacing = cloud.spacing;
  UnitQuadric model =
      symsurf::fitted(*start, SearchMatcher(cloud), {4 * spacing, 0.5 * spacing, steps});
  std::vector<Vector3> positions;
  for (const Index i : cloud.tree.order()) positions.push_back(cloud.point(i));
  const NearestPoints points(cloud.points, cloud.tree, cloud.context);
  model =
      fitted_to_exact_pairs(model, positions, points, PrincipalFrame(), spacing).value_or(model);
  match(
      cloud,
      [&](const Vector3& x, Vector3& foot, Vector3& normal) {
        foot = model.quadric.foot(x);
        const double distance = model.distance(x);
        if (!foot.allFinite() || distance == 0) return false;
        normal = (x - foot) / distance;
        return true;
      },
      surface);
  if (surface.points.size() < least_matches) return std::nullopt;
  surface.support = support(cloud, surface);
  return model.quadric;
}

// Finds free-form mirrors and fits quadrics to the best of them.
Result run_quadric(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  constexpr std::size_t most_fitted = 5;
  Search found = search(cloud, values.integer("sample_size"), context.stage(0, 0.6));
  std::vector<Found> fits;
  const std::size_t count = std::min(found.surfaces.size(), most_fitted);
  for (std::size_t k = 0; k < count; ++k) {
    context.stage(0.6, 0.7).report(static_cast<double>(k) / static_cast<double>(count));
    GrownSurface& surface = found.surfaces[k];
    if (const auto quadric = fitted_quadric(found.cloud, surface))
      fits.push_back({in_input_units(*quadric, found.cloud), surface});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Found& a, const Found& b) {
    return a.surface.support > b.surface.support;
  });
  Result result;
  result.method = "quadric";
  fill(result, cloud, found.cloud, fits, values, context.stage(0.7, 1));
  return result;
}

}  // namespace

}  // namespace symsurf::perpendicular

namespace symsurf {

MethodImplementation quadric_method() {
  MethodImplementation method;
  method.name = "quadric";
  method.title = "Mirror quadric";
  method.summary =
      "Finds the quadric (ellipsoid, paraboloid, cone, saddle, ...) that mirrors the shape along "
      "its normals.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.preprocessing.keep_interior = perpendicular::has_exact_partners;
  method.run = perpendicular::run_quadric;
  return method;
}

}  // namespace symsurf
