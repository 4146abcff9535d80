// Where quadrics reflect light (optics).

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "light/reflection_search.h"
#include "random_cloud.h"
#include "reflected_light.h"

namespace symsurf::quadric_reflection_points_tests {
namespace {

// A surface f = 0 of second degree, for searches that know nothing of the method's.
struct Implicit {
  std::function<double(const Vector3&)> value;
  std::function<Vector3(const Vector3&)> gradient;
  Matrix3 hessian;

  std::optional<SurfacePoint> operator()(Vector3 x) const {
    for (int k = 0; k < 30; ++k) {
      const Vector3 g = gradient(x);
      x -= value(x) / g.squaredNorm() * g;
    }
    if (!x.allFinite() || !(std::abs(value(x)) < 1e-9)) return std::nullopt;
    const Vector3 g = gradient(x), normal = g.normalized();
    const Matrix3 p = Matrix3::Identity() - normal * normal.transpose();
    return SurfacePoint{x, normal, p * hessian * p / g.norm()};
  }
};

Implicit implicit(const Quadric& quadric) {
  return {[&](const Vector3& x) { return quadric.value(x); },
          [&](const Vector3& x) { return quadric.gradient(x); }, 2 * quadric.matrix()};
}

// All points that Newton's steps reach from anywhere about are among those found.
void expect_complete(const ReflectionPoints& found, const Implicit& surface, const Vector3& source,
                     const Vector3& eye, RandomCloud& random, const std::string& what) {
  const LightPath path{source, eye};
  for (int k = 0; k < 200; ++k) {
    const Vector3 start = 2 * random.in_box();
    std::optional<SurfacePoint> at = surface(start);
    if (!at || at->position.norm() > 10) continue;
    at = converged(path, surface, at->position, 0.2);
    if (!at || at->position.norm() > 100) continue;
    EXPECT_TRUE(has(found, at->position, 1e-5 * path.length(at->position)))
        << what << " " << at->position.transpose();
  }
}

TEST(ReflectionPoints, OfQuadricsAreAllThatNewtonReaches) {
  Index count = 0;
  for (int kind = 0; kind < 10; ++kind)
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      RandomCloud random(100 * kind + seed);
      const Quadric quadric = random_quadric(random, kind);
      const Vector3 source = 2 * random.in_box();
      const Vector3 eye = seed % 5 == 0 ? source : Vector3(2 * random.in_box());
      const std::string what = std::to_string(kind) + ", " + std::to_string(seed);
      const ReflectionPoints found = points_of(quadric, source, eye);
      count += found.positions.rows();
      for (Index i = 0; i < found.positions.rows(); ++i) {
        const Vector3 x = position(found, i), g = quadric.gradient(x);
        EXPECT_LE(std::abs(quadric.value(x)) / g.norm(), 1e-12 * (1 + x.norm())) << what;
        expect_reflected(x, g.normalized(), source, eye, what);
      }
      expect_complete(found, implicit(quadric), source, eye, random, what);
    }
  EXPECT_GT(count, 300);
}

// A camera on the axis of a mirror of revolution, or close to it: there the curve that is searched
// falls apart, or nearly.
TEST(ReflectionPoints, OfQuadricsFromOnOrNearTheAxis) {
  for (const double aside : {0.0, 1e-13, 1e-10, 1e-7, 1e-4, 1e-2})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      RandomCloud random(seed);
      const Vector3 curves(1, 1, seed % 2 ? 0.0 : -0.5);
      const Vector3 linear(0, 0, seed % 2 ? -1.0 : 0.0);
      const Quadric quadric(curves.asDiagonal().toDenseMatrix(), linear, seed % 2 ? 0 : 0.3);
      const Vector3 source = 2 * random.in_box();
      const Vector3 eye(aside, 0.3 * aside, random.uniform(-2, 2));
      const std::string what = std::to_string(aside) + ", " + std::to_string(seed);
      const ReflectionPoints found = points_of(quadric, source, eye);
      for (Index i = 0; i < found.positions.rows(); ++i)
        expect_reflected(position(found, i), quadric.gradient(position(found, i)).normalized(),
                         source, eye, what);
      expect_complete(found, implicit(quadric), source, eye, random, what);
    }
}

// The same mirror as two kinds: closed forms against the search.
TEST(ReflectionPoints, OfSpheresAndCylindersAreThoseOfTheirQuadrics) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCloud random(seed);
    const Vector3 centre = random.in_box(), axis = random.direction();
    const double radius = random.uniform(0.5, 2);
    const Vector3 source = 3 * random.in_box(), eye = 3 * random.in_box();
    const auto expect_same = [&](const Mirror& mirror, const Matrix3& matrix) {
      const Quadric quadric(matrix, centre, Vector3::Zero(), -radius * radius);
      const ReflectionPoints one = points_of(mirror, source, eye),
                             other = points_of(quadric, source, eye);
      ASSERT_EQ(one.positions.rows(), other.positions.rows()) << mirror.kind() << " " << seed;
      for (Index i = 0; i < one.positions.rows(); ++i) {
        EXPECT_LE((position(one, i) - position(other, i)).norm(), 1e-7) << seed;
        EXPECT_NEAR(one.path_lengths[i], other.path_lengths[i], 1e-12) << seed;
        EXPECT_NEAR(one.irradiance[i] / other.irradiance[i], 1, 1e-5) << seed;
      }
    };
    expect_same(Sphere(centre, radius), Matrix3::Identity());
    expect_same(Cylinder(centre, axis, radius), Matrix3::Identity() - axis * axis.transpose());
  }
}

TEST(ReflectionPoints, IrradianceIsThatOfAThinBundleOfRays) {
  Index count = 0;
  for (int kind = 0; kind < 10; ++kind)
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      RandomCloud random(1000 * kind + seed);
      const Quadric quadric = random_quadric(random, kind);
      const Vector3 source = 2 * random.in_box(), eye = 2 * random.in_box();
      const ReflectionPoints found = points_of(quadric, source, eye);
      for (Index i = 0; i < found.positions.rows(); ++i) {
        const Vector3 x = position(found, i), to = (x - source).normalized();
        const Vector3 out = (eye - x).normalized();
        // Where a ray meets the mirror next to x, and then the plane across the ray at the eye.
        const auto traced = [&](const Vector3& direction) -> Vector3 {
          double t = (x - source).norm();
          for (int k = 0; k < 20; ++k) {
            const Vector3 y = source + t * direction;
            t -= quadric.value(y) / quadric.gradient(y).dot(direction);
          }
          const Vector3 y = source + t * direction, n = quadric.gradient(y).normalized();
          const Vector3 reflected = direction - 2 * direction.dot(n) * n;
          return y + (eye - y).dot(out) / reflected.dot(out) * reflected;
        };
        const Vector3 a = to.unitOrthogonal(), b = to.cross(a);
        constexpr double h = 1e-5;
        const Vector3 da =
            (traced((to + h * a).normalized()) - traced((to - h * a).normalized())) / (2 * h);
        const Vector3 db =
            (traced((to + h * b).normalized()) - traced((to - h * b).normalized())) / (2 * h);
        const double irradiance = 1 / da.cross(db).norm();
        // Near a focus or at grazing incidence the bundle is not thin.
        if (irradiance > 100 || std::abs(to.dot(quadric.gradient(x).normalized())) < 0.1) continue;
        EXPECT_NEAR(found.irradiance[i] / irradiance, 1, 1e-4) << kind << ", " << seed;
        ++count;
      }
    }
  EXPECT_GT(count, 80);
}

}  // namespace
}  // namespace symsurf::quadric_reflection_points_tests
