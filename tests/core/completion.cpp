#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"
#include "bumpy_ball.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/triangle_mesh.h"
#include "expect_error.h"
#include "operations/meshes.h"
#include "random_cloud.h"

namespace symsurf::completion_tests {
namespace {

// The faces of which no corner is lost.
Triangles kept_faces(const Ball& b, const std::function<bool(const Vector3&)>& is_lost) {
  std::vector<std::array<Index, 3>> kept;
  for (const auto& f : b.faces.rowwise()) {
    bool lost = false;
    for (const Index i : f) lost = lost || is_lost(b.points.row(i).transpose());
    if (!lost) kept.push_back({f[0], f[1], f[2]});
  }
  return rows_of(kept);
}

// Of points on the mesh `of`: how far the share of them lies from the surface at the most.
double distance_quantile(const Points& points, const Triangles& of, const Points& surface,
                         const Triangles& faces, double share) {
  const ClosestPointOnMesh closest(surface, faces);
  std::vector<double> distances;
  for (const auto& f : of.rowwise())
    for (const Vector3& w :
         {Vector3(1, 1, 1), Vector3(4, 1, 1), Vector3(1, 4, 1), Vector3(1, 1, 4)}) {
      Vector3 x = Vector3::Zero();
      for (int c = 0; c < 3; ++c) x += w[c] / w.sum() * points.row(f[c]).transpose();
      distances.push_back(std::sqrt(closest(x).squared_distance));
    }
  return quantile(distances, share);
}

double extent(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

double volume(const Points& points, const Triangles& faces) {
  double sum = 0;
  for (const auto& f : faces.rowwise()) {
    const Vector3 a = points.row(f[0]), b = points.row(f[1]), c = points.row(f[2]);
    sum += a.cross(b).dot(c) / 6;
  }
  return sum;
}

Index count(const OperationResult& result, const char* name) {
  return std::get<Index>(result.statistics.at(name));
}

void expect_input_untouched(const OperationResult& result, const Points& points,
                            const Triangles& faces) {
  ASSERT_GE(result.points.rows(), points.rows());
  EXPECT_EQ(result.points.topRows(points.rows()), points);
  EXPECT_EQ(result.faces.topRows(faces.rows()), faces);
  EXPECT_EQ(static_cast<Index>(result.point_sources.size()), result.points.rows());
  EXPECT_EQ(static_cast<Index>(result.face_sources.size()), result.faces.rows());
  for (Index i = 0; i < points.rows(); ++i) EXPECT_EQ(result.point_sources[i], i);
  for (const Index source : result.face_sources) EXPECT_LT(source, faces.rows());
}

TEST(Complete, ClosesAHoleWithoutALeak) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Ball b = ball(seed);
    const double size = random.uniform(0.25, 0.6);
    Vector3 middle_of_hole = random.direction();
    while (middle_of_hole.x() < size + 0.2) middle_of_hole = random.direction();
    const Triangles faces = kept_faces(
        b, [&](const Vector3& x) { return (x.normalized() - middle_of_hole).norm() < size; });
    for (const bool bent : {false, true}) {
      const Points points = bent ? wrapped(b.points) : b.points;
      const Mirror& mirror = bent ? static_cast<const Mirror&>(round_mirror) : middle;
      const OperationResult result = operate("complete", {points, faces}, mirror);
      expect_input_untouched(result, points, faces);
      EXPECT_GT(count(result, "added_points"), 0);
      const TriangleMesh mesh(result.points, result.faces);
      EXPECT_EQ(mesh.refused().total(), 0);
      EXPECT_EQ(mesh.boundary_loops().size(), 0u) << seed << ' ' << bent;
      EXPECT_NEAR(volume(result.points, result.faces), volume(points, b.faces),
                  0.005 * volume(points, b.faces));
      const Eigen::MatrixXd& origin = result.arrays.at("origin");
      for (Index i = points.rows(); i < origin.rows(); ++i) {
        EXPECT_GE(origin(i, 0), 1);
        EXPECT_LT((result.points.row(i) - points.row(b.partner[result.point_sources[i]])).norm(),
                  1e-9);
      }
    }
  }
}

// Random cuts lose 10 to 45 % of one side; how coarse the ball is lets seams lie off by the sagitta
// of two edges, (4 pi / 48)^2 / 8, at most.
TEST(Complete, IsWhatWasCutAway) {
  for (std::uint64_t seed = 0; seed < 4 * seeds; ++seed) {
    RandomCloud random(seed);
    const Ball b = ball(seed);
    const double share = random.uniform(0.1, 0.45);
    Vector3 towards = random.direction();
    towards.x() = std::abs(towards.x());
    std::vector<double> heights;
    for (const auto& x : b.points.rowwise())
      if (x.x() > 0) heights.push_back(x.dot(towards.transpose()));
    const double limit = quantile(heights, 1 - share);
    const Triangles faces =
        kept_faces(b, [&](const Vector3& x) { return x.x() > 0 && x.dot(towards) > limit; });
    const OperationResult result = operate("complete", {b.points, faces}, middle);
    expect_input_untouched(result, b.points, faces);
    const Triangles added = result.faces.bottomRows(result.faces.rows() - faces.rows());
    ASSERT_GT(added.rows(), 0);
    const double allowed = 0.005 * extent(b.points);
    EXPECT_LE(distance_quantile(result.points, added, b.points, b.faces, 0.95), allowed) << seed;
    EXPECT_LE(distance_quantile(b.points, b.faces, result.points, result.faces, 0.95), allowed)
        << seed;
    EXPECT_EQ(TriangleMesh(result.points, result.faces).refused().total(), 0) << seed;
  }
}

int open_edges(const Triangles& faces) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const auto& f : faces.rowwise())
    for (int k = 0; k < 3; ++k) ++edges[std::minmax(f[k], f[(k + 1) % 3])];
  return static_cast<int>(
      std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 1; }));
}

const Values image{{"search", false}};

TEST(Complete, AddsTheImageOfHalfAModelWithoutASearch) {
  const Ball b = ball(3);
  const Sphere sphere(Vector3(3, 0, 0), 3);
  const Cylinder cylinder(Vector3(2.5, 0, 0), Vector3::UnitZ(), 2.5);
  const ObliquePlane oblique(Vector3::UnitX(), 0.1, Vector3(1, 0.3, 0.2));
  for (const Mirror* mirror :
       std::initializer_list<const Mirror*>{&middle, &sphere, &cylinder, &oblique}) {
    const Half half = half_of(b.points, b.faces, *mirror, true, {});
    const MirroredHalf expected = with_image(half, *mirror, {});
    const OperationResult whole = operate("complete", {half.points, half.faces}, *mirror, image);
    expect_input_untouched(whole, half.points, half.faces);
    EXPECT_EQ(whole.points, expected.points) << mirror->kind();
    EXPECT_EQ(whole.faces, expected.faces) << mirror->kind();
    EXPECT_EQ(open_edges(whole.faces), 0) << mirror->kind();
    EXPECT_EQ(TriangleMesh(whole.points, whole.faces).refused().total(), 0) << mirror->kind();
    EXPECT_GT(volume(whole.points, whole.faces), volume(half.points, half.faces));
    EXPECT_FALSE(whole.statistics.contains("warning")) << mirror->kind();
  }
}

TEST(Complete, LooksForNothingWithoutASearch) {
  const Ball b = ball(3);
  const OperationResult both = operate("complete", {b.points, b.faces}, middle, image);
  EXPECT_EQ(both.faces.rows(), 2 * b.faces.rows());
  EXPECT_NE(std::get<std::string>(both.statistics.at("warning")).find("other side"),
            std::string::npos);
  const OperationResult cloud = operate("complete", {b.points}, middle, image);
  EXPECT_EQ(cloud.points, both.points);
  // A face within the mirror is its own image.
  const OperationResult half = operate("cut", {b.points, b.faces}, middle);
  const auto cap = static_cast<Index>(half.face_arrays.at("cap").sum());
  const OperationResult whole = operate("complete", {half.points, half.faces}, middle, image);
  EXPECT_EQ(count(whole, "added_faces"), half.faces.rows() - cap);
  EXPECT_NE(std::get<std::string>(whole.statistics.at("warning")).find(std::to_string(cap)),
            std::string::npos);
  expect_error<InvalidInput>("have no image", [&] {
    operate("complete", {b.points, b.faces}, Sphere(Vector3(1.2, 0, 0), 0.75), image);
  });
  expect_error<InvalidParameter>("search is false", [&] {
    operate("complete", {b.points}, middle, {{"search", false}, {"symmetry", "axis"}});
  });
}

// No side is its own counterpart, however near to the mirror it is.
TEST(Complete, GivesAHalfItsExactImage) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const double width : {1.0, 0.05, 1e-3}) {
      Ball b = ball(seed);
      b.points.col(0) *= width;
      const OperationResult half = operate("cut", {b.points, b.faces}, middle, {{"capped", false}});
      const OperationResult asymmetry = operate("asymmetry", {half.points, half.faces}, middle);
      EXPECT_EQ(asymmetry.arrays.at("matched"), half.arrays.at("on_mirror"));
      const OperationResult whole = operate("complete", {half.points, half.faces}, middle);
      expect_input_untouched(whole, half.points, half.faces);
      EXPECT_EQ(whole.faces.rows(), 2 * half.faces.rows());
      EXPECT_EQ(open_edges(whole.faces), 0);
      for (Index i = half.points.rows(); i < whole.points.rows(); ++i)
        EXPECT_EQ(Vector3(whole.points.row(i)),
                  middle.reflect(Vector3(half.points.row(whole.point_sources[i]))));
    }
}

// Where a mesh of single precision is cut through its vertices, faces thinner than rounding lie
// between the rim and points beside it.
TEST(Complete, GivesAHalfWithSliversItsExactImage) {
  const Ball b = ball(4);
  OperationResult half = operate("cut", {b.points, b.faces}, middle, {{"capped", false}});
  const Index count = half.points.rows(), faces = half.faces.rows();
  std::vector<std::array<Index, 3>> all;
  std::vector<Vector3> inside;
  for (const auto& face : half.faces.rowwise()) {
    const auto on = [&](int k) { return half.arrays.at("on_mirror")(face[k % 3], 0) > 0; };
    int k = 0;
    while (k < 3 && !(on(k) && on(k + 1))) ++k;
    if (k == 3) {
      all.push_back({face[0], face[1], face[2]});
      continue;
    }
    const Index p = face[k], q = face[(k + 1) % 3], r = face[(k + 2) % 3];
    const auto v = count + static_cast<Index>(inside.size());
    inside.push_back((half.points.row(p) + half.points.row(q)).transpose() / 2);
    inside.back().x() += 1e-8;
    for (const auto& own : {std::array{p, q, v}, std::array{q, r, v}, std::array{r, p, v}})
      all.push_back(own);
  }
  ASSERT_GT(inside.size(), 8u);
  Points points(count + static_cast<Index>(inside.size()), 3);
  points << half.points, rows_of(inside);
  const Triangles slivered = rows_of(all);
  ASSERT_EQ(slivered.rows(), faces + 2 * static_cast<Index>(inside.size()));
  const OperationResult whole = operate("complete", {points, slivered}, middle);
  EXPECT_EQ(whole.faces.rows(), 2 * slivered.rows());
  EXPECT_EQ(open_edges(whole.faces), 0);
}

TEST(Complete, FindsNoCounterpartsWithinHalfACloud) {
  const Ball b = ball(1);
  for (const double width : {1.0, 0.5}) {
    std::vector<Index> positive;
    for (Index i = 0; i < b.points.rows(); ++i)
      if (b.points(i, 0) > 0) positive.push_back(i);
    Points half = b.points(positive, Eigen::indexing::all);
    half.col(0) *= width;
    const OperationResult whole = operate("complete", {half, {}}, middle);
    const std::set<Index> added(whole.point_sources.begin() + half.rows(),
                                whole.point_sources.end());
    const double spacing = 2 * std::numbers::pi / 48;
    for (Index i = 0; i < half.rows(); ++i)
      if (half(i, 0) > 2 * spacing) EXPECT_TRUE(added.contains(i)) << half.row(i);
  }
}

// Of a prism, whose faces are as long as it and need not mirror, an upper part of one side is lost.
TEST(Complete, ClosesWhatHasLongFaces) {
  for (const bool mirrors : {true, false})
    for (const int sides : {24, 48, 96})
      for (const int rings : {2, 3, 20}) {
        const int count = sides * rings;
        Points points(count + 2, 3);
        points.bottomRows(2) << 0, 0, 0, 0, 0, 1.5;
        std::vector<std::array<Index, 3>> faces;
        const auto add = [&](Index a, Index b, Index c) {
          for (const Index i : {a, b, c}) {
            const double turn = (static_cast<double>(i % sides) + 0.5) / sides;
            if (i < count && std::min(turn, 1 - turn) < 0.05 && i / sides >= rings / 2) return;
          }
          faces.push_back({a, b, c});
        };
        for (int k = 0; k < sides; ++k) {
          const int next = (k + 1) % sides, quarter = mirrors ? k % (sides / 2) / (sides / 4) : 0;
          const double angle = 2 * std::numbers::pi * (k + 0.5) / sides;
          const double radius = 1 + 0.25 * ((k + quarter) % 2);
          add(count, next, k);
          add(count + 1, count - sides + k, count - sides + next);
          for (int ring = 0; ring < rings; ++ring) {
            points.row(ring * sides + k) << radius * std::cos(angle),
                0.8 * radius * std::sin(angle), 1.5 * ring / (rings - 1);
            if (ring == 0) continue;
            const Index below = (ring - 1) * sides, above = ring * sides;
            add(below + k, below + next, above + next);
            add(below + k, above + next, above + k);
          }
        }
        const Triangles kept = rows_of(faces);
        EXPECT_GT(open_edges(kept), 0);
        const OperationResult whole = operate("complete", {points, kept}, middle);
        EXPECT_EQ(open_edges(whole.faces), 0)
            << sides << " sides, " << rings << " rings" << (mirrors ? ", mirrored" : "");
      }
}

TEST(Complete, AddsNothingWhereBothSidesExist) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Ball b = ball(seed);
    const Vector3 top = Vector3(1, 0.4, 0.2).normalized();
    for (Index i = 0; i < b.points.rows(); ++i) {
      const Vector3 x = b.points.row(i).transpose();
      b.points.row(i) *= 1 + 0.1 * std::exp(-8 * (x.normalized() - top).squaredNorm());
    }
    EXPECT_EQ(count(operate("complete", {b.points, b.faces}, middle), "added_points"), 0);
    // A hole over the mirror, which neither side fills.
    const Triangles faces =
        kept_faces(b, [](const Vector3& x) { return (x - Vector3(0, 0, 1)).norm() < 0.5; });
    const OperationResult open = operate("complete", {b.points, faces}, middle);
    EXPECT_EQ(count(open, "added_faces"), 0) << seed;
  }
}

// A sphere that one side is a hundredth larger than the other: the images end a step off the rim.
TEST(Complete, BendsWhatItAddsToMeetTheShape) {
  Ball b = ball(0);
  for (Index i = 0; i < b.points.rows(); ++i) {
    b.points.row(i).normalize();
    if (b.points(i, 0) > 0) b.points.row(i) *= 1 + 0.03 * std::min(1.0, 4 * b.points(i, 0));
  }
  const Triangles faces =
      kept_faces(b, [](const Vector3& x) { return (x - Vector3(1, 0, 0)).norm() < 0.5; });
  const auto farthest = [&](double blend) {
    const OperationResult result =
        operate("complete", {b.points, faces}, middle, {{"blend", blend}});
    double sum = 0;
    for (Index i = b.points.rows(); i < result.points.rows(); ++i)
      if (result.arrays.at("origin")(i, 0) == 2)
        sum = std::max(sum, std::abs(result.points.row(i).norm() - 1.03));
    return sum;
  };
  EXPECT_GT(farthest(0), 0.025);
  EXPECT_LT(farthest(0.2), 0.005);
}

TEST(Complete, FillsHolesAloneWhereAsked) {
  const Ball b = ball(1);
  // Both sides have an open end, the right one before the left one, and the right one has a hole.
  const auto lost = [](const Vector3& x) {
    return x.x() > 0.7 || (x - Vector3(0.2, 0, 1)).norm() < 0.2 || x.x() < -0.95;
  };
  const Triangles faces = kept_faces(b, lost);
  const OperationResult all = operate("complete", {b.points, faces}, middle);
  const OperationResult holes = operate("complete", {b.points, faces}, middle, {{"fill", "holes"}});
  EXPECT_GT(count(holes, "added_points"), 0);
  EXPECT_GT(count(all, "added_points"), count(holes, "added_points"));
  for (Index i = b.points.rows(); i < holes.points.rows(); ++i)
    EXPECT_LT((holes.points.row(i).transpose() - Vector3(0.2, 0, 1)).norm(), 0.2);
}

// Without one vertex and the faces around it: no image of a face has room in the hole.
TEST(Complete, ClosesHolesOfAFewFaces) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = ball(seed);
    RandomCloud random(seed);
    Index lost = random.below(b.points.rows());
    while (b.points(lost, 0) < 0.3) lost = random.below(b.points.rows());
    const Vector3 place = b.points.row(lost).transpose();
    const Triangles faces = kept_faces(b, [&](const Vector3& x) { return x == place; });
    const OperationResult result = operate("complete", {b.points, faces}, middle);
    EXPECT_GT(count(result, "seam_faces"), 0);
    EXPECT_EQ(TriangleMesh(result.points, result.faces).boundary_loops().size(), 0u) << seed;
    // On both sides alike: nothing says that it is not meant to be there.
    const Vector3 image = place.cwiseProduct(Vector3(-1, 1, 1));
    const Triangles even =
        kept_faces(b, [&](const Vector3& x) { return x == place || x == image; });
    EXPECT_EQ(operate("complete", {b.points, even}, middle).faces.rows(), even.rows()) << seed;
  }
}

TEST(Complete, LeavesTheSeamOpenWhereAsked) {
  const Ball b = ball(2);
  const Triangles faces =
      kept_faces(b, [](const Vector3& x) { return (x - Vector3(1, 0, 0)).norm() < 0.5; });
  const OperationResult result =
      operate("complete", {b.points, faces}, middle, {{"close_seam", false}});
  EXPECT_EQ(count(result, "seam_faces"), 0);
  EXPECT_EQ(TriangleMesh(result.points, result.faces).boundary_loops().size(), 2u);
}

TEST(Complete, FillsTheHoleOfACloud) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Points points = RandomCloud(seed).sphere(4000) * Vector3(1, 1.4, 0.8).asDiagonal();
    EXPECT_EQ(count(operate("complete", {points}, middle), "added_points"), 0) << seed;
    const auto is_lost = [](const Vector3& x) { return (x - Vector3(1, 0, 0)).norm() < 0.5; };
    const double spacing = std::sqrt(4 * std::numbers::pi / 4000);
    std::vector<Vector3> kept;
    Index lost = 0;
    for (const auto& x : points.rowwise()) {
      if (!is_lost(x.transpose())) kept.push_back(x.transpose());
      lost += is_lost(Vector3(-x.x(), x.y(), x.z()));
    }
    const Points cut = rows_of(kept);
    const OperationResult result = operate("complete", {cut}, middle);
    expect_input_untouched(result, cut, Triangles(0, 3));
    EXPECT_NEAR(static_cast<double>(count(result, "added_points")), static_cast<double>(lost),
                0.25 * static_cast<double>(lost));
    for (Index i = cut.rows(); i < result.points.rows(); ++i)
      EXPECT_LT((result.points.row(i).transpose() - Vector3(1, 0, 0)).norm(), 0.5 + spacing)
          << seed;
  }
}

// Beyond the centre of a sphere points have no image, and still can lie far from the mirrored
// surface. Found by fuzzing.
TEST(Complete, AddsNoImagesWhereThereAreNone) {
  for (std::uint64_t seed = 0; seed < 4 * seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.sphere(52);
    Triangles faces(33, 3);
    for (Index f = 0; f < faces.rows(); ++f)
      for (int c = 0; c < 3; ++c) faces(f, c) = random.below(points.rows());
    const Sphere sphere(Vector3(0, -1.5, 2), 1.7);
    for (const TrianglesView& given : {TrianglesView(faces), TrianglesView()})
      EXPECT_TRUE(operate("complete", {points, given}, sphere, {{"max_distance", 0.01}})
                      .points.allFinite());
  }
}

}  // namespace
}  // namespace symsurf::completion_tests
