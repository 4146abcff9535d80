#include "cloud/closest_point_on_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "random_cloud.h"

namespace symsurf::closest_point_on_mesh_tests {
namespace {

// The distance from a triangle by another way: the ends of nested golden sections, over a convex
// function.
template <typename Function>
double least(const Function& f) {
  constexpr double golden = 0.6180339887498949;
  double low = 0, high = 1, a = 1 - golden, b = golden, at_a = f(a), at_b = f(b);
  for (int step = 0; step < 60; ++step) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - golden * (high - low), at_a = f(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + golden * (high - low), at_b = f(b);
    }
  }
  return std::min({f(0), f(1), at_a, at_b});
}

double segment_distance(const Vector3& a, const Vector3& b, const Vector3& query) {
  const double length = (b - a).squaredNorm();
  const double t = length > 0 ? std::clamp((b - a).dot(query - a) / length, 0.0, 1.0) : 0;
  return (a + t * (b - a) - query).norm();
}

double distance(const Points& points, const Triangles& faces, Index f, const Vector3& query) {
  const Vector3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
                c = points.row(faces(f, 2));
  return least([&](double t) { return segment_distance(a + t * (b - a), a + t * (c - a), query); });
}

double distance(const Points& points, const Triangles& faces, const Vector3& query) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < faces.rows(); ++f)
    nearest = std::min(nearest, distance(points, faces, f, query));
  return nearest;
}

void expect_closest(const Points& points, const Triangles& faces, const Vector3& query,
                    const ClosestPoint& found, double accuracy) {
  ASSERT_GE(found.face, 0);
  EXPECT_NEAR(std::sqrt(found.squared_distance), distance(points, faces, query), accuracy);
  EXPECT_GE(found.weights.minCoeff(), 0);
  EXPECT_NEAR(found.weights.sum(), 1, 1e-14);
  Vector3 point = Vector3::Zero();
  for (int c = 0; c < 3; ++c)
    point += found.weights[c] * points.row(faces(found.face, c)).transpose();
  EXPECT_LE((found.point - point).norm(), accuracy);
  EXPECT_NEAR((found.point - query).norm(), std::sqrt(found.squared_distance), accuracy);
}

struct Soup {
  Points points;
  Triangles faces;
};

// With legs of length 4 along x and y.
Soup right_triangle() {
  Soup triangle{Points(3, 3), Triangles(1, 3)};
  triangle.points << 0, 0, 0, 4, 0, 0, 0, 4, 0;
  triangle.faces << 0, 1, 2;
  return triangle;
}

// Triangles of that size and of that width against it; some are points or segments.
Soup soup(Index count, double size, double width, RandomCloud& random) {
  Soup soup{Points(3 * count, 3), Triangles(count, 3)};
  const auto direction = [&] {
    return Vector3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (Index f = 0; f < count; ++f) {
    const Vector3 x = direction(), along = size * direction();
    soup.points.row(3 * f) = x.transpose();
    soup.points.row(3 * f + 1) = (x + along).transpose();
    soup.points.row(3 * f + 2) =
        (x + random.uniform(0, 1) * along + width * size * direction()).transpose();
    soup.faces.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
    if (f % 10 == 7) soup.faces(f, 2) = soup.faces(f, 1);
    if (f % 10 == 8) soup.faces.row(f).setConstant(3 * f);
    if (f % 10 == 9) soup.points.row(3 * f + 2) = (x + 2 * along).transpose();
  }
  return soup;
}

TEST(ClosestPointOnMesh, IsThatOfAllTriangles) {
  RandomCloud random(1);
  for (const double size : {0.05, 1.0})
    for (const double width : {1.0, 1e-3, 1e-9}) {
      const Soup mesh = soup(200, size, width, random);
      const ClosestPointOnMesh closest(mesh.points, mesh.faces);
      for (int k = 0; k < 40; ++k) {
        const Vector3 query(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
        expect_closest(mesh.points, mesh.faces, query, closest(query), 1e-8);
      }
      // On a face, an edge and a corner the distance is none.
      for (Index f = 0; f < 200; f += 9) {
        const Vector3 a = mesh.points.row(mesh.faces(f, 0)), b = mesh.points.row(mesh.faces(f, 1)),
                      c = mesh.points.row(mesh.faces(f, 2));
        for (const Vector3& query : {a, Vector3((a + b) / 2), Vector3(0.2 * a + 0.3 * b + 0.5 * c)})
          EXPECT_LE(closest(query).squared_distance, 1e-29);
      }
    }
}

TEST(ClosestPointOnMesh, RegionsOfATriangle) {
  const auto [points, faces] = right_triangle();
  const ClosestPointOnMesh closest(points, faces);
  struct Case {
    Vector3 query, point, weights;
  };
  for (const Case& c :
       {Case{{1, 1, 5}, {1, 1, 0}, {0.5, 0.25, 0.25}}, Case{{-1, -2, 1}, {0, 0, 0}, {1, 0, 0}},
        Case{{6, -1, 0}, {4, 0, 0}, {0, 1, 0}}, Case{{1, -3, 0}, {1, 0, 0}, {0.75, 0.25, 0}},
        Case{{3, 3, 2}, {2, 2, 0}, {0, 0.5, 0.5}}, Case{{-2, 3, 0}, {0, 3, 0}, {0.25, 0, 0.75}}}) {
    const ClosestPoint found = closest(c.query);
    EXPECT_LE((found.point - c.point).norm(), 1e-15) << c.query.transpose();
    EXPECT_LE((found.weights - c.weights).norm(), 1e-15) << c.query.transpose();
  }
}

TEST(ClosestPointOnMesh, TiesGoToTheLowestFace) {
  // Squares of a plane in random order: over a vertex, up to eight faces are equally close.
  constexpr int side = 12;
  std::vector<std::array<Index, 3>> rows;
  Points points(side * side, 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) << i % side, i / side, 0;
  for (Index r = 0; r + 1 < side; ++r)
    for (Index c = 0; c + 1 < side; ++c) {
      const Index a = r * side + c, b = a + side;
      rows.push_back({a, a + 1, b + 1});
      rows.push_back({a, b + 1, b});
    }
  RandomCloud random(5);
  for (std::size_t i = rows.size(); i-- > 1;)
    std::swap(rows[i], rows[static_cast<std::size_t>(random.uniform(0, 1) * (i + 1))]);
  Triangles faces(static_cast<Index>(rows.size()), 3);
  for (Index f = 0; f < faces.rows(); ++f) faces.row(f) << rows[f][0], rows[f][1], rows[f][2];
  const ClosestPointOnMesh closest(points, faces);
  for (Index i = 0; i < points.rows(); ++i) {
    Index lowest = 0;
    while ((faces.row(lowest).array() != i).all()) ++lowest;
    EXPECT_EQ(closest(points.row(i).transpose() + Vector3(0, 0, 0.5)).face, lowest) << i;
  }
}

TEST(ClosestPointOnMesh, NoneBeyondTheLimit) {
  auto [points, faces] = right_triangle();
  const ClosestPointOnMesh closest(points, faces);
  EXPECT_EQ(closest({1, 1, 2}, 4).face, 0);
  EXPECT_EQ(closest({1, 1, 2}, 3.999).face, -1);
  EXPECT_EQ(closest({1, 1, std::numeric_limits<double>::quiet_NaN()}).face, -1);
  EXPECT_EQ(ClosestPointOnMesh(points, {})({1, 1, 2}).face, -1);
  points(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ClosestPointOnMesh(points, faces)({1, 1, 2}).face, -1);
}

TEST(ClosestPointOnMesh, FarFromTheOrigin) {
  RandomCloud random(2);
  Soup mesh = soup(100, 0.3, 0.5, random);
  mesh.points.rowwise() += Eigen::RowVector3d(4000000.001, -4000000.001, 100);
  const ClosestPointOnMesh closest(mesh.points, mesh.faces);
  for (int k = 0; k < 20; ++k) {
    const Vector3 query = Vector3(4000000.001, -4000000.001, 100) +
                          Vector3(random.uniform(-1, 1), random.uniform(-1, 1), 0.3);
    expect_closest(mesh.points, mesh.faces, query, closest(query), 1e-7);
  }
}

TEST(ClosestPointOnMesh, OfFacesThatFaceADirectionIsThatOfThoseAlone) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.box(60);
    Triangles faces(80, 3);
    for (Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) faces(f, c) = random.below(points.rows());
    const Vector3 direction = random.direction();
    Triangles facing(faces.rows(), 3);
    Index count = 0;
    for (const auto& f : faces.rowwise()) {
      const Vector3 a = points.row(f[0]), b = points.row(f[1]), c = points.row(f[2]);
      const Vector3 normal = (b - a).cross(c - a);
      if (normal.dot(direction) >= 0.5 * normal.norm()) facing.row(count++) = f;
    }
    facing.conservativeResize(count, 3);
    const ClosestPointOnMesh all(points, faces), those(points, facing);
    for (int k = 0; k < 20; ++k) {
      const Vector3 query = 2 * random.in_box();
      EXPECT_NEAR(all.facing(query, direction, 0.5, 100).squared_distance,
                  those(query).squared_distance, 1e-12);
    }
  }
}

}  // namespace
}  // namespace symsurf::closest_point_on_mesh_tests
