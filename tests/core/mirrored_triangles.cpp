#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "bumpy_ball.h"
#include "cloud/triangle_mesh.h"
#include "expect_error.h"
#include "random_cloud.h"
#include "remeshing/isotropic_remeshing.h"

namespace symsurf::mirrored_triangles_tests {
namespace {

const Values mirrored{{"triangles", "mirrored"}, {"side", "positive"}};

OperationResult symmetrized(const Points& points, const Triangles& faces, const Mirror& mirror,
                            Values values = mirrored) {
  return operate("symmetrize", {points, faces}, mirror, values);
}

Index partner(const OperationResult& result, Index i) {
  return static_cast<Index>(result.arrays.at("partner")(i, 0));
}

// How many faces each edge has.
std::map<std::pair<Index, Index>, int> edges(const Triangles& faces) {
  std::map<std::pair<Index, Index>, int> found;
  for (Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) ++found[std::minmax(faces(f, k), faces(f, (k + 1) % 3))];
  return found;
}

using Corners = std::array<Index, 3>;

// From the lowest corner on, in the same winding.
Corners from_lowest(Index a, Index b, Index c) {
  Corners corners{a, b, c};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

double area_of(const Points& points, const Triangles& faces) {
  double area = 0;
  for (Index f = 0; f < faces.rows(); ++f) {
    const Vector3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
                  c = points.row(faces(f, 2));
    area += (b - a).cross(c - a).norm() / 2;
  }
  return area;
}

// A turned and shifted ball, which no mirror of the list has a vertex on.
struct Turned {
  Points points;
  Triangles faces;
  std::vector<std::shared_ptr<const Mirror>> mirrors;
};

Turned turned(std::uint64_t seed) {
  RandomCloud random(seed);
  const Ball b = ball(seed);
  const Matrix3 rotation = random.rotation();
  const Vector3 shift = 0.2 * random.in_box();
  const Vector3 normal = rotation.col(0), across = rotation.col(1);
  Turned made{(b.points * rotation.transpose()).rowwise() + shift.transpose(), b.faces, {}};
  made.mirrors.push_back(std::make_shared<Plane>(normal, -normal.dot(shift) + 0.05));
  made.mirrors.push_back(std::make_shared<Sphere>(shift - 4 * normal, 4.1));
  made.mirrors.push_back(std::make_shared<Cylinder>(shift - 3 * normal, across, 2.9));
  Points nodes(100, 3);
  for (Index i = 0; i < nodes.rows(); ++i) {
    const double u = 3.0 * static_cast<double>(i % 10) / 9 - 1.5,
                 v = 3.0 * static_cast<double>(i / 10) / 9 - 1.5;
    nodes.row(i) =
        (shift + rotation * Vector3(0.1 * std::sin(2 * u) * std::cos(v), u, v)).transpose();
  }
  made.mirrors.push_back(std::make_shared<HeightField>(normal, nodes));
  return made;
}

TEST(MirroredTriangles, AreExactOverEveryKindOfMirror) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Turned shape = turned(seed);
    for (const auto& mirror : shape.mirrors) {
      const OperationResult made = symmetrized(shape.points, shape.faces, *mirror);
      std::set<Corners> faces;
      for (Index f = 0; f < made.faces.rows(); ++f)
        faces.insert(from_lowest(made.faces(f, 0), made.faces(f, 1), made.faces(f, 2)));
      EXPECT_EQ(static_cast<Index>(faces.size()), made.faces.rows());
      for (const Corners& face : faces)
        EXPECT_TRUE(faces.contains(
            from_lowest(partner(made, face[0]), partner(made, face[2]), partner(made, face[1]))))
            << mirror->kind();
      for (Index i = 0; i < made.points.rows(); ++i) {
        const Index j = partner(made, i);
        EXPECT_EQ(partner(made, j), i);
        const Vector3 image = mirror->reflect(Vector3(made.points.row(i)));
        EXPECT_LE((image - Vector3(made.points.row(j))).norm(), 1e-12) << mirror->kind();
      }
    }
  }
}

TEST(MirroredTriangles, KeepAClosedSurfaceClosedAndWound) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Turned shape = turned(seed);
    for (const auto& mirror : shape.mirrors)
      for (const char* side : {"positive", "negative"}) {
        const OperationResult made = symmetrized(shape.points, shape.faces, *mirror,
                                                 {{"triangles", "mirrored"}, {"side", side}});
        std::set<std::pair<Index, Index>> directed;
        for (Index f = 0; f < made.faces.rows(); ++f)
          for (int k = 0; k < 3; ++k)
            EXPECT_TRUE(directed.emplace(made.faces(f, k), made.faces(f, (k + 1) % 3)).second);
        for (const auto& [a, b] : directed) EXPECT_TRUE(directed.contains({b, a}));
        for (const auto& [edge, faces] : edges(made.faces)) EXPECT_EQ(faces, 2) << mirror->kind();
      }
  }
}

// The parts of the faces on either side are all of the surface, and their points lie between those
// that they are said to lie between.
TEST(MirroredTriangles, AreThoseOfTheShape) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Turned shape = turned(seed);
    const Mirror& plane = *shape.mirrors.front();
    double area = 0;
    for (const char* side : {"positive", "negative"}) {
      const OperationResult made = symmetrized(shape.points, shape.faces, plane,
                                               {{"triangles", "mirrored"}, {"side", side}});
      area += area_of(made.points, made.faces) / 2;
      const double sign = side[0] == 'p' ? 1 : -1;
      for (Index i = 0; i < made.points.rows(); ++i) {
        Vector3 between = Vector3::Zero();
        for (int k = 0; k < 3; ++k)
          between += made.point_shares(i, k) *
                     Vector3(shape.points.row(made.point_parents(i, k)).transpose());
        const Vector3 x = made.points.row(i).transpose();
        const Vector3 own = sign * plane.signed_distance(x) < 0 ? plane.reflect(x) : x;
        EXPECT_LE((between - own).norm(), 1e-12);
        EXPECT_EQ(made.point_sources[i], made.point_parents(i, 0));
      }
    }
    EXPECT_NEAR(area, area_of(shape.points, shape.faces), 1e-9);
  }
}

// Corners that are named twice are on the mirror and off it.
TEST(MirroredTriangles, HaveThreeCornersEach) {
  Ball b = ball(4);
  const Index count = b.faces.rows();
  b.faces.conservativeResize(2 * count, 3);
  for (Index f = 0; f < count; ++f)
    b.faces.row(count + f) << b.faces(f, 0), b.faces(f, f % 2), b.faces(f, 1);
  const OperationInput input{b.points, b.faces};
  for (const OperationResult& made :
       {operate("symmetrize", input, middle, mirrored), operate("cut", input, middle),
        operate("remesh", input, middle)})
    for (Index f = 0; f < made.faces.rows(); ++f)
      EXPECT_FALSE(is_degenerate(made.faces.data() + 3 * f)) << made.operation;
}

// As where a curve has a gap: the closest point is an end of the edge that is split.
TEST(IsotropicRemeshing, EndsWhereTheSurfaceIsFarFromItsEdges) {
  Points square(4, 3);
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  Triangles faces(2, 3);
  faces << 0, 1, 2, 0, 2, 3;
  Remeshing remeshing{0.3};
  remeshing.onto = [](const Vector3&) { return Vector3(0, 0, 0); };
  const Remeshed made = isotropic_remeshing(square, faces, remeshing, Context());
  EXPECT_GT(made.faces.rows(), 2);
  EXPECT_LT(made.faces.rows(), 200);  // 26 of that length cover it
}

TEST(MirroredTriangles, AverageFirst) {
  const Ball b = ball(3);
  Eigen::VectorXd raised;
  const Points points = bumped(b.points, 0.05, raised);
  const OperationResult made = symmetrized(points, b.faces, middle, {{"triangles", "mirrored"}});
  const OperationResult average = operate("symmetrize", {points, b.faces}, middle);
  for (Index i = 0; i < made.points.rows(); ++i) {
    if (made.points(i, 0) <= 0 || made.point_shares(i, 0) < 1) continue;
    EXPECT_LE((made.points.row(i) - average.points.row(made.point_sources[i])).norm(), 1e-12);
  }
}

TEST(MirroredTriangles, OfACloudAreItsPoints) {
  const Points points = ball(1).points;
  const OperationResult made = symmetrized(points, {}, middle);
  EXPECT_EQ(made.faces.rows(), 0);
  EXPECT_GT(made.points.rows(), points.rows() / 2);
  for (Index i = 0; i < made.points.rows(); ++i) EXPECT_EQ(partner(made, partner(made, i)), i);
}

TEST(MirroredTriangles, RefuseWhatCannotBeMirrored) {
  const Ball b = ball(0);
  expect_error<InvalidInput>("points lies on the positive side",
                             [&] { symmetrized(b.points, b.faces, Plane(Vector3::UnitX(), -3)); });
  expect_error<InvalidInput>("have no image over this sphere", [&] {
    symmetrized(b.points, b.faces, Sphere(Vector3(-1.2, 0, 0), 0.5));
  });
  expect_error<InvalidParameter>("allowed with these is kept", [&] {
    symmetrized(b.points, b.faces, middle, {{"triangles", "mirrored"}, {"strength", 0.5}});
  });
}

// The faces of a side that meet in an edge on the mirror close it, whatever the other side does.
TEST(MirroredTriangles, MayMeetInAnEdgeOnTheMirror) {
  Points roof(4, 3);
  roof << 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 0, -1;
  Triangles two(2, 3);
  two << 0, 1, 2, 1, 0, 3;
  const OperationResult made = symmetrized(roof, two, middle);
  EXPECT_EQ(made.faces.rows(), 4);
  EXPECT_EQ(edges(made.faces).at({0, 1}), 4);
  const OperationResult half = operate("cut", {roof, two}, middle);
  EXPECT_EQ(half.faces, two);
  EXPECT_EQ(std::get<Index>(half.statistics.at("open_curves")), 0);
}

// A sheet with a face on each side, as CAD has them: where it is cut there is nothing to close.
TEST(MirroredTriangles, MayBeTwoSided) {
  Ball b = ball(2);
  const Index count = b.faces.rows();
  b.faces.conservativeResize(2 * count, 3);
  b.faces.bottomRows(count) = b.faces.topRows(count).rowwise().reverse().eval();
  const OperationResult half = operate("cut", {b.points, b.faces}, middle);
  EXPECT_EQ(std::get<Index>(half.statistics.at("cap_faces")), 0);
  EXPECT_EQ(std::get<Index>(half.statistics.at("open_curves")), 0);
  const OperationResult made = symmetrized(b.points, b.faces, middle);
  EXPECT_NEAR(area_of(made.points, made.faces), 2 * area_of(half.points, half.faces), 1e-9);
}

}  // namespace
}  // namespace symsurf::mirrored_triangles_tests
