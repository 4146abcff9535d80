#include "preprocess/surface_samples.h"

#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "expect_error.h"
#include "random_cloud.h"
#include "registry.h"
#include "test_mesh.h"

namespace symsurf::surface_samples_tests {
namespace {

Points samples_of(const TestMesh& mesh) {
  Cloud cloud = checked_cloud(mesh.vertices, {}, 1, {});
  cloud.faces = mesh.faces;
  SurfaceSamples samples;
  samples.apply(cloud, {});
  return cloud.points.matrix();
}

// A chair: a seat, a back, four legs; x = 0.5 is its only mirror.
TestMesh chair(unsigned flips) {
  TestMesh mesh;
  mesh.add_box({0, 0, 0.45}, {1, 1, 0.5}, flips);
  mesh.add_box({0, 0.95, 0.5}, {1, 1, 1.2}, flips + 1);
  for (const double x : {0.0, 0.93})
    for (const double y : {0.0, 0.93})
      mesh.add_box({x, y, 0}, {x + 0.07, y + 0.07, 0.45}, flips += 5);
  return mesh;
}

// Faces as thin as may be, or a few large ones: each part of the surface gets its share.
TEST(SurfaceSamples, LieEvenlyOnTheSurface) {
  for (const Index slices : {1, 7, 300, 4000}) {
    TestMesh mesh;
    Points corners(2 * (slices + 1), 3);
    Triangles faces(2 * slices, 3);
    for (Index k = 0; k <= slices; ++k) {
      const double x = static_cast<double>(k) / static_cast<double>(slices);
      corners.row(2 * k) << x, 0, 0;
      corners.row(2 * k + 1) << x, 1, 0;
      if (k == slices) continue;
      faces.row(2 * k) << 2 * k, 2 * k + 1, 2 * k + 2;
      faces.row(2 * k + 1) << 2 * k + 1, 2 * k + 2, 2 * k + 3;
    }
    mesh.add(corners, faces);
    mesh.add_box({3, 0, 0}, {4, 1, 0.02});
    const Points points = samples_of(mesh);
    constexpr int cells = 8;
    std::array<double, cells * cells> counts{};
    for (const auto& x : points.rowwise())
      if (x[0] < 2)
        ++counts[static_cast<int>(cells * x[0]) * cells + static_cast<int>(cells * x[1])];
    const double area = 1 + 2 + 4 * 0.02;
    const double mean = static_cast<double>(points.rows()) / area / (cells * cells);
    for (const double count : counts) EXPECT_NEAR(count / mean, 1, 0.25) << slices;
  }
}

void expect_mirrored(const Points& samples, const Plane& plane) {
  const PointTree tree(samples);
  for (const auto& x : samples.rowwise())
    ASSERT_LT(tree.nearest(plane.reflect(Vector3(x.transpose()))).squared_distance, 1e-24);
}

// Whichever diagonals divide the faces.
TEST(SurfaceSamples, OfAMirroredMeshAreMirrored) {
  for (unsigned flips = 0; flips < 4; ++flips) {
    expect_mirrored(samples_of(chair(flips)), Plane(Vector3::UnitX(), -0.5));
    TestMesh box;
    box.add_box({-1, -2, -3}, {1, 2, 3}, 21 * flips);
    const Points samples = samples_of(box);
    for (int axis = 0; axis < 3; ++axis) expect_mirrored(samples, Plane(Vector3::Unit(axis), 0));
  }
}

TEST(SurfaceSamples, LeaveTheirExactMirrorToAllMethodsThatKnowPlanes) {
  TestMesh mesh = chair(0);
  mesh.move(RandomCloud(0).rotation(), {1, 2, 3});
  for (const char* method : {"plane", "quadric", "perpendicular", "fixed_direction"}) {
    const Result result = detected(mesh, method);
    EXPECT_EQ(result.score, 1) << method;
    EXPECT_EQ(std::get<double>(result.statistics.at("exact_share")), 1) << method;
    ASSERT_EQ(result.pairs.rows(), mesh.vertices.rows()) << method;
    EXPECT_LT(result.residuals.maxCoeff(), 1e-9) << method;
  }
}

TEST(SurfaceSamples, FindThePlanesOfABox) {
  for (const unsigned flips : {0u, 13u, 63u}) {
    TestMesh mesh;
    mesh.add_box({-1, -2, -3}, {1, 2, 3}, flips);
    RandomCloud random(flips);
    const Matrix3 turn = random.rotation();
    mesh.move(turn, {5, 6, 7});
    const Result result = detected(mesh, "plane");
    bool is_one = false;
    for (int axis = 0; axis < 3; ++axis)
      is_one = is_one || is_plane(result, turn.col(axis), {5, 6, 7});
    EXPECT_TRUE(is_one) << flips;
    EXPECT_GT(result.score, 0.9) << flips;
    EXPECT_EQ(result.verdict(), "found");
    EXPECT_GT(std::get<Index>(result.statistics.at("surface_samples")), 10000);
    // Pairs are those of the vertices.
    ASSERT_EQ(result.pairs.rows(), 8);
    EXPECT_LT(result.residuals.maxCoeff(), 0.1);
    for (Index row = 0; row < 8; ++row) EXPECT_EQ(result.pairs(row, 0), row);
    EXPECT_EQ(result.surface_points.rows(), 8);
  }
}

TEST(SurfaceSamples, FindThePlaneOfAChair) {
  for (unsigned flips = 0; flips < 4; ++flips)
    for (const char* method : {"plane", "auto"}) {
      TestMesh mesh = chair(flips);
      RandomCloud random(flips);
      const Matrix3 turn = random.rotation();
      mesh.move(turn, random.in_box());
      const Vector3 on = (mesh.vertices.row(0) + mesh.vertices.row(1)) / 2;
      const Result result = detected(mesh, method);
      EXPECT_TRUE(is_plane(result, turn.col(0), on)) << method << flips;
      EXPECT_GT(result.score, 0.9) << method << flips;
      EXPECT_EQ(result.pairs.rows(), mesh.vertices.rows()) << method << flips;
    }
}

TEST(SurfaceSamples, TakeCornersThatNobodyMergedForOne) {
  TestMesh merged = chair(1), soup;
  for (Index f = 0; f < merged.faces.rows(); ++f) {
    Points corners(3, 3);
    for (int c = 0; c < 3; ++c) corners.row(c) = merged.vertices.row(merged.faces(f, c));
    soup.add(corners, (Triangles(1, 3) << 0, 1, 2).finished());
  }
  EXPECT_EQ(samples_of(merged), samples_of(soup));
  EXPECT_EQ(detected(soup, "plane").score, 1);
  // As are faces with two sides.
  TestMesh twice = merged;
  twice.add(Points(0, 3),
            Triangles(merged.faces.rowwise().reverse().array() - merged.vertices.rows()));
  EXPECT_EQ(samples_of(twice), samples_of(merged));
}

// A dented ball, its diagonals all one way round.
TestMesh dented_ball(Index rings, Index around) {
  TestMesh mesh;
  Points vertices(rings * around, 3);
  Triangles faces(2 * (rings - 1) * around, 3);
  for (Index i = 0; i < rings; ++i)
    for (Index j = 0; j < around; ++j) {
      const double polar = M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(rings),
                   turn = 2 * M_PI * static_cast<double>(j) / static_cast<double>(around);
      const Vector3 u(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                      std::cos(polar));
      vertices.row(i * around + j) = ((1 + 0.2 * std::sin(3 * u.y() + u.z())) * u).transpose();
      if (i + 1 == rings) continue;
      const Index a = i * around + j, b = i * around + (j + 1) % around;
      faces.row(2 * a) << a, b, a + around;
      faces.row(2 * a + 1) << b, b + around, a + around;
    }
  mesh.add(vertices, faces);
  return mesh;
}

TEST(SurfaceSamples, AreNoneWhereFacesAreFineOrEven) {
  for (const Index rings : {300, 32}) {
    const TestMesh mesh = dented_ball(rings, 2 * rings);
    const Result with = detected(mesh, "plane"),
                 without = detect(mesh.vertices, {.method = "plane"});
    EXPECT_EQ(with.statistics.count("surface_samples"), 0u);
    EXPECT_EQ(with.mirror->numbers(), without.mirror->numbers());
    EXPECT_EQ(with.score, without.score);
    EXPECT_EQ(with.pairs, without.pairs);
  }
  // Even, but few; many, but uneven.
  EXPECT_GT(samples_of(dented_ball(12, 24)).rows(), 15000);
  TestMesh both = dented_ball(32, 64);
  both.add_box({-4, -4, -2}, {4, 4, -1.8});
  EXPECT_GT(samples_of(both).rows(), 15000);
}

TEST(SurfaceSamples, DoNotDependOnPoseAndUnit) {
  const TestMesh mesh = chair(2);
  const Index count = samples_of(mesh).rows();
  for (const double unit : {1e-6, 1e6}) {
    TestMesh other = mesh;
    other.vertices *= unit;
    EXPECT_EQ(samples_of(other).rows(), count);
  }
  TestMesh turned = mesh;
  turned.move(RandomCloud(1).rotation(), {1, 2, 3});
  EXPECT_EQ(samples_of(turned).rows(), count);
}

// A body of thin faces, its samples, and points at random on the same surface say the same.
TEST(SurfaceSamples, ScoreAsPointsAtRandomDo) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    TestMesh mesh;
    const auto add_tube = [&](const Vector3& foot, double radius, double height) {
      constexpr Index around = 90;
      Points rings(2 * around, 3);
      Triangles faces(2 * around, 3);
      for (Index k = 0; k < around; ++k) {
        const double turn = 2 * std::numbers::pi * static_cast<double>(k) / around;
        const Vector3 x = foot + radius * Vector3(std::cos(turn), std::sin(turn), 0);
        rings.row(2 * k) = x.transpose();
        rings.row(2 * k + 1) = (x + height * Vector3::UnitZ()).transpose();
        const Index a = 2 * k, b = 2 * ((k + 1) % around);
        faces.row(2 * k) << a, b, b + 1;
        faces.row(2 * k + 1) << a, b + 1, a + 1;
      }
      mesh.add(rings, faces);
    };
    for (int part = 0; part < 3; ++part) {
      const Vector3 foot(random.uniform(0.4, 0.9), random.uniform(-1, 1), random.uniform(-1, 0));
      const double radius = random.uniform(0.05, 0.3), height = random.uniform(0.5, 1.5);
      add_tube(foot, radius, height);
      add_tube(foot.cwiseProduct(Vector3(-1, 1, 1)), radius, height);
    }
    add_tube({0.6, 0, 0}, 0.3, 0.4);  // on one side only
    Points points(20000, 3);
    std::vector<double> covered;
    double area = 0;
    for (const auto& face : mesh.faces.rowwise()) {
      const Vector3 u = mesh.vertices.row(face[1]) - mesh.vertices.row(face[0]),
                    v = mesh.vertices.row(face[2]) - mesh.vertices.row(face[0]);
      covered.push_back(area += u.cross(v).norm());
    }
    for (auto row : points.rowwise()) {
      const auto f = std::lower_bound(covered.begin(), covered.end(), random.uniform(0, area)) -
                     covered.begin();
      const double down = std::sqrt(random.uniform(0, 1)), along = random.uniform(0, 1);
      const auto corner = [&](int c) { return mesh.vertices.row(mesh.faces(f, c)); };
      row = (1 - down) * corner(0) + down * ((1 - along) * corner(1) + along * corner(2));
    }
    const Result of_mesh = detected(mesh, "plane"), of_points = detect(points, {.method = "plane"});
    EXPECT_NEAR(of_mesh.score, of_points.score, 0.03) << seed;
    const Vector3 one = dynamic_cast<const Plane&>(*of_mesh.mirror).normal(),
                  other = dynamic_cast<const Plane&>(*of_points.mirror).normal();
    EXPECT_LT(one.cross(other).norm(), 0.3 * std::numbers::pi / 180) << seed;
  }
}

TEST(SurfaceSamples, FindEveryKindOfMirror) {
  // The search methods get the samples, the thesis's the vertices.
  const TestMesh mesh = chair(0);
  for (const Method& method : methods()) {
    const Result result = detected(mesh, method.name.c_str());
    const bool samples = implementation(method.name).preprocessing.sample_faces;
    EXPECT_EQ(result.statistics.count("surface_samples"), samples ? 1u : 0u) << method.name;
    for (Index row = 0; row < result.pairs.rows(); ++row) {
      ASSERT_LT(result.pairs.row(row).maxCoeff(), mesh.vertices.rows()) << method.name;
      if (!samples || !result.mirror) continue;
      const Vector3 from = mesh.vertices.row(result.pairs(row, 0));
      const Vector3 to = mesh.vertices.row(result.pairs(row, 1));
      EXPECT_NEAR((result.mirror->reflect(from) - to).norm(), result.residuals[row], 1e-9)
          << method.name;
    }
  }
}

TEST(SurfaceSamples, HaveNormals) {
  const TestMesh mesh = chair(3);
  Points normals(mesh.vertices.rows(), 3);
  normals.rowwise() = Vector3(1, 1, 1).transpose().normalized();
  const Result result = detected(mesh, "plane", normals);
  EXPECT_TRUE(is_plane(result, Vector3::UnitX(), {0.5, 0, 0}));
}

TEST(SurfaceSamples, FacesOfPointsLeftOutGo) {
  TestMesh mesh = chair(1);
  const Index had = mesh.vertices.rows();
  const double nan = std::nan("");
  mesh.add((Points(2, 3) << nan, 0, 0, 0, nan, 1).finished(),
           (Triangles(1, 3) << 0, 1, -had).finished());
  const Result result = detected(mesh, "plane");
  EXPECT_EQ(std::get<Index>(result.statistics.at("nonfinite_points")), 2);
  EXPECT_TRUE(is_plane(result, Vector3::UnitX(), {0.5, 0, 0}));
  EXPECT_EQ(result.pairs.rows(), had);
  // Single points far off, in a sliver of a face or in none, are outliers.
  mesh = chair(1);
  mesh.add(Points::Constant(1, 3, 40), (Triangles(1, 3) << 0, -had, 1 - had).finished());
  mesh.faces.conservativeResize(mesh.faces.rows() - 1, 3);
  EXPECT_EQ(std::get<Index>(detected(mesh, "plane").statistics.at("outliers")), 1);
}

// A shade of many small faces and a foot of few large ones, far below: no outliers.
TEST(SurfaceSamples, LargeFacesOfFewVerticesAreNoOutliers) {
  TestMesh mesh;
  const Index around = 60;
  Points rings(8 * around, 3);
  Triangles faces(2 * 7 * around, 3);
  for (Index r = 0; r < 8; ++r)
    for (Index j = 0; j < around; ++j) {
      const double turn = 2 * M_PI * static_cast<double>(j) / static_cast<double>(around);
      rings.row(r * around + j) << 0.5 * std::cos(turn), 0.5 * std::sin(turn),
          10 + 0.1 * static_cast<double>(r);
      if (r == 7) continue;
      const Index a = r * around + j, b = r * around + (j + 1) % around;
      faces.row(2 * a) << a, b, a + around;
      faces.row(2 * a + 1) << b, b + around, a + around;
    }
  mesh.add(rings, faces);
  mesh.add_box({-0.7, -0.7, 0}, {0.7, 0.7, 0.1});
  EXPECT_EQ(detect(mesh.vertices, {.method = "plane"}).statistics.count("outliers"), 1u);
  const Result result = detected(mesh, "plane");
  EXPECT_EQ(result.statistics.count("outliers"), 0u);
  EXPECT_GT(result.score, 0.9);
}

TEST(SurfaceSamples, FacesThatAreNoneArePassedOver) {
  TestMesh mesh = chair(0);
  const Points before = samples_of(mesh);
  mesh.add(Points(0, 3), (Triangles(2, 3) << -1, -1, -2, -1, -1, -1).finished());
  EXPECT_EQ(samples_of(mesh), before);
  // All of them: the points alone.
  RandomCloud random(0);
  TestMesh none;
  none.add(random.box(100), (Triangles(2, 3) << 0, 0, 1, 2, 2, 2).finished());
  EXPECT_EQ(detected(none, "plane").score, detect(none.vertices, {.method = "plane"}).score);
}

TEST(SurfaceSamples, FacesMustNamePoints) {
  for (const Index bad : {Index{48}, Index{-1}, Index{1} << 40}) {
    TestMesh mesh = chair(0);
    mesh.faces(7, 1) = bad;
    for (const Method& method : methods())
      expect_error<InvalidInput>(
          "face 7 names point " + std::to_string(bad) + "; allowed is 0 to 47",
          [&] { detected(mesh, method.name.c_str()); });
  }
}

TEST(SurfaceSamples, AreTheFewestPointsAMethodNeeds) {
  // A tetrahedron has fewer vertices than some methods need, but samples enough.
  TestMesh mesh;
  mesh.add((Points(4, 3) << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, 0.3, 0.8).finished(),
           (Triangles(4, 3) << 0, 1, 2, 0, 1, 3, 1, 2, 3, 2, 0, 3).finished());
  for (const char* method : {"plane", "auto", "quadric"}) {
    const Result result = detected(mesh, method);
    EXPECT_TRUE(result.mirror) << method;
  }
  EXPECT_TRUE(is_plane(detected(mesh, "plane"), Vector3::UnitX(), {0.5, 0, 0}));
}

}  // namespace
}  // namespace symsurf::surface_samples_tests
