#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "random_cloud.h"
#include "symmetries/point_group/point_group.h"

namespace symsurf::symmetries_tests {
namespace {

struct Expected {
  std::string name;
  std::size_t elements, planes, axes;
};

void expect_group(const PointGroup& group, const Expected& expected) {
  EXPECT_EQ(group.name, expected.name);
  EXPECT_EQ(group.elements.size(), expected.elements) << expected.name;
  EXPECT_EQ(group.plane_normals().size(), expected.planes) << expected.name;
  EXPECT_EQ(group.axes().size(), expected.axes) << expected.name;
}

// By the tables of any book on crystallography.
TEST(PointGroup, HasTheElementsOfItsName) {
  expect_group(axial_group(1, {}), {"C1", 1, 0, 0});
  expect_group(reflection_group(), {"Cs", 2, 1, 0});
  expect_group(inversion_group(), {"Ci", 2, 0, 0});
  expect_group(axial_group(5, {}), {"C5", 5, 0, 1});
  expect_group(axial_group(4, {.vertical = true}), {"C4v", 8, 4, 1});
  expect_group(axial_group(3, {.across = true}), {"C3h", 6, 1, 1});
  expect_group(axial_group(2, {.rotary = true}), {"S4", 4, 0, 1});
  expect_group(axial_group(3, {.twofold = true}), {"D3", 6, 0, 4});
  expect_group(axial_group(6, {.across = true, .vertical = true}), {"D6h", 24, 7, 7});
  expect_group(axial_group(2, {.rotary = true, .vertical = true}), {"D2d", 8, 2, 3});
  expect_group(polyhedral_group(3, false, false), {"T", 12, 0, 7});
  expect_group(polyhedral_group(3, false, true), {"Td", 24, 6, 7});
  expect_group(polyhedral_group(3, true, false), {"Th", 24, 3, 7});
  expect_group(polyhedral_group(4, false, false), {"O", 24, 0, 13});
  expect_group(polyhedral_group(4, true, true), {"Oh", 48, 9, 13});
  expect_group(polyhedral_group(5, false, false), {"I", 60, 0, 31});
  expect_group(polyhedral_group(5, true, true), {"Ih", 120, 15, 31});
}

TEST(Symmetries, OfABoxAreThoseOfItsPlanes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    std::vector<Vector3> rows;
    for (int i = 0; i <= 16; ++i)
      for (int j = 0; j <= 24; ++j)
        for (int k = 0; k <= 32; ++k)
          if (i % 16 == 0 || j % 24 == 0 || k % 32 == 0) rows.emplace_back(i - 8, j - 12, k - 16);
    const Matrix3 rotation = random.rotation();
    const Vector3 shift = random.in_box();
    Points points(static_cast<Index>(rows.size()), 3);
    for (Index i = 0; i < points.rows(); ++i)
      points.row(i) = (rotation * rows[i] + shift).transpose();
    const Symmetries found = find_symmetries(points);
    EXPECT_EQ(found.group, "D2h");
    EXPECT_TRUE(found.inversion);
    EXPECT_EQ(found.elements.size(), 8u);
    EXPECT_LE(found.score, 1);
    EXPECT_LT((found.centre - shift).norm(), 1e-3);
    ASSERT_EQ(found.planes.size(), 3u);
    for (const Plane& plane : found.planes)
      EXPECT_GT((rotation.transpose() * plane.normal()).cwiseAbs().maxCoeff(), 1 - 1e-6);
  }
}

// Some points in general position and all their images, turned, shifted and shuffled.
Points orbits_of(const PointGroup& group, Index count, RandomCloud& random) {
  const Matrix3 rotation = random.rotation();
  const Vector3 shift = 3 * random.in_box();
  const Points seeds = random.box(count);
  std::vector<Vector3> rows;
  for (const Vector3 seed : seeds.rowwise())
    for (const Matrix3& element : group.elements)
      rows.insert(rows.begin() + random.below(static_cast<Index>(rows.size()) + 1),
                  rotation * (element * seed) + shift);
  Points points(static_cast<Index>(rows.size()), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = rows[i].transpose();
  return points;
}

TEST(Symmetries, OfSmallSetsAreExact) {
  std::vector<PointGroup> groups{axial_group(1, {}), reflection_group(), inversion_group()};
  for (const Index order : {2, 3, 4, 5, 6, 7, 12})
    for (const AxialElements& has : std::vector<AxialElements>{{},
                                                               {.across = true},
                                                               {.rotary = true},
                                                               {.vertical = true},
                                                               {.twofold = true},
                                                               {.across = true, .vertical = true},
                                                               {.rotary = true, .vertical = true}})
      groups.push_back(axial_group(order, has));
  for (const Index highest : {3, 4, 5})
    for (const bool inversion : {false, true})
      groups.push_back(polyhedral_group(highest, inversion, inversion));
  groups.push_back(polyhedral_group(3, false, true));
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    for (const PointGroup& group : groups)
      for (const Index count : {3, 7}) {
        RandomCloud random(seed);
        const Points points =
            orbits_of(group, std::max<Index>(count, group.name == "C1" ? 9 : 3), random);
        const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
        const Symmetries found = find_symmetries(points);
        EXPECT_EQ(found.group, group.name) << seed << ' ' << points.rows();
        EXPECT_EQ(found.elements.size(), group.elements.size()) << group.name;
        EXPECT_EQ(found.planes.size(), group.plane_normals().size()) << group.name;
        EXPECT_EQ(found.axes.size(), group.axes().size()) << group.name;
        EXPECT_EQ(found.score, 1);
        for (const Matrix4& element : found.elements)
          for (const Vector3 x : points.rowwise()) {
            const Vector3 image = (element * x.homogeneous()).head<3>();
            EXPECT_LT((points.rowwise() - image.transpose()).rowwise().norm().minCoeff(),
                      1e-9 * size)
                << group.name;
          }
      }
}

// Eight corners, in single precision; the atoms of a flat molecule, whose plane is a mirror.
TEST(Symmetries, OfMolecules) {
  RandomCloud random(1);
  const Matrix3 rotation = random.rotation();
  Points cube(8, 3), ring(12, 3);
  for (Index i = 0; i < 8; ++i) cube.row(i) << (i & 1 ? 1 : -1), (i & 2 ? 1 : -1), (i & 4 ? 1 : -1);
  for (Index i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi / 3 * static_cast<double>(i % 6);
    ring.row(i) = (i < 6 ? 1.39 : 2.48) * Vector3(std::cos(angle), std::sin(angle), 0).transpose();
  }
  cube = (cube * rotation.transpose()).cast<float>().cast<double>().eval();
  ring = (ring * rotation.transpose()).cast<float>().cast<double>().eval();
  EXPECT_EQ(find_symmetries(cube).group, "Oh");
  EXPECT_EQ(find_symmetries(ring).group, "D6h");
}

// Drawn evenly over a box, about its middle.
Points on_box(const Vector3& size, Index count, RandomCloud& random) {
  const Vector3 areas(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  Points points = random.box(count);
  for (Index i = 0; i < count; ++i) {
    double at = random.uniform(0, areas.sum());
    int axis = 0;
    while (axis < 2 && at >= areas[axis]) at -= areas[axis++];
    points(i, axis) = points(i, axis) < 0 ? -1 : 1;
    points.row(i) = points.row(i).cwiseProduct(size.transpose() / 2);
  }
  return points;
}

// Drawn evenly over a cone or a part of one about z.
Points on_cone(double from, double to, double from_radius, double to_radius, Index count,
               RandomCloud& random) {
  const double widest = std::max(from_radius, to_radius);
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    double share = 0, radius = 0;
    do {
      share = random.uniform(0, 1);
      radius = from_radius + share * (to_radius - from_radius);
    } while (random.uniform(0, widest) > radius);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    points.row(i) << radius * std::cos(angle), radius * std::sin(angle), from + share * (to - from);
  }
  return points;
}

Points joined(const std::vector<Points>& parts) {
  Index count = 0;
  for (const Points& part : parts) count += part.rows();
  Points all(count, 3);
  count = 0;
  for (const Points& part : parts) {
    all.middleRows(count, part.rows()) = part;
    count += part.rows();
  }
  return all;
}

// Slanted blades and a hub alone have half turns across the axis. A nose on one side of the hub, a
// twentieth of the area, has none.
TEST(Symmetries, HoldForSmallPartsToo) {
  for (const Index blades : {3, 4, 5}) {
    RandomCloud random(static_cast<std::uint64_t>(blades));
    std::vector<Points> parts;
    for (Index k = 0; k < blades; ++k) {
      const double angle =
          2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(blades);
      const Points blade =
          on_box({90, 22, 4}, 3000, random) * turn(Vector3::UnitX(), 0.6).transpose();
      parts.push_back((blade.rowwise() + Eigen::RowVector3d(60, 0, 0)) *
                      turn(Vector3::UnitZ(), angle).transpose());
    }
    parts.push_back(on_cone(-12, 12, 16, 16, 1500, random));
    const Points hub = joined(parts);
    parts.push_back(on_cone(12, 30, 16, 2, 150 * blades + 300, random));
    const Matrix3 rotation = random.rotation();
    const std::string turns = std::to_string(blades);
    EXPECT_EQ(find_symmetries(Points(hub * rotation)).group, "D" + turns);
    EXPECT_EQ(find_symmetries(Points(joined(parts) * rotation)).group, "C" + turns);
  }
}

// Leaning plates at all images of one: no plane, and no principal axis, shows where the axes are.
TEST(Symmetries, OfTurnsAboutSeveralAxes) {
  constexpr int most_wrong = 1;  // of 12: some plates nearly mirror each other
  int wrong = 0;
  for (const Index highest : {3, 4, 5})
    for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
      RandomCloud random(seed);
      const PointGroup group = polyhedral_group(highest, false, false);
      const double size = 2.4 / std::sqrt(static_cast<double>(group.elements.size()));
      const Points plate = (on_box(size * Vector3(1, 0.4, 0.15), 150, random) *
                            turn(Vector3(1, 2, 0.5).normalized(), 0.8).transpose())
                               .rowwise() +
                           Eigen::RowVector3d(0.35, 0.16, 0.92);
      std::vector<Points> parts;
      for (const Matrix3& element : group.elements) parts.emplace_back(plate * element.transpose());
      const Points body = joined(parts) * random.rotation();
      wrong += find_symmetries(body).group != group.name;
    }
  EXPECT_LE(wrong, most_wrong);
}

// A set whose points mirror each other, then one of them moved.
TEST(Symmetries, SayHowFarTheyAreOff) {
  RandomCloud random(3);
  const Points half = random.box(300);
  Points points(600, 3);
  points << half, half * Vector3(-1, 1, 1).asDiagonal();
  points *= 10;
  const Symmetries exact = find_symmetries(points);
  ASSERT_EQ(exact.group, "Cs");
  ASSERT_EQ(exact.max_deviations.size(), 2u);
  EXPECT_EQ(exact.max_deviations[0], 0);
  EXPECT_LT(exact.max_deviations[1], 1e-12);
  Points moved = points;
  moved.row(0) += Eigen::RowVector3d(0, 1e-5, 0);  // within the rounding of single precision
  const Symmetries found = find_symmetries(moved, {.tolerance = 1e-4});
  ASSERT_EQ(found.group, "Cs");
  EXPECT_NEAR(found.max_deviations[1], 1e-5, 1e-7);
  EXPECT_EQ(find_symmetries(moved, {.tolerance = 1e-6}).group, "C1");
  EXPECT_THROW(find_symmetries(points, {.tolerance = -1}), InvalidParameter);
}

// A box, one corner of which is moved by a length along the diagonal.
TEST(Symmetries, HoldFromATolerance) {
  constexpr double moved = 0.05;
  RandomCloud random(2);
  const Matrix3 rotation = random.rotation();
  Points corners(8, 3);
  for (Index i = 0; i < 8; ++i)
    corners.row(i) << (i & 1 ? 1 : -1), (i & 2 ? 1.4 : -1.4), (i & 4 ? 2 : -2);
  corners.row(7) += Eigen::RowVector3d::Constant(moved / std::sqrt(3));
  corners *= rotation.transpose();
  Triangles faces(12, 3);
  faces << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
      1, 3, 5, 3, 7, 5;
  EXPECT_EQ(find_symmetries(corners, {.faces = faces}).group, "C1");
  const Symmetries found = find_symmetries(corners, {.faces = faces, .tolerance = moved});
  ASSERT_EQ(found.group, "D2h");
  EXPECT_LE(found.max_deviation(), moved);
  EXPECT_LE(found.quantile_deviation(), found.max_deviation());
  ASSERT_GE(found.by_tolerance.size(), 2u);
  EXPECT_EQ(found.by_tolerance.front().group, "C1");
  for (std::size_t k = 1; k < found.by_tolerance.size(); ++k)
    EXPECT_LT(found.by_tolerance[k - 1].max_deviation(), found.by_tolerance[k].max_deviation());
  EXPECT_EQ(find_symmetries(corners, {.faces = faces, .tolerance_rule = "object"}).group, "D2h");
  EXPECT_EQ(find_symmetries(corners, {.faces = faces, .tolerance_rule = "given"}).group, "C1");
  EXPECT_THROW(find_symmetries(corners, {.faces = faces, .tolerance_rule = "mine"}),
               InvalidParameter);
  EXPECT_THROW(find_symmetries(corners, {.tolerance = 1, .tolerance_rule = "bop"}),
               InvalidParameter);
}

TEST(Symmetries, RefusesScoresThatThereAreNot) {
  const Points points = RandomCloud(0).box(100);
  EXPECT_THROW(find_symmetries(points, {.minimum_score = -0.1}), InvalidParameter);
  EXPECT_THROW(find_symmetries(Points(points.topRows(2))), InvalidInput);
}

}  // namespace
}  // namespace symsurf::symmetries_tests
