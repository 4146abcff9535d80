#include "cloud/triangle_mesh.h"

#include <gtest/gtest.h>
#include <symsurf/context.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::triangle_mesh_tests {
namespace {

using Loops = std::vector<std::vector<Index>>;

Points points_of(const std::vector<Vector3>& rows) {
  Points points(static_cast<Index>(rows.size()), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = rows[i].transpose();
  return points;
}

Triangles triangles_of(const std::vector<std::array<Index, 3>>& rows) {
  Triangles triangles(static_cast<Index>(rows.size()), 3);
  for (Index f = 0; f < triangles.rows(); ++f)
    triangles.row(f) << rows[f][0], rows[f][1], rows[f][2];
  return triangles;
}

// The unit cube, wound outwards, its top (z = 1) last. Vertex i is at its bits x, y, z.
Points cube_points(double size = 1) {
  std::vector<Vector3> rows;
  for (int i = 0; i < 8; ++i) rows.push_back(size * Vector3(i & 1, i >> 1 & 1, i >> 2));
  return points_of(rows);
}
const Triangles cube = triangles_of({{0, 2, 3},
                                     {0, 3, 1},
                                     {0, 1, 5},
                                     {0, 5, 4},
                                     {2, 6, 7},
                                     {2, 7, 3},
                                     {0, 4, 6},
                                     {0, 6, 2},
                                     {1, 3, 7},
                                     {1, 7, 5},
                                     {4, 5, 7},
                                     {4, 7, 6}});

// A flat grid of unit squares, columns x rows, without those that `is_hole` says.
struct Grid {
  Points points;
  Triangles faces;
};
template <typename IsHole>
Grid grid(int columns, int rows, const IsHole& is_hole) {
  std::vector<Vector3> points;
  std::vector<std::array<Index, 3>> faces;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c) points.emplace_back(c, r, 0);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      if (is_hole(c, r)) continue;
      const Index a = r * (columns + 1) + c, b = a + columns + 1;
      faces.push_back({a, a + 1, b + 1});
      faces.push_back({a, b + 1, b});
    }
  return {points_of(points), triangles_of(faces)};
}
Grid grid(int columns, int rows) {
  return grid(columns, rows, [](int, int) { return false; });
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

Index count(const std::vector<bool>& values) {
  return std::count(values.begin(), values.end(), true);
}

TEST(TriangleMesh, CubeIsClosed) {
  const TriangleMesh mesh(cube_points(), cube);
  EXPECT_EQ(mesh.vertices(), 8);
  EXPECT_EQ(mesh.faces(), 12);
  EXPECT_EQ(mesh.refused().total(), 0);
  EXPECT_EQ(count(mesh.is_boundary()), 0);
  EXPECT_EQ(mesh.boundary_loops(), Loops());
  EXPECT_NEAR(sum(mesh.vertex_areas()), 6, 1e-14);
  EXPECT_EQ(mesh.neighbours(1), (std::vector<Index>{0, 3, 5, 7}));
}

TEST(TriangleMesh, NormalsOfACubePointOutwards) {
  const TriangleMesh mesh(cube_points(), cube);
  const Points faces = mesh.face_normals();
  EXPECT_EQ(Vector3(faces.row(0)), -Vector3::UnitZ());
  EXPECT_EQ(Vector3(faces.row(2)), -Vector3::UnitY());
  EXPECT_EQ(Vector3(faces.row(8)), Vector3::UnitX());
  EXPECT_EQ(Vector3(faces.row(11)), Vector3::UnitZ());
  // By angle the three sides of a corner weigh the same, however they are divided.
  const Points by_angle = mesh.vertex_normals();
  for (int i = 0; i < 8; ++i) {
    const Vector3 outwards = Vector3(2 * (i & 1) - 1, 2 * (i >> 1 & 1) - 1, 2 * (i >> 2) - 1);
    EXPECT_LE((Vector3(by_angle.row(i)) - outwards.normalized()).norm(), 1e-14) << i;
  }
  // By area a side weighs as many triangles as it has at the corner: two of x, one of y and z.
  const Points by_area = mesh.vertex_normals(TriangleMesh::Weight::Area);
  EXPECT_LE((Vector3(by_area.row(1)) - Vector3(2, -1, -1).normalized()).norm(), 1e-14);
}

TEST(TriangleMesh, OpenBoxHasTheLoopOfItsRim) {
  const TriangleMesh mesh(cube_points(), Triangles(cube.topRows(10)));
  EXPECT_EQ(mesh.boundary_loops(), (Loops{{4, 5, 7, 6}}));
  const std::vector<bool> boundary = mesh.is_boundary();
  for (int i = 0; i < 8; ++i) EXPECT_EQ(boundary[i], i >= 4) << i;
}

TEST(TriangleMesh, StripWithAHoleHasTwoLoops) {
  const Grid strip = grid(5, 3, [](int c, int r) { return c == 2 && r == 1; });
  const TriangleMesh mesh(strip.points, strip.faces);
  const Loops loops = mesh.boundary_loops();
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 16u);
  EXPECT_EQ(loops[0].front(), 0);
  EXPECT_EQ(loops[1], (std::vector<Index>{8, 9, 15, 14}));
  EXPECT_EQ(count(mesh.is_boundary()), 20);
  EXPECT_NEAR(sum(mesh.vertex_areas()), 14, 1e-13);
}

TEST(TriangleMesh, MoebiusStripHasOneSideAndNoFaceIsLost) {
  constexpr int quads = 20;
  std::vector<Vector3> points;
  std::vector<std::array<Index, 3>> faces;
  for (int i = 0; i < quads; ++i) {
    const double turn = 2 * std::numbers::pi * i / quads;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(turn / 2);
      points.emplace_back(r * std::cos(turn), r * std::sin(turn), side * std::sin(turn / 2));
    }
  }
  for (Index i = 0; i < quads; ++i) {
    const bool is_last = i == quads - 1;
    const Index a = 2 * i, b = a + 1, c = is_last ? 1 : a + 2, d = is_last ? 0 : a + 3;
    faces.push_back({a, c, b});
    faces.push_back({c, d, b});
  }
  const TriangleMesh mesh(points_of(points), triangles_of(faces));
  EXPECT_EQ(mesh.faces(), 2 * quads);
  EXPECT_EQ(mesh.refused().nonmanifold, 1);
  EXPECT_EQ(mesh.refused().total(), 1);
  // Every vertex is on the one rim. The diagonals turn where the strip closes.
  EXPECT_EQ(count(mesh.is_boundary()), 2 * quads);
  for (Index i = 0; i < 2 * quads; ++i)
    EXPECT_EQ(mesh.neighbours(i).size(), i == 0 ? 3u : i == 1 ? 5u : 4u) << i;
  EXPECT_NEAR(sum(mesh.vertex_areas()), surface_area(points_of(points), triangles_of(faces)),
              1e-13);
}

TEST(TriangleMesh, FacesGivenTwiceAreCounted) {
  Triangles faces(15, 3);
  faces << cube, cube.row(3), cube(3, 1), cube(3, 0), cube(3, 2), cube(5, 2), cube(5, 0),
      cube(5, 1);
  const TriangleMesh mesh(cube_points(), faces);
  EXPECT_EQ(mesh.refused().repeated, 3);
  EXPECT_EQ(mesh.refused().total(), 3);
  EXPECT_EQ(mesh.faces(), 15);
  EXPECT_EQ(count(mesh.is_boundary()), 0);
  EXPECT_NEAR(sum(mesh.vertex_areas()), 7.5, 1e-14);
  // Both windings of one triangle: its edges stay a rim.
  const TriangleMesh both(cube_points(), triangles_of({{0, 1, 2}, {0, 2, 1}, {0, 1, 2}}));
  EXPECT_EQ(both.vertices(), 8);
  EXPECT_EQ(both.refused().repeated, 2);
  EXPECT_EQ(count(both.is_boundary()), 3);
}

TEST(TriangleMesh, WronglyWoundFaceIsNoHole) {
  Triangles faces = cube;
  std::swap(faces(11, 1), faces(11, 2));
  const TriangleMesh mesh(cube_points(), faces);
  EXPECT_EQ(mesh.refused().nonmanifold, 1);
  EXPECT_EQ(mesh.refused().total(), 1);
  EXPECT_EQ(count(mesh.is_boundary()), 0);
  EXPECT_EQ(mesh.boundary_loops(), (Loops{{4, 7, 6}}));  // of the faces without it
  EXPECT_EQ(mesh.neighbours(6), (std::vector<Index>{0, 2, 4, 7}));
  EXPECT_NEAR(sum(mesh.vertex_areas()), 6, 1e-14);
  EXPECT_EQ(Vector3(mesh.face_normals().row(11)), -Vector3::UnitZ());
  const Points right = TriangleMesh(cube_points(), cube).vertex_normals();
  EXPECT_LE((mesh.vertex_normals() - right).norm(), 1e-14);
}

TEST(TriangleMesh, FacesThatFollowAWronglyWoundOneAreKeptAside) {
  Triangles faces = cube;
  std::swap(faces(4, 1), faces(4, 2));
  const TriangleMesh mesh(cube_points(), faces);
  EXPECT_EQ(mesh.refused().nonmanifold, 3);  // at its three edges
  EXPECT_EQ(count(mesh.is_boundary()), 0);
  EXPECT_NEAR(sum(mesh.vertex_areas()), 6, 1e-14);
}

TEST(TriangleMesh, ThirdFaceAtAnEdgeIsKeptAside) {
  const Points points = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}});
  const TriangleMesh mesh(points, triangles_of({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  EXPECT_EQ(mesh.refused().nonmanifold, 1);
  EXPECT_EQ(count(mesh.is_boundary()), 5);
  EXPECT_EQ(mesh.neighbours(4), (std::vector<Index>{0, 1}));
  EXPECT_EQ(mesh.vertex_areas(), (std::vector<double>{0.5, 0.5, 0.5 / 3, 0.5 / 3, 0.5 / 3}));
}

TEST(TriangleMesh, DegenerateFacesAreCounted) {
  const Grid square = grid(1, 1);
  Triangles faces(5, 3);
  faces << square.faces, 0, 0, 1, 2, 2, 2, 3, 1, 3;
  const TriangleMesh mesh(square.points, faces);
  EXPECT_EQ(mesh.refused().degenerate, 3);
  EXPECT_EQ(mesh.refused().total(), 3);
  EXPECT_EQ(mesh.boundary_loops(), (Loops{{0, 2, 3, 1}}));
  EXPECT_TRUE(mesh.face_normals().bottomRows(3).isZero(0));
  EXPECT_NEAR(sum(mesh.vertex_areas()), 1, 1e-15);
}

TEST(TriangleMesh, IsolatedVerticesKeepTheirNumbers) {
  Points points(10, 3);
  points << 7, 7, 7, cube_points(), 9, 9, 9;
  const TriangleMesh mesh(points, Triangles(cube.array() + 1));
  EXPECT_EQ(mesh.vertices(), 10);
  for (const Index lonely : {0, 9}) {
    EXPECT_EQ(mesh.point(lonely), Vector3(points.row(lonely)));
    EXPECT_EQ(mesh.neighbours(lonely), std::vector<Index>());
    EXPECT_EQ(mesh.vertex_areas()[lonely], 0);
    EXPECT_FALSE(mesh.is_boundary()[lonely]);
    EXPECT_TRUE(mesh.vertex_normals().row(lonely).isZero(0));
  }
  EXPECT_EQ(mesh.neighbours(2), (std::vector<Index>{1, 4, 6, 8}));
  EXPECT_EQ(TriangleMesh(points, Triangles(0, 3)).vertices(), 10);
  EXPECT_EQ(TriangleMesh({}, {}).vertices(), 0);
}

TEST(TriangleMesh, LargeCoordinatesKeepEveryDigit) {
  Points points = cube_points(0.001);
  points.rowwise() += Eigen::RowVector3d(4000000.001, 4000000.001, 123.456789012);
  const TriangleMesh mesh(points, cube);
  for (Index i = 0; i < 8; ++i) EXPECT_EQ(mesh.point(i), Vector3(points.row(i))) << i;
}

TEST(TriangleMesh, FanTouchingInAVertexHasTwoLoops) {
  const Points points = points_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}});
  const TriangleMesh mesh(points, triangles_of({{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(mesh.refused().total(), 0);
  EXPECT_EQ(count(mesh.is_boundary()), 5);
  Index passed = 0;
  for (const auto& loop : mesh.boundary_loops()) passed += static_cast<Index>(loop.size());
  EXPECT_EQ(passed, 6);
}

TEST(TriangleMesh, RefusesNothingSilentlyAndPrintsNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  RandomCloud random(3);
  for (int round = 0; round < 300; ++round) {
    const Index vertices = 4 + round % 9;
    Points points(vertices, 3);
    for (Index i = 0; i < vertices; ++i)
      for (int axis = 0; axis < 3; ++axis) points(i, axis) = random.uniform(0, 1);
    Triangles faces(3 * vertices, 3);
    for (Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c)
        faces(f, c) = std::min(vertices - 1, static_cast<Index>(random.uniform(0, 1) * vertices));
    const TriangleMesh mesh(points, faces);
    ASSERT_EQ(mesh.faces(), faces.rows());
    ASSERT_NEAR(sum(mesh.vertex_areas()), surface_area(points, faces), 1e-12);
    for (Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) {
        const Index a = faces(f, c), b = faces(f, (c + 1) % 3);
        const std::vector<Index> ring = mesh.neighbours(a);
        ASSERT_TRUE(a == b || std::binary_search(ring.begin(), ring.end(), b));
      }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(TriangleMesh, NamesAFaceOfNoPoint) {
  expect_error<InvalidInput>("face 1 names point 8; allowed is 0 to 7", [] {
    TriangleMesh(cube_points(), triangles_of({{0, 1, 2}, {0, 1, 8}}));
  });
}

TEST(TriangleMesh, AreaOfACube) { EXPECT_NEAR(surface_area(cube_points(2), cube), 24, 1e-13); }

}  // namespace
}  // namespace symsurf::triangle_mesh_tests
