#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/math.h"
#include "bumpy_ball.h"
#include "expect_error.h"
#include "figure.h"
#include "limbed_body.h"
#include "random_cloud.h"
#include "test_mesh.h"

namespace symsurf::topological_pairs_tests {
namespace {

const Values topology{{"pairing", std::string("topology")}};

// The faces of the side x >= 0 of a standing body, and those of the vertices that mirror theirs.
Triangles symmetric_faces(const LimbedBody& standing) {
  std::vector<std::array<Index, 3>> faces;
  for (const auto& face : standing.faces.rowwise()) {
    bool is_inside = true;
    for (const Index i : face)
      is_inside = is_inside && (standing.points(i, 0) > 0 || standing.mirrored[i] == i);
    if (!is_inside) continue;
    const auto& over = standing.mirrored;
    faces.push_back({face[0], face[1], face[2]});
    faces.push_back({over[face[0]], over[face[2]], over[face[1]]});
  }
  return rows_of(faces);
}

// The animal with each leg bent forwards or backwards, by 40 degrees at the most.
TestMesh striding(std::uint64_t seed) {
  RandomCloud random(seed);
  LimbedBody body = standing_animal();
  for (const double y : {2.5, 17.5})
    for (const int side : {1, -1}) {
      const Vector3 turn(random.uniform(-0.7, 0.7), 0, 0);
      for (Index i = 0; i < body.points.rows(); ++i)
        if (const Vector3 x = body.points.row(i);
            x.z() < 0 && side * x.x() > 0 && std::abs(x.y() - y) < 4)
          body.points.row(i) =
              bent(x, Vector3(side * 2.5, y, -3), -Vector3::UnitZ(), turn, 6).transpose();
    }
  return {body.points, symmetric_faces(standing_animal())};
}

TestMesh posed(std::uint64_t seed) {
  return {posed_animal(seed).points, symmetric_faces(standing_animal())};
}

OperationResult correspondences(const TestMesh& mesh, const Mirror& mirror = middle) {
  return operate("correspondences", {mesh.vertices, mesh.faces}, mirror, topology);
}

void expect_partners(const OperationResult& result, const std::vector<Index>& partners) {
  for (std::size_t i = 0; i < partners.size(); ++i)
    EXPECT_EQ(result.arrays.at("index")(static_cast<Index>(i), 0),
              static_cast<double>(partners[i]));
}

// A ball of quadrangles, each divided about its middle: many maps take it onto itself.
TestMesh lattice_ball(int around, int rings) {
  TestMesh mesh;
  std::vector<Vector3> points;
  std::vector<std::array<Index, 3>> faces;
  const auto at = [&](double ring, double k) {
    const double height = std::numbers::pi * (ring + 1) / (rings + 1),
                 angle = 2 * std::numbers::pi * (k + 0.5) / around;
    return Vector3(std::sin(height) * std::cos(angle), 1.3 * std::sin(height) * std::sin(angle),
                   1.6 * std::cos(height));
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) points.push_back(at(ring, k));
  for (int ring = 0; ring + 1 < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      const Index a = ring * around + k, b = ring * around + (k + 1) % around,
                  middle = static_cast<Index>(points.size());
      points.push_back(at(ring + 0.5, k + 0.5));
      for (const auto& [from, to] :
           {std::pair(a, a + around), {a + around, b + around}, {b + around, b}, {b, a}})
        faces.push_back({from, to, middle});
    }
  mesh.add(rows_of(points), rows_of(faces));
  return mesh;
}

TEST(TopologicalPairs, AreThoseOfABodyInAnyPose) {
  const std::vector<Index> truth = standing_animal().mirrored;
  for (std::uint64_t seed = 0; seed < 4 * seeds; ++seed) {
    const OperationResult result = correspondences(posed(seed));
    EXPECT_EQ(figure(result, "paired_share"), 1);
    expect_partners(result, truth);
    EXPECT_EQ(result.arrays.at("confidence").minCoeff(), 1);
    EXPECT_FALSE(result.statistics.contains("warning"));
  }
}

TEST(TopologicalPairs, GiveBothSidesThePoseOfOne) {
  const LimbedBody standing = standing_animal();
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    TestMesh mesh = posed(seed);
    // The feet of the positive side step far beyond the mirror.
    for (Index i = 0; i < mesh.vertices.rows(); ++i)
      if (standing.points(i, 0) > 0 && standing.points(i, 2) < -9) mesh.vertices(i, 0) -= 12;
    Values values = topology;
    values["side"] = std::string("positive");
    const OperationResult one = operate("symmetrize", {mesh.vertices, mesh.faces}, middle, values);
    const OperationResult both =
        operate("symmetrize", {mesh.vertices, mesh.faces}, middle, topology);
    for (Index i = 0; i < mesh.vertices.rows(); ++i) {
      const Index j = standing.mirrored[i];
      const Vector3 over(-1, 1, 1), x = mesh.vertices.row(i), y = mesh.vertices.row(j);
      EXPECT_EQ(Vector3(one.points.row(j)), over.cwiseProduct(Vector3(one.points.row(i))));
      if (i != j && standing.points(i, 0) > 0) {
        EXPECT_EQ(Vector3(one.points.row(i)), x);
      }
      EXPECT_LT((Vector3(both.points.row(i)) - (x + over.cwiseProduct(y)) / 2).norm(), 1e-12);
    }
    const OperationResult carried =
        operate("transfer", {mesh.vertices, mesh.faces}, middle, topology);
    for (Index i = 0; i < mesh.vertices.rows(); ++i)
      EXPECT_EQ(carried.point_sources[i],
                standing.mirrored[i] != i && standing.points(i, 0) < 0 ? standing.mirrored[i] : i);
  }
}

TEST(TopologicalPairs, AreThoseOfTheMirrorWhereMapsAreMany) {
  for (const int around : {12, 16}) {
    const TestMesh mesh = lattice_ball(around, 9);
    for (const Vector3& normal : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)}) {
      const Plane mirror(normal, 0);
      const OperationResult result = correspondences(mesh, mirror);
      EXPECT_GT(std::get<Index>(result.statistics.at("mirror_maps")), around / 2);
      EXPECT_FALSE(result.statistics.contains("warning"));
      for (Index i = 0; i < mesh.vertices.rows(); ++i) {
        const auto j = static_cast<Index>(result.arrays.at("index")(i, 0));
        EXPECT_LT((mirror.reflect(Vector3(mesh.vertices.row(i))) - mesh.vertices.row(j).transpose())
                      .norm(),
                  1e-12);
      }
    }
    // Between two of its mirrors neither is nearer.
    const double angle = std::numbers::pi / around;
    TestMesh round = mesh;
    round.vertices.col(1) /= 1.3;
    const OperationResult between =
        correspondences(round, Plane(Vector3(std::cos(angle / 2), std::sin(angle / 2), 0), 0));
    EXPECT_NE(std::get<std::string>(between.statistics.at("warning")).find("about as well"),
              std::string::npos);
  }
}

// A ring about each of two legs, and a ball between them: a leg takes its ring along.
TEST(TopologicalPairs, OfPartsGoWithTheBody) {
  const LimbedBody standing = standing_animal();
  const TestMesh part = lattice_ball(8, 5);
  for (std::uint64_t seed = 0; seed < 4 * seeds; ++seed) {
    TestMesh mesh = striding(seed);
    std::vector<Index> partners = standing.mirrored;
    for (const double y : {2.5, 17.5}) {
      const Index first = mesh.vertices.rows(), count = part.vertices.rows();
      for (const int side : {1, -1}) {
        const Vector3 foot(side * 2.5, y, -13);
        Index nearest = 0;
        (standing.points.rowwise() - foot.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
        // Moved as the three vertices of a face there are.
        Index f = 0;
        while (mesh.faces(f, 0) != nearest) ++f;
        const auto frame = [&](const Points& points) {
          const Vector3 a = points.row(mesh.faces(f, 0)), b = points.row(mesh.faces(f, 1)),
                        c = points.row(mesh.faces(f, 2));
          const Vector3 u = (b - a).normalized(), n = u.cross(c - a).normalized();
          Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
          at.linear() << u, n, u.cross(n);
          at.translation() = a;
          return at;
        };
        const Eigen::Isometry3d moved = frame(mesh.vertices) * frame(standing.points).inverse();
        TestMesh own = part;
        for (Index i = 0; i < count; ++i)
          own.vertices.row(i) =
              (moved * (foot + Vector3(part.vertices.row(i)).cwiseProduct(Vector3(side, 1, 0.2))))
                  .transpose();
        for (Index i = 0; i < count; ++i) partners.push_back(first + i + (side > 0 ? count : 0));
        mesh.add(own.vertices, own.faces);
      }
    }
    const OperationResult result = correspondences(mesh);
    EXPECT_EQ(figure(result, "paired_share"), 1);
    expect_partners(result, partners);
  }
}

TEST(TopologicalPairs, NeedNeitherWindingNorWeldedVertices) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball halves = mirrored_without_turning(seed);
    expect_partners(correspondences({halves.points, halves.faces}), halves.partner);
    const TestMesh mesh = posed(seed);
    TestMesh soup;
    for (const auto& face : mesh.faces.rowwise()) {
      Points corners(3, 3);
      for (int c = 0; c < 3; ++c) corners.row(c) = mesh.vertices.row(face[c]);
      soup.add(corners, (Triangles(1, 3) << 0, 1, 2).finished());
    }
    const OperationResult result = correspondences(soup);
    const std::vector<Index> truth = standing_animal().mirrored;
    for (Index i = 0; i < soup.vertices.rows(); ++i) {
      const auto j = static_cast<Index>(result.arrays.at("index")(i, 0));
      EXPECT_EQ(mesh.faces(j / 3, j % 3), truth[mesh.faces(i / 3, i % 3)]);
    }
  }
}

TEST(TopologicalPairs, DoNotDependOnHowQuadranglesAreDivided) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = ball(seed);
    expect_partners(correspondences({b.points, b.faces}), b.partner);
    const LimbedBody animal = posed_animal(seed);
    expect_partners(correspondences({animal.points, animal.faces}), animal.mirrored);
  }
}

// Parts that meet in vertices and edges, faces in both windings and with corners twice.
TEST(TopologicalPairs, OfAnyTrianglesAreMutualOrAnError) {
  Index paired = 0;
  for (std::uint64_t seed = 0; seed < 200 * seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.sphere(4 + random.below(30));
    Triangles faces(1 + random.below(60), 3);
    for (Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) faces(f, c) = random.below(points.rows());
    try {
      const Eigen::MatrixXd index = correspondences({points, faces}).arrays.at("index");
      for (Index i = 0; i < index.rows(); ++i)
        if (const auto j = static_cast<Index>(index(i, 0)); j >= 0) {
          EXPECT_EQ(index(j, 0), static_cast<double>(i)) << seed;
          ++paired;
        }
    } catch (const InvalidInput&) {
    }
  }
  EXPECT_GT(paired, 0);
}

TEST(TopologicalPairs, NameWhatHasNone) {
  Ball b = ball(3);  // its quadrangles are divided at random, and their halves lie apart here
  const Triangles faces = b.faces;
  const Index half = faces.rows() / 2;
  for (Index f = 0; f < faces.rows(); ++f) b.faces.row(f % 2 * half + f / 2) = faces.row(f);
  expect_error<InvalidInput>("the triangulation is not symmetric", [&] {
    correspondences({b.points, b.faces});
  });
  expect_error<InvalidInput>("needs faces",
                             [&] { operate("correspondences", {b.points}, middle, topology); });
  // A small part without a map stays as it is.
  TestMesh mesh = posed(0);
  const Index body = mesh.vertices.rows();
  mesh.add(Points(b.points.array() + 30), b.faces);
  const OperationResult result = correspondences(mesh);
  EXPECT_NE(std::get<std::string>(result.statistics.at("warning")).find("not symmetric"),
            std::string::npos);
  EXPECT_EQ(result.arrays.at("index").bottomRows(b.points.rows()).maxCoeff(), -1);
  EXPECT_GE(result.arrays.at("index").topRows(body).minCoeff(), 0);
}

}  // namespace
}  // namespace symsurf::topological_pairs_tests
