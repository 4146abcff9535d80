#include <symsurf/mirrors.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "search/methods.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {

namespace {

constexpr int rounds = 12, steps_a_round = 3;
constexpr std::size_t least_matches = 20;  // of points: two a coefficient

using Coefficients = Eigen::Matrix<double, 10, 1>;
using Jacobian = Eigen::Matrix<double, 3, 10>;

// x^2, y^2, z^2, xy, yz, zx, x, y, z, 1
Coefficients monomials(const Vector3& p) {
  Coefficients m;
  m << p.cwiseAbs2(), p.x() * p.y(), p.y() * p.z(), p.z() * p.x(), p, 1;
  return m;
}

Jacobian slopes(const Vector3& p) {
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
struct GeneralQuadric {
  explicit GeneralQuadric(const Coefficients& q)
      : coefficients(q / q.norm()), quadric(quadric_from(coefficients)) {}

  // The image of x and its derivatives by the coefficients, from the conditions of the closest
  // point, y - x + l g(y) = 0 and f(y) = 0; false without an image.
  bool image(const Vector3& x, Vector3& image, Jacobian& derivatives) const {
    const Vector3 y = quadric.foot(x);
    if (!y.allFinite()) return false;
    image = 2 * y - x;
    const Vector3 g = quadric.gradient(y);
    const double squared = g.squaredNorm();
    if (!(squared > 0)) return false;
    const double l = g.dot(x - y) / squared;
    Matrix4 matrix = Matrix4::Zero();
    matrix.topLeftCorner<3, 3>() = Matrix3::Identity() + 2 * l * quadric.matrix();
    matrix.topRightCorner<3, 1>() = g;
    matrix.bottomLeftCorner<1, 3>() = g.transpose();
    Eigen::Matrix<double, 4, 10> right;
    right.topRows<3>() = -l * slopes(y);
    right.bottomRows<1>() = -monomials(y).transpose();
    derivatives = 2 * matrix.partialPivLu().solve(right).topRows<3>();
    return derivatives.allFinite();
  }

  Coefficients coefficients;
  Quadric quadric;
};

// f = 0 and grad f = n at the feet, by least squares: linear in the coefficients.
std::optional<GeneralQuadric> nearest_to(const GrownSurface& surface) {
  if (surface.carried.size() < 10) return std::nullopt;
  Eigen::Matrix<double, 10, 10> matrix = Eigen::Matrix<double, 10, 10>::Zero();
  Coefficients right = Coefficients::Zero();
  constexpr double slope_weight = 0.01;
  for (const Carried& c : surface.carried) {
    const Coefficients m = monomials(c.foot);
    const Jacobian s = slopes(c.foot);
    matrix += m * m.transpose() + slope_weight * s.transpose() * s;
    right += slope_weight * s.transpose() * c.normal;
  }
  matrix.diagonal().array() += 1e-9 * matrix.trace();
  const Coefficients q = solved(matrix, right);
  if (!q.allFinite() || !(q.head<9>().norm() > 0)) return std::nullopt;
  return GeneralQuadric(q);
}

struct System {
  Eigen::Matrix<double, 10, 10> matrix = Eigen::Matrix<double, 10, 10>::Zero();
  Coefficients right = Coefficients::Zero();
  double cost = 0;
};

double tukey_cost(double u) {
  const double inside = 1 - u * u;
  return u >= 1 ? 1 : 1 - inside * inside * inside;
}

// Misses across the partner's surface count, along it only where partners are exact.
System system(const SearchCloud& cloud, const GrownSurface& surface, const GeneralQuadric& model,
              double scale) {
  System s;
  const double along = surface.exact ? 1 : 0.08;
  Jacobian jacobian;
  cloud.context.check();
  for (std::size_t k = 0; k < surface.points.size(); ++k) {
    Vector3 image;
    if (!model.image(cloud.point(surface.points[k]), image, jacobian)) continue;
    const Vector3 n = surface.carried[k].partner_normal;
    const Matrix3 metric = along * Matrix3::Identity() + (1 - along) * n * n.transpose();
    const Vector3 miss = metric * (cloud.point(surface.partners[k]) - image);
    const double u = miss.norm() / (4.7 * scale);
    s.cost += tukey_cost(u);
    if (u >= 1) continue;
    const double weight = biweight(u);
    const Jacobian rows = metric * jacobian;
    s.matrix.noalias() += weight * rows.transpose() * rows;
    s.right.noalias() += weight * rows.transpose() * miss;
  }
  return s;
}

double scale_of(const SearchCloud& cloud, const GrownSurface& surface) {
  std::vector<double> misses;
  for (const Carried& c : surface.carried)
    misses.push_back(surface.exact ? c.miss.norm() : std::abs(c.miss.dot(c.partner_normal)));
  return std::max(1.5 * median(std::move(misses)), 0.02 * cloud.spacing);
}

void improve(const SearchCloud& cloud, const GrownSurface& surface, GeneralQuadric& model) {
  const double scale = scale_of(cloud, surface);
  double damping = 1e-9;
  System here = system(cloud, surface, model, scale);
  for (int k = 0; k < steps_a_round; ++k) {
    Eigen::Matrix<double, 10, 10> damped = here.matrix;
    damped.diagonal().array() += damping * here.matrix.trace() + 1e-300;
    const Coefficients by = solved(damped, here.right);
    if (!by.allFinite()) return;
    const GeneralQuadric next(model.coefficients + by);
    const System there = system(cloud, surface, next, scale);
    if (there.cost > here.cost) {
      damping *= 1e3;
      continue;
    }
    model = next;
    here = there;
  }
}

// The quadric nearest to a surface, matched to the cloud and fitted to its pairs again and again
// by analytic derivatives (Levenberg-Marquardt, Tukey's weights). The surface gets its pairs and
// support; none when the surface has too few points or nothing fits.
std::optional<Quadric> fitted_quadric(const SearchCloud& cloud, GrownSurface& surface) {
  std::optional<GeneralQuadric> model = nearest_to(surface);
  if (!model) return std::nullopt;
  surface.mirror = nullptr;
  for (int round = 0; round <= rounds; ++round) {
    const Quadric& quadric = model->quadric;
    match(
        cloud,
        [&](const Vector3& x, Vector3& foot, Vector3& normal) {
          foot = quadric.foot(x);
          const double distance = quadric.signed_distance(x);
          if (!foot.allFinite() || distance == 0) return false;
          normal = (x - foot) / distance;
          return true;
        },
        surface);
    if (surface.points.size() < least_matches) return std::nullopt;
    if (round < rounds) improve(cloud, surface, *model);
  }
  surface.support = support(cloud, surface);
  return model->quadric;
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
