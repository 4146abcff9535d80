// Where mirrors reflect light (optics).

#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"
#include "reflected_light.h"

namespace symsurf::reflection_points_tests {
namespace {

TEST(ReflectionPoints, OfPlanesAreWhereTheImageIsSeen) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCloud random(seed);
    const Plane plane(random.direction(), random.uniform(-0.5, 0.5));
    const Vector3 source = random.in_box(), eye = random.in_box();
    const ReflectionPoints found = points_of(plane, source, eye);
    const bool same_side = plane.signed_distance(source) * plane.signed_distance(eye) > 0;
    ASSERT_EQ(found.positions.rows(), same_side ? 1 : 0);
    if (!same_side) continue;
    const Vector3 image = plane.reflect(source), x = position(found, 0);
    EXPECT_LE((x - eye).cross((image - eye).normalized()).norm(), 1e-13);
    EXPECT_LE(std::abs(plane.signed_distance(x)), 1e-14);
    const double length = (image - eye).norm();
    EXPECT_NEAR(found.path_lengths[0], length, 1e-13);
    EXPECT_NEAR(found.irradiance[0] * length * length, 1, 1e-10);
  }
}

// On a circle in the plane of s and e: angles at which the path's length turns, of so many.
std::vector<double> turns_of_length(const Eigen::Vector2d& s, const Eigen::Vector2d& e) {
  constexpr int count = 4096;
  const auto slope = [&](double angle) {
    const Eigen::Vector2d x(std::cos(angle), std::sin(angle)), t(-x.y(), x.x());
    return -((s - x).normalized() + (e - x).normalized()).dot(t);
  };
  std::vector<double> angles;
  double before = slope(0);
  for (int k = 1; k <= count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count, after = slope(angle);
    const double middle = angle - std::numbers::pi / count;
    const Eigen::Vector2d x(std::cos(middle), std::sin(middle));
    // Not at the ends of the path, nor where it crosses the circle.
    if ((before < 0) != (after < 0) && (s - x).dot(x) * (e - x).dot(x) > 0)
      angles.push_back(middle);
    before = after;
  }
  return angles;
}

TEST(ReflectionPoints, OfSpheresAreAllThatDenseSamplingSees) {
  std::array<int, 5> counted{};
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    RandomCloud random(seed);
    const Sphere sphere(random.in_box(), random.uniform(0.5, 2));
    const auto end = [&] {  // inside or outside
      const double distance = sphere.radius() * random.uniform(0, seed % 2 ? 1 : 3);
      return Vector3(sphere.centre() + distance * random.direction());
    };
    const Vector3 source = end(), eye = end();
    const ReflectionPoints found = points_of(sphere, source, eye);
    const Vector3 a = (source - sphere.centre()) / sphere.radius(),
                  b = (eye - sphere.centre()) / sphere.radius();
    const Vector3 first = a.normalized(), second = a.cross(b).cross(a).normalized();
    const std::vector<double> turns = turns_of_length({a.norm(), 0}, {b.dot(first), b.dot(second)});
    for (const double angle : turns)
      EXPECT_TRUE(has(
          found,
          sphere.centre() + sphere.radius() * (std::cos(angle) * first + std::sin(angle) * second),
          2e-3 * sphere.radius()))
          << seed << ": " << angle;
    // Two that lie between two samples it does not see.
    EXPECT_GE(found.positions.rows(), static_cast<Index>(turns.size())) << seed;
    ASSERT_LE(found.positions.rows(), 4) << seed;
    ++counted[found.positions.rows()];
    for (Index i = 0; i < found.positions.rows(); ++i) {
      const Vector3 x = position(found, i), normal = (x - sphere.centre()).normalized();
      EXPECT_NEAR((x - sphere.centre()).norm() / sphere.radius(), 1, 1e-14);
      expect_reflected(x, normal, source, eye, "sphere " + std::to_string(seed));
    }
  }
  // From outside one, inside two or four.
  EXPECT_GT(counted[1], 50);
  EXPECT_GT(counted[2], 50);
  EXPECT_GT(counted[4], 20);
}
TEST(ReflectionPoints, OfAConcaveSphereFollowTheMirrorEquation) {
  const double radius = 2;
  const Sphere sphere({0, 0, radius}, radius);  // seen from above its lowest point, the origin
  for (const double from : {0.3, 0.9, 1.5, 3.0})
    for (const double to : {0.5, 1.2, 1.9}) {
      const ReflectionPoints found = points_of(sphere, {0, 0, from}, {0, 0, to});
      bool is_found = false;
      for (Index i = 0; i < found.positions.rows(); ++i) {
        if (position(found, i).norm() > 1e-9) continue;
        is_found = true;
        const double focus = from * (1 + to * (1 / from - 2 / radius));
        EXPECT_NEAR(found.irradiance[i] * focus * focus, 1, 1e-9) << from << ", " << to;
      }
      EXPECT_TRUE(is_found) << from << ", " << to;
    }
  // 1 / 1.5 + 1 / 3 = 2 / r: the image of one end is the other.
  const ReflectionPoints focused = points_of(sphere, {0, 0, 1.5}, {0, 0, 3});
  EXPECT_GT(focused.irradiance.maxCoeff(), 1e20);
}

TEST(ReflectionPoints, OfOtherKindsAreThoseOfTheSameSurface) {
  const Plane plane({0.1, -0.2, 1}, 0.3);
  RandomCloud random(4);
  Points nodes(900, 3);
  for (auto node : nodes.rowwise()) {
    const Vector3 x = 2 * random.in_box();
    // On the plane, over x and y.
    node = (x - plane.signed_distance(x) / plane.normal().z() * Vector3::UnitZ()).transpose();
  }
  const HeightField field({0, 0, 1}, nodes);
  // A paraboloid as one patch of a free form.
  const Quadric bowl(Vector3(0.2, 0.1, 0).asDiagonal().toDenseMatrix(), {0, 0, -1}, 0);
  Patch patch{Vector3::Zero(), Matrix3::Identity(), {0, 0, 0, 0.2, 0, 0.1}, 3};
  FreeForm form({patch});
  form.set_footprint(std::make_shared<Points>(Points(random.box(400))));
  for (int k = 0; k < 30; ++k) {
    const Vector3 source(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.5, 1.5));
    const Vector3 eye(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.5, 1.5));
    const auto expect_found = [&](const Mirror& mirror, const Mirror& known, double width) {
      const ReflectionPoints found = points_of(mirror, source, eye);
      const ReflectionPoints expected = points_of(known, source, eye);
      for (Index i = 0; i < expected.positions.rows(); ++i)
        if (position(expected, i).head<2>().cwiseAbs().maxCoeff() < width) {
          EXPECT_TRUE(has(found, position(expected, i), 1e-8)) << mirror.kind() << " " << k;
        }
      for (Index i = 0; i < found.positions.rows(); ++i) {
        EXPECT_TRUE(has(expected, position(found, i), 1e-8)) << mirror.kind() << " " << k;
        if (expected.positions.rows() == 1 && found.positions.rows() == 1) {
          EXPECT_NEAR(found.irradiance[0] / expected.irradiance[0], 1, 1e-4) << k;
        }
      }
    };
    expect_found(field, plane, 1.5);
    expect_found(form, bowl, 0.8);
  }
}

TEST(ReflectionPoints, OfKnownSurfacesObeyTheLaw) {
  RandomCloud random(7);
  for (const char* name : {"f1", "f2"}) {
    const Matrix3 rotation = random.rotation();
    SurfaceMirror mirror(surface(name), Mapping::Perpendicular, 1.5, rotation, {1, 2, 3});
    Points around = 2 * random.box(200);
    for (Index i = 0; i < around.rows(); ++i)
      around.row(i) = (1.5 * rotation * around.row(i).transpose() + Vector3(1, 2, 3)).transpose();
    mirror.set_footprint(std::make_shared<Points>(around));
    Index count = 0;
    for (int k = 0; k < 20; ++k) {
      const auto end = [&] {
        const Vector3 x = random.in_box();
        return Vector3(1.5 * (rotation * Vector3(x.x(), x.y(), 3 + x.z())) + Vector3(1, 2, 3));
      };
      const Vector3 source = end(), eye = end();
      const ReflectionPoints found = points_of(mirror, source, eye);
      count += found.positions.rows();
      for (Index i = 0; i < found.positions.rows(); ++i) {
        const Vector3 x = position(found, i), at = mirror.to_frame(x);
        EXPECT_NEAR(at.z(), mirror.surface()(at.x(), at.y()), 1e-12);
        const Eigen::Vector2d slope = mirror.surface().gradient(at.x(), at.y());
        expect_reflected(x, rotation * Vector3(-slope.x(), -slope.y(), 1).normalized(), source, eye,
                         name);
      }
    }
    EXPECT_GE(count, 20) << name;
  }
}

TEST(ReflectionPoints, AreOfEachSourceInItsOrderOnAnyThreads) {
  RandomCloud random(5);
  const Points sources = 2 * random.box(500);
  const Quadric quadric = random_quadric(random, 0);
  const Vector3 eye(0.2, 0.1, -0.3);
  const ReflectionPoints all = reflection_points(quadric, sources, eye, Context({}, 1));
  const ReflectionPoints threaded = reflection_points(quadric, sources, eye, Context({}, 3));
  EXPECT_EQ(all.positions, threaded.positions);
  EXPECT_EQ(all.irradiance, threaded.irradiance);
  Index row = 0;
  for (Index i = 0; i < sources.rows(); ++i) {
    const ReflectionPoints one = points_of(quadric, sources.row(i).transpose(), eye);
    for (Index k = 0; k < one.positions.rows(); ++k, ++row) {
      ASSERT_LT(row, all.positions.rows());
      EXPECT_EQ(all.sources[row], i);
      EXPECT_EQ(position(all, row), position(one, k));
      if (k > 0) {
        EXPECT_LE(one.path_lengths[k - 1], one.path_lengths[k]);
      }
    }
  }
  EXPECT_EQ(row, all.positions.rows());
  EXPECT_EQ(reflection_points(quadric, Points(0, 3), eye).positions.rows(), 0);
}

TEST(ReflectionPoints, TakeEndsOnTheMirrorAndRefuseWhatIsNotFinite) {
  const Sphere sphere({0, 0, 0}, 1);
  const double nan = std::nan("");
  // The source itself is none; inside, the other side reflects.
  const ReflectionPoints found = points_of(sphere, {1, 0, 0}, {0.3, 0.2, 0});
  for (Index i = 0; i < found.positions.rows(); ++i) {
    EXPECT_GT((position(found, i) - Vector3(1, 0, 0)).norm(), 1e-3);
    EXPECT_TRUE(std::isfinite(found.irradiance[i]));
  }
  EXPECT_EQ(points_of(sphere, {0, 0, 0}, {0, 0, 0}).positions.rows(), 0);
  EXPECT_EQ(points_of(Plane({0, 0, 1}, 0), {0, 0, 0}, {0, 0, 1}).positions.rows(), 0);
  expect_error<InvalidInput>("source 0 is (nan, 0, 0); coordinates must be finite", [&] {
    points_of(sphere, {nan, 0, 0}, {1, 2, 3});
  });
  expect_error<InvalidInput>("the eye is (0, nan, 0); coordinates must be finite", [&] {
    points_of(sphere, {1, 2, 3}, {0, nan, 0});
  });
  expect_error<InvalidInput>("footprint", [&] {
    points_of(SurfaceMirror(surface("f1"), Mapping::Fixed), {1, 2, 3}, {0, 0, 3});
  });
}

}  // namespace
}  // namespace symsurf::reflection_points_tests
