#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "random_cloud.h"

namespace symsurf::perpendicular_tests {
namespace {

// Two surfaces around a piece of a surface, at a distance that varies, under a random pose.
struct Surfaces {
  Points points;
  Matrix3 rotation;
  Vector3 shift;
};

template <typename SurfaceAndNormal>
Surfaces surfaces_around(std::uint64_t seed, const SurfaceAndNormal& surface, double near,
                         double far) {
  RandomCloud random(seed);
  constexpr int side = 22;
  Surfaces s{Points(2 * side * side, 3), random.rotation(), 5 * random.in_box()};
  Index row = 0;
  for (int a = 0; a < side; ++a)
    for (int b = 0; b < side; ++b) {
      const double u = (a + random.uniform(0.1, 0.9)) / side,
                   v = (b + random.uniform(0.1, 0.9)) / side;
      const auto [x, normal] = surface(2 * u - 1, 2 * v - 1);
      const double d = near + (far - near) * u;
      s.points.row(row++) = (s.rotation * (x + d * normal) + s.shift).transpose();
      s.points.row(row++) = (s.rotation * (x - d * normal) + s.shift).transpose();
    }
  return s;
}

std::pair<Vector3, Vector3> roof_tile(double u, double v) {
  const Vector3 normal(std::sin(u), 0, std::cos(u));
  return {2 * normal + v * Vector3::UnitY(), normal};
}

double diagonal(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

TEST(Perpendicular, FindsTheCurvedMirrorBetweenTwoSurfaces) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces s = surfaces_around(seed, roof_tile, 0.25, 0.4);
    const Result result = detect(s.points, {.method = "perpendicular"});
    ASSERT_TRUE(result.mirror) << seed;
    EXPECT_GT(result.score, 0.7) << seed;
    EXPECT_GT(result.pairs.rows(), 0.95 * s.points.rows()) << seed;
    const Cylinder truth(s.shift, s.rotation * Vector3::UnitY(), 2);
    for (Index i = 0; i < result.surface_points.rows(); ++i)
      EXPECT_NEAR(truth.signed_distance(Vector3(result.surface_points.row(i))), 0,
                  1e-3 * diagonal(s.points));
    for (Index i = 0; i < result.pairs.rows(); ++i)
      EXPECT_NE(result.pairs(i, 0), result.pairs(i, 1));
  }
}

TEST(Perpendicular, PlacesEveryPairOnItsSurface) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Surfaces s = surfaces_around(seed, roof_tile, 0.05, 0.2);
    RandomCloud random(seed);
    const double noise = 0.015 * diagonal(s.points);
    for (Index i = 0; i < s.points.rows(); ++i)
      s.points.row(i) += noise * random.in_box().transpose();
    const Result result = detect(s.points, {.method = "perpendicular"});
    EXPECT_EQ(result.surface_points.rows(), result.pairs.rows()) << seed;
    ASSERT_TRUE(result.mirror) << seed;
    EXPECT_LE(result.mirror->signed_distance(result.surface_points).cwiseAbs().maxCoeff(),
              1e-9 * diagonal(s.points))
        << seed;
  }
}

// At one end all points are left, at the other one of four, so that few have their partner there.
TEST(Perpendicular, CoversLayersThatThinOut) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces s = surfaces_around(seed, roof_tile, 0.25, 0.4);
    RandomCloud random(seed);
    std::vector<Index> left;
    for (Index i = 0; i < s.points.rows(); ++i)
      if (random.uniform(0, 1) < 1 - 0.75 * static_cast<double>(i) / s.points.rows())
        left.push_back(i);
    const Points points = s.points(left, Eigen::all);
    const Result result = detect(points, {.method = "perpendicular"});
    const Cylinder truth(s.shift, s.rotation * Vector3::UnitY(), 2);
    EXPECT_GT(coverage(result.surface_points, truth, points, 0.02), 0.9) << seed;
    EXPECT_LT(surface_distance(result.surface_points, truth, points), 0.002) << seed;
  }
}

// A bumpy body whose points stand beside their images over a plane: free forms that bend explain
// nearly as much of it. The largest are thinned for the search, which parts points from their
// images.
TEST(Perpendicular, FindsTheExactPlaneOfABody) {
  for (const Index count : {3000, 10000, 40000}) {
    RandomCloud random(0);
    Points points(count, 3);
    for (Index i = 0; i < count; i += 2) {
      const Vector3 u = random.direction();
      const double radius = 1 + 0.3 * std::sin(3 * u.y() + 1) +
                            0.25 * std::cos(2 * u.z() - 0.5) * u.y() + 0.2 * u.z() * u.x() * u.x();
      points.row(i) = radius * u.cwiseProduct(Vector3(1, 1.4, 0.8)).transpose();
      points.row(i + 1) = points.row(i) * Vector3(-1, 1, 1).asDiagonal();
    }
    const Result result = detect(points, {.method = "perpendicular"});
    EXPECT_GT(result.score, 0.9) << count;
    EXPECT_LE(result.surface_points.col(0).cwiseAbs().maxCoeff(), 1e-3) << count;
  }
}

// Twelve points at random hold no height: the solved ones are so steep that the feet on them were
// NaN. Found by fuzzing.
TEST(Perpendicular, BearsASteepSpline) {
  Points points(12, 3);
  points << -6.944245292482454, -2.97417707133536, 66.10364771484716, -84.8176960560077,
      81.76012292998904, -94.3211490402176, 12.195556954245944, 26.411981951321707,
      -53.04008923120953, -76.91099779325974, -58.73617636215152, -68.86299690785202,
      -0.5556396911590822, 0.5880340477188994, 33.73899068075197, 87.02004147268548,
      59.325640177939796, -72.91906039522162, 88.87303496515612, 80.26999067413657,
      5.126531617953223, 98.64329298189342, 19.14236651871, -52.9155698115992, -3.189647490587899,
      -87.57771803500715, -42.6915307661216, -60.30880549435862, 12.24706208147297,
      -15.61323741629057, 61.78740706083816, 7.454396850532263, -99.07376655814566,
      39.473841223237805, 96.21273580623028, 67.18400658662182;
  for (const char* method : {"perpendicular", "quadric"}) {
    const Result result = detect(points, {.method = method});
    EXPECT_TRUE(result.surface_points.allFinite()) << method;
  }
}

TEST(Perpendicular, FitsACylinderToIt) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces s = surfaces_around(seed, roof_tile, 0.25, 0.4);
    const Result result = detect(s.points, {.method = "cylinder"});
    ASSERT_TRUE(result.mirror) << seed;
    const auto& found = dynamic_cast<const Cylinder&>(*result.mirror);
    EXPECT_NEAR(found.radius(), 2, 1e-6) << seed;
    EXPECT_NEAR(found.axis().cross(s.rotation * Vector3::UnitY()).norm(), 0, 1e-6) << seed;
  }
}

TEST(Perpendicular, FitsAQuadricToIt) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces s = surfaces_around(seed, roof_tile, 0.25, 0.4);
    const Result result = detect(s.points, {.method = "quadric"});
    ASSERT_TRUE(result.mirror) << seed;
    const Cylinder truth(s.shift, s.rotation * Vector3::UnitY(), 2);
    const Points feet = result.mirror->project(s.points);
    for (Index i = 0; i < feet.rows(); ++i)
      EXPECT_NEAR(truth.signed_distance(Vector3(feet.row(i))), 0, 1e-5 * diagonal(s.points));
  }
}

// A bumpy closed surface without a mirror but x = 0, where each side has points of its own; bent.
Points bent_object(std::uint64_t seed, const Cylinder& cylinder) {
  RandomCloud random(seed);
  constexpr Index n = 1500;
  Points straight(2 * n, 3);
  const double phase = random.uniform(0, 6);
  for (Index i = 0; i < 2 * n; ++i) {
    Vector3 u = random.direction();
    u.x() = std::abs(u.x());
    const double radius =
        1 + 0.2 * std::sin(3 * u.y() + phase) + 0.3 * u.y() + 0.25 * u.z() * std::cos(2 * u.y());
    straight.row(i) =
        (radius * Vector3((i % 2 ? 1 : -1) * 0.6 * u.x(), u.y(), 1.5 * u.z())).transpose();
  }
  Points bent(2 * n, 3);
  for (Index i = 0; i < 2 * n; ++i) {
    const double angle = straight(i, 2) / cylinder.radius(), r = cylinder.radius() + straight(i, 0);
    bent.row(i) << r * std::cos(angle) - cylinder.radius(), straight(i, 1), r * std::sin(angle);
  }
  return bent;
}

// Another plane of the body becomes nearly a cylinder, too, and may score as much.
TEST(CylinderMethod, FindsTheMirrorOfABentObjectWithoutExactPartners) {
  constexpr double as_good = 0.01;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Cylinder truth({-2.5, 0, 0}, {0, 1, 0}, 2.5);
    const Points points = bent_object(seed, truth);
    const Matrix3 rotation = RandomCloud(seed + 100).rotation();
    const Points posed = points * rotation.transpose();
    Result best = detect(posed, {.method = "cylinder"});
    ASSERT_TRUE(best.mirror) << seed;
    const double least = best.score - as_good;
    std::vector<Result> all = std::move(best.candidates);
    all.push_back(std::move(best));
    double nearest = diagonal(points);
    for (const Result& result : all) {
      if (result.score < least) continue;
      const Points feet = Points(result.mirror->project(posed) * rotation);
      double squared = 0;
      for (Index i = 0; i < feet.rows(); ++i)
        squared += std::pow(truth.signed_distance(Vector3(feet.row(i))), 2);
      nearest = std::min(nearest, std::sqrt(squared / static_cast<double>(feet.rows())));
    }
    EXPECT_LT(nearest, 0.005 * diagonal(points)) << seed;
  }
}

TEST(Auto, PrefersTheCylinderForTheBent) {
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    const Result bent = detect(bent_object(seed, Cylinder({-2.5, 0, 0}, {0, 1, 0}, 2.5)));
    ASSERT_TRUE(bent.mirror) << seed;
    // Another plane of the body, across the one that was bent, may still be a mirror.
    if (const auto* plane = dynamic_cast<const Plane*>(bent.mirror.get()))
      EXPECT_LT(std::abs(plane->normal().x()), 0.3) << seed << ' ' << bent.reason();
    else
      EXPECT_EQ(bent.mirror->kind(), "cylinder") << seed << ' ' << bent.reason();
    EXPECT_EQ(bent.verdict(), "found") << seed;
  }
}

// Bends of a hundredth of the diagonal, which a plane maps half: points of a bumpy body drawn apart
// on both sides.
TEST(Auto, SeesHowLittleAPlaneIsBent) {
  constexpr Index count = 4000;
  const auto radius = [](const Vector3& u) {
    return 0.6 + 0.12 * std::sin(4 * u.y() + 1) + 0.1 * std::cos(3 * u.z()) +
           0.1 * u.x() * u.x() * std::sin(5 * u.z());
  };
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    RandomCloud random(seed);
    Points straight = random.sphere(count);
    for (auto u : straight.rowwise()) u *= radius(u.transpose());
    const double sag = 0.01 * diagonal(straight), bend_radius = 0.7 * 0.7 / (2 * sag);
    const Cylinder cylinder({-bend_radius, 0, 0}, {0, 0, 1}, bend_radius);
    const Sphere sphere({-bend_radius, 0, 0}, bend_radius);
    for (const Mirror* truth :
         {static_cast<const Mirror*>(&cylinder), static_cast<const Mirror*>(&sphere)}) {
      const Points bent = bend(straight, *truth, Bend::Restore);
      const Result result = detect(bent);
      ASSERT_TRUE(result.mirror) << seed;
      EXPECT_EQ(result.mirror->kind(), truth->kind()) << seed << ' ' << result.reason();
      const Points off = result.mirror->reflect(bent) - truth->reflect(bent);
      EXPECT_LT(off.rowwise().norm().mean(), 0.002 * diagonal(bent)) << seed;
    }
  }
}

TEST(Bend, StraightensABentShapeAndBendsItBack) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces s = surfaces_around(seed, roof_tile, 0.25, 0.4);
    Cylinder cylinder(s.shift, s.rotation * Vector3::UnitY(), 2);
    cylinder.set_footprint(std::make_shared<Points>(s.points));
    const Points straight = bend(s.points, cylinder);
    const Plane plane = straight_mirror(cylinder);
    for (Index i = 0; i < straight.rows(); i += 2) {
      const Vector3 one = straight.row(i), other = straight.row(i + 1);
      EXPECT_NEAR((plane.reflect(one) - other).norm(), 0, 1e-12);
    }
    EXPECT_NEAR((bend(straight, cylinder, Bend::Restore) - s.points).rowwise().norm().maxCoeff(), 0,
                1e-12);
  }
}

TEST(Bend, StraightensOverAnyMirror) {
  Sphere sphere({0, 0, -2}, 2.5);
  const Points box = 0.5 * RandomCloud(3).box(200);
  sphere.set_footprint(std::make_shared<Points>(box));
  const Points straight = bend(box, sphere), images = bend(sphere.reflect(box), sphere);
  const Plane plane = straight_mirror(sphere);
  EXPECT_NEAR((plane.reflect(straight) - images).rowwise().norm().maxCoeff(), 0, 1e-9);
  EXPECT_NEAR((bend(straight, sphere, Bend::Restore) - box).rowwise().norm().maxCoeff(), 0, 1e-6);
}

TEST(Bend, IsTheSameWhereverTheObjectLiesAndInAnyUnit) {
  const Sphere sphere({0, 0, -2}, 2.5);
  const Points box = 0.5 * RandomCloud(3).box(200), straight = bend(box, sphere);
  for (const double unit : {1e-12, 1.0, 1e12})
    for (const double away : {0.0, 1e3, 5e6}) {
      const Vector3 shift = unit * away * Vector3(1, -1, 0.5);
      const auto moved = [&](const Points& points) -> Points {
        return (unit * points).rowwise() + shift.transpose();
      };
      const std::unique_ptr<Mirror> there = sphere.transformed(unit, Matrix3::Identity(), shift);
      there->set_footprint(std::make_shared<Points>(moved(box)));
      const double rounding = 1e-8 * unit + 1e-14 * shift.norm();
      const Points bent = bend(moved(box), *there);
      EXPECT_LE((bent - moved(straight)).rowwise().norm().maxCoeff(), rounding) << away;
      const Points back = bend(bent, *there, Bend::Restore);
      EXPECT_LE((back - moved(box)).rowwise().norm().maxCoeff(), 1e-6 * unit + rounding) << away;
    }
}

// A mirror that bends twice, with random points about it.
struct BentSolid {
  Points points, images;
};

// Two bodies on either side, joined by a bar: along a normal of the mirror there are many surfaces.
BentSolid dumbbell(RandomCloud& random, bool twisted) {
  constexpr Index count = 4000;
  BentSolid solid{Points(count, 3), Points(count, 3)};
  const Matrix3 rotation = random.rotation();
  const Vector3 shift = 5 * random.in_box();
  for (Index i = 0; i < count; ++i) {
    Vector3 x = random.direction();  // u, v and the distance from the mirror
    if (i % 4 == 0)
      x = Vector3(0.2 * x.x() + 0.3, 0.12 * x.y(), 0.6 * x.z());
    else
      x = Vector3(0.8 * x.x() + 0.2 * x.y() * x.y(), 0.35 * x.y() + 0.1 * std::sin(4 * x.x()),
                  0.3 * x.z() * (1 + 0.4 * std::sin(5 * x.x() + 1)));
    // The sides are drawn each by itself.
    const double distance = i % 2 ? std::abs(x.z()) : -std::abs(x.z());
    const double height = twisted ? 0.4 * x.x() * x.y() : 0.15 * std::sin(2.5 * x.x());
    const Vector3 upwards = twisted ? Vector3(-0.4 * x.y(), -0.4 * x.x(), 1)
                                    : Vector3(-0.375 * std::cos(2.5 * x.x()), 0, 1);
    const Vector3 foot(x.x(), x.y(), height), normal = upwards.normalized();
    solid.points.row(i) = (rotation * (foot + distance * normal) + shift).transpose();
    solid.images.row(i) = (rotation * (foot - distance * normal) + shift).transpose();
  }
  return solid;
}

// How far off the images are, sorted, over the diagonal.
std::vector<double> image_errors(const BentSolid& solid, const Mirror& mirror) {
  std::vector<double> errors;
  const Points images = mirror.reflect(solid.points);
  for (Index i = 0; i < images.rows(); ++i) {
    const double error = (images.row(i) - solid.images.row(i)).norm() / diagonal(solid.points);
    errors.push_back(std::isnan(error) ? INFINITY : error);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(Perpendicular, FindsTheBentMiddleOfASolidWithoutExactPartners) {
  for (const bool twisted : {false, true})
    for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
      RandomCloud random(seed);
      const BentSolid solid = dumbbell(random, twisted);
      const Result result = detect(solid.points, {.method = "perpendicular"});
      ASSERT_TRUE(result.mirror) << seed;
      const std::vector<double> errors = image_errors(solid, *result.mirror);
      EXPECT_LT(errors[errors.size() / 2], 0.004) << seed << ' ' << twisted;
      EXPECT_LT(errors[errors.size() * 9 / 10], 0.02) << seed << ' ' << twisted;
    }
}

// Every smooth closed body has a bent middle: that it has one says nothing.
// The middle of one of so many is smooth by chance.
TEST(Perpendicular, ScoresTheMiddleOfARandomBodyLow) {
  std::vector<std::string> found;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    std::vector<Vector3> bumps;
    for (int k = 0; k < 6; ++k) bumps.push_back(random.direction());
    Points points(3000, 3);
    for (Index i = 0; i < points.rows(); ++i) {
      const Vector3 x = random.direction();
      double radius = 1;
      for (std::size_t k = 0; k < bumps.size(); ++k)
        radius += (k % 2 ? 0.5 : -0.3) * std::exp(4 * (x.dot(bumps[k]) - 1));
      points.row(i) = radius * Vector3(x.x(), 0.7 * x.y(), 1.4 * x.z()).transpose();
    }
    for (const char* method : {"perpendicular", "fixed_direction"}) {
      const Result result = detect(points, {.method = method});
      if (result.verdict() != "none") found.push_back(result.reason());
    }
  }
  EXPECT_LE(found.size(), 1) << testing::PrintToString(found);
}

}  // namespace
}  // namespace symsurf::perpendicular_tests
