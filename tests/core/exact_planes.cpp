#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "random_cloud.h"
#include "test_mesh.h"

namespace symsurf::exact_planes_tests {
namespace {

Points turned(const Points& points, RandomCloud& random) {
  return (points * random.rotation().transpose()).rowwise() + random.in_box().transpose();
}

// The points of a lattice on the surface of a box.
Points box_surface(int x, int y, int z) {
  std::vector<Vector3> rows;
  for (int i = 0; i <= x; ++i)
    for (int j = 0; j <= y; ++j)
      for (int k = 0; k <= z; ++k)
        if (i % x == 0 || j % y == 0 || k % z == 0) rows.emplace_back(i, j, k);
  Points points(static_cast<Index>(rows.size()), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = rows[i].transpose();
  return points;
}

// Rings of teeth: `count` planes through the axis, and one across it.
Points gear(int count) {
  constexpr int steps = 6, layers = 4;
  Points points(2 * count * steps * layers, 3);
  for (Index i = 0; i < points.rows(); ++i) {
    const auto layer = static_cast<double>(i % layers);
    const Index step = i / layers;
    const double angle = std::numbers::pi * (static_cast<double>(step) + 0.5) / (count * steps);
    const double radius = step / steps % 2 ? 1 : 1.2;
    points.row(i) << radius * std::cos(angle), radius * std::sin(angle), 0.1 * layer;
  }
  return points;
}

void expect_planes(const Points& points, std::size_t count) {
  const Result result = detect(points, {.method = "plane"});
  EXPECT_EQ(result.score, 1);
  ASSERT_EQ(result.candidates.size() + 1, count);
  for (const Result& candidate : result.candidates) EXPECT_EQ(candidate.score, 1);
  for (const Result& candidate : result.candidates) {
    const Result matched = detect(candidate.mirror->reflect(points), {.method = "plane"});
    EXPECT_EQ(matched.score, 1);
  }
}

TEST(ExactPlanes, AreAllFound) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    expect_planes(turned(box_surface(8, 12, 16), random), 3);
    expect_planes(turned(box_surface(8, 8, 12), random), 5);
    expect_planes(turned(box_surface(8, 8, 8), random), 9);
    expect_planes(turned(gear(12), random), 13);
  }
}

// A hundred points or a thousand without any surface.
TEST(ExactPlanes, AreFoundOfRandomPoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const Index count : {10, 50, 150, 500}) {
      RandomCloud random(seed);
      Points points(2 * count, 3);
      points.topRows(count) = random.box(count);
      points.col(0).head(count).array() += 0.3;
      points.bottomRows(count) = points.topRows(count);
      points.col(0).tail(count) *= -1;
      const Result result = detect(turned(points, random), {.method = "auto"});
      EXPECT_EQ(result.method, "plane") << seed << ' ' << count;
      EXPECT_EQ(result.score, 1) << seed << ' ' << count;
      EXPECT_EQ(result.pairs.rows(), 2 * count) << seed << ' ' << count;
      EXPECT_LT(result.residuals.maxCoeff(), 1e-12) << seed << ' ' << count;
      EXPECT_EQ(result.verdict(), "found");
    }
}

// How often a file repeats some of the points does not move what maps them.
TEST(ExactPlanes, AreThoseOfTheDistinctPoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = turned(box_surface(8, 12, 16), random);
    Points repeated(points.rows() + 20, 3);
    repeated << points, points.topRows(5).replicate(4, 1);
    expect_planes(repeated, 3);
  }
}

// The plane of a flat cloud moves nothing.
TEST(ExactPlanes, LeaveOutThePlaneOfAFlatCloud) {
  Points points = box_surface(8, 12, 2);
  points.col(2).setZero();
  const Result result = detect(points, {.method = "plane"});
  EXPECT_EQ(result.score, 1);
  EXPECT_LT(std::abs(dynamic_cast<const Plane&>(*result.mirror).normal().z()), 1e-12);
  for (const Result& other : result.candidates)
    EXPECT_LT(std::abs(dynamic_cast<const Plane&>(*other.mirror).normal().z()), 1e-9);
}

// To the side of (4, 2, 1), whatever the order of the points.
TEST(ExactPlanes, HaveANormalOfDefinedSign) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = turned(box_surface(8, 12, 16), random);
    const Result forward = detect(points, {.method = "plane"});
    const Result backward = detect(points.colwise().reverse().eval(), {.method = "plane"});
    const Vector3 normal = dynamic_cast<const Plane&>(*forward.mirror).normal();
    EXPECT_GT(normal.dot(Vector3(4, 2, 1)), 0) << seed;
    EXPECT_LT((normal - dynamic_cast<const Plane&>(*backward.mirror).normal()).norm(), 1e-9)
        << seed;
  }
}

// Fans on the caps of a prism mirror no triangle onto another but over one plane.
TEST(ExactPlanes, OfAPrismAreFoundWhateverItsTriangles) {
  for (const int sides : {3, 5, 6, 8}) {
    Points points(2 * sides, 3);
    Triangles faces(4 * sides - 4, 3);
    Index face = 0;
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      points.row(k) << std::cos(angle), std::sin(angle), 0;
      points.row(sides + k) << std::cos(angle), std::sin(angle), 1.3;
      const int next = (k + 1) % sides;
      faces.row(face++) << k, next, sides + next;
      faces.row(face++) << k, sides + next, sides + k;
      if (k == 0 || next == 0) continue;
      faces.row(face++) << 0, next, k;
      faces.row(face++) << sides, sides + k, sides + next;
    }
    const Result result = detect(points, {.method = "plane", .faces = faces});
    EXPECT_EQ(result.candidates.size() + 1, sides + 1) << sides;
    EXPECT_EQ(result.pairs.rows(), 2 * sides) << sides;
    EXPECT_LT(result.residuals.maxCoeff(), 1e-12) << sides;
    EXPECT_EQ(result.score, 1) << sides;
    for (const Result& candidate : result.candidates) EXPECT_EQ(candidate.score, 1) << sides;
  }
}

// A plate of square cells, five of them with a hole.
TestMesh plate(double thickness) {
  TestMesh mesh;
  constexpr Index around = 24;
  for (int column = -2; column <= 2; ++column)
    for (const double z : {0.0, thickness}) {
      Points points(4 + around, 3);
      Triangles faces(around + 4, 3);
      for (Index q = 0; q < 4; ++q)
        points.row(q) << column + (q == 0 || q == 3 ? 0.5 : -0.5), q < 2 ? 0.5 : -0.5, z;
      for (Index k = 0; k < around; ++k) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(k) / around;
        points.row(4 + k) << column + 0.3 * std::cos(turn), 0.3 * std::sin(turn), z;
        faces.row(k) << 4 * k / around, 4 + k, 4 + (k + 1) % around;
      }
      for (Index q = 0; q < 4; ++q)
        faces.row(around + q) << q, (q + 1) % 4, 4 + ((q + 1) * around / 4) % around;
      mesh.add(points, faces);
    }
  return mesh;
}

TEST(ExactPlanes, OfAPlateWithHolesAreAllFound) {
  for (const double thickness : {0.02, 0.1, 0.5}) {
    TestMesh mesh = plate(thickness);
    mesh.move(RandomCloud(3).rotation(), {1, 2, 3});
    const Result result = detected(mesh, "plane");
    EXPECT_EQ(result.score, 1) << thickness;
    std::size_t exact = 1;
    for (const Result& candidate : result.candidates) exact += candidate.score == 1;
    EXPECT_EQ(exact, 3u) << thickness;
    const Result one = detect(
        mesh.vertices,
        {.method = "plane", .parameters = {{"max_candidates", Index{1}}}, .faces = mesh.faces});
    EXPECT_EQ(one.candidates.size(), 1u);
  }
}

// The vertices of a box are mirrored by all of its planes, what is left of its faces by two. The
// third plane is a candidate that scores less.
TEST(ExactPlanes, ScoreLessWhereFacesAreMissing) {
  TestMesh mesh;
  mesh.add_box({-1, -2, -3}, {1, 2, 3});
  mesh.faces = mesh.faces.bottomRows(10).eval();  // the side of low z is open
  const Result result = detected(mesh, "plane");
  EXPECT_EQ(result.score, 1);
  ASSERT_GE(result.candidates.size(), 2u);
  EXPECT_EQ(result.candidates[0].score, 1);
  EXPECT_LT(result.candidates[1].score, 1);
  EXPECT_TRUE(is_plane(result.candidates[1], Vector3::UnitZ(), Vector3::Zero()));
}

// An ellipsoid whose vertices mirror over one of its planes alone.
TEST(ExactPlanes, HaveTheOthersForCandidates) {
  constexpr int rings = 40, sides = 61;
  Points points(rings * sides + 2, 3);
  points.bottomRows(2) << 1, 0, 0, -1, 0, 0;
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < rings * sides; ++i) {
    const double down = std::numbers::pi * static_cast<double>(i / sides + 1) / (rings + 1);
    const double turn = 2 * std::numbers::pi * (static_cast<double>(i % sides) + 0.3) / sides;
    points.row(i) << std::cos(down), std::sin(down) * std::cos(turn),
        std::sin(down) * std::sin(turn);
    const Index next = i % sides + 1 < sides ? i + 1 : i + 1 - sides;
    if (i < sides) faces.push_back({rings * sides, i, next});
    if (i >= (rings - 1) * sides) {
      faces.push_back({rings * sides + 1, next, i});
      continue;
    }
    faces.push_back({i, i + sides, next});
    faces.push_back({next, i + sides, next + sides});
  }
  TestMesh mesh;
  mesh.add(points * Vector3(1, 0.7, 0.4).asDiagonal(), rows_of(faces));
  const Result result = detected(mesh, "plane");
  EXPECT_EQ(result.score, 1);
  EXPECT_TRUE(is_plane(result, Vector3::UnitX(), Vector3::Zero()));
  for (const Vector3& axis : {Vector3(Vector3::UnitY()), Vector3(Vector3::UnitZ())})
    EXPECT_TRUE(std::any_of(
        result.candidates.begin(), result.candidates.end(), [&](const Result& candidate) {
          return candidate.score > 0.95 && is_plane(candidate, axis, Vector3::Zero());
        }));
}

}  // namespace
}  // namespace symsurf::exact_planes_tests
