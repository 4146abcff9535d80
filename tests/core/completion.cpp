#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "bumpy_ball.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/triangle_mesh.h"
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
