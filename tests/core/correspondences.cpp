#include <gtest/gtest.h>
#include <symsurf/operations.h>

#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "bumpy_ball.h"
#include "figure.h"
#include "random_cloud.h"

namespace symsurf::correspondences_tests {
namespace {

TEST(Correspondences, AreExactWhereVerticesMirror) {
  const Ball b = ball(5);
  for (const bool bent : {false, true})
    for (const bool has_faces : {true, false}) {
      const Points points = bent ? wrapped(b.points) : b.points;
      const Mirror& mirror = bent ? static_cast<const Mirror&>(round_mirror) : middle;
      const OperationResult result =
          operate("correspondences", {points, has_faces ? b.faces : TrianglesView()}, mirror,
                  {{"one_to_one", true}});
      EXPECT_EQ(figure(result, "paired_share"), 1);
      for (Index i = 0; i < points.rows(); ++i) {
        EXPECT_EQ(result.arrays.at("index")(i, 0), static_cast<double>(b.partner[i]));
        EXPECT_GT(result.arrays.at("confidence")(i, 0), 0.9);
      }
    }
}

TEST(Correspondences, NeedNoWindingWhereVerticesMirror) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = mirrored_without_turning(seed);
    for (const double max_angle : {0.0, 60.0}) {
      const OperationResult result =
          operate("correspondences", {b.points, b.faces}, middle, {{"max_angle", max_angle}});
      EXPECT_EQ(figure(result, "paired_share"), 1);
      EXPECT_EQ(figure(result, "unmatched_share"), 0);
      for (Index i = 0; i < b.points.rows(); ++i) {
        EXPECT_EQ(result.arrays.at("index")(i, 0), static_cast<double>(b.partner[i]));
        EXPECT_GT(result.arrays.at("confidence")(i, 0), 0.9);
      }
    }
  }
}

// A place lies on a face by weights that sum to 1, also on one that names a corner twice.
TEST(Correspondences, HaveWeightsOfOneFace) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = ball(seed);
    Triangles faces = b.faces;
    for (Index f = 0; f < faces.rows(); f += 5) faces(f, 1) = faces(f, 0);
    for (const char* pairing : {"closest", "homologous"}) {
      const OperationResult result =
          operate("correspondences", {b.points, faces}, middle, {{"pairing", pairing}});
      const Eigen::VectorXd face = result.arrays.at("face"),
                            sums = result.arrays.at("weights").rowwise().sum();
      for (Index i = 0; i < face.size(); ++i)
        if (face[i] >= 0) EXPECT_NEAR(sums[i], 1, 1e-12);
    }
  }
}

// Each face with corners of its own, in an order of their own; or corners split where the fields
// of a checkerboard meet, as the seams of textures split them.
TEST(Correspondences, AreOneToOneOfSplitVertices) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball half = mirrored_without_turning(seed);
    const Index faces = half.faces.rows();
    RandomCloud random(seed);
    for (const bool is_soup : {true, false}) {
      std::vector<Index> order(faces);
      std::iota(order.begin(), order.end(), 0);
      for (Index k = faces - 1; k > 0; --k) std::swap(order[k], order[random.below(k + 1)]);
      std::map<std::pair<Index, Index>, Index> split;  // by vertex and field
      std::vector<Vector3> points;
      Triangles triangles(faces, 3);
      for (const Index f : order) {
        const Index on_one_side = f % (faces / 2);
        for (int c = 0; c < 3; ++c) {
          const Index corner = half.faces(f, f < faces / 2 ? c : 2 - c);
          const auto [at, is_new] =
              split.try_emplace({corner, is_soup ? on_one_side : on_one_side / 40},
                                static_cast<Index>(points.size()));
          if (is_new) points.push_back(half.points.row(corner).transpose());
          triangles(f, c) = at->second;
        }
      }
      Points rows(static_cast<Index>(points.size()), 3);
      for (Index i = 0; i < rows.rows(); ++i) rows.row(i) = points[i].transpose();
      const OperationResult result =
          operate("correspondences", {rows, triangles}, middle, {{"one_to_one", true}});
      EXPECT_EQ(figure(result, "paired_share"), 1) << seed << ' ' << is_soup;
      const Eigen::MatrixXd& index = result.arrays.at("index");
      for (Index f = 0; f < faces / 2; ++f)
        for (int c = 0; c < 3; ++c)
          EXPECT_EQ(index(triangles(f, c), 0),
                    static_cast<double>(triangles(f + faces / 2, 2 - c)));
    }
  }
}

}  // namespace
}  // namespace symsurf::correspondences_tests
