// Links the heart alone, without the satellites and the lists of the top layer.
#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <vector>

#include "detection/pipeline.h"
#include "operations/operation.h"

namespace symsurf {
namespace {

// The points of a lattice on the faces of a unit cube, in the order of a mesh.
Points cube(int cells) {
  std::vector<Vector3> points;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j)
      for (int k = 0; k <= cells; ++k)
        if (i % cells == 0 || j % cells == 0 || k % cells == 0)
          points.push_back(Vector3(i, j, k) / cells);
  Points rows(points.size(), 3);
  for (Index i = 0; i < rows.rows(); ++i) rows.row(i) = points[i].transpose();
  return rows;
}

TEST(HeartAlone, FindsThePlaneOfACube) {
  const Points points = cube(12);
  const MethodImplementation& plane = heart_method("plane");
  const Result result =
      detect_in_one(points, Options(), plane, {plane.name, plane.parameters, {}}, Context());
  EXPECT_EQ(result.verdict(), "found");
  ASSERT_TRUE(result.mirror);
  const Points images = result.mirror->reflect(points);
  for (const auto& image : images.rowwise())
    EXPECT_LT((points.rowwise() - image).rowwise().norm().minCoeff(), 1e-9);
}

TEST(HeartAlone, CompletesHalfOfACube) {
  const Points whole = cube(12);
  std::vector<Index> half;
  for (Index i = 0; i < whole.rows(); ++i)
    if (whole(i, 0) < 0.55) half.push_back(i);
  const Points points = whole(half, Eigen::indexing::all);
  const Plane middle(Vector3::UnitX(), -0.5);
  const OperationResult result =
      run_operation(complete_operation(), {points}, &middle, {}, Context());
  const Index added = result.points.rows() - points.rows();
  EXPECT_NEAR(static_cast<double>(added), static_cast<double>(whole.rows() - points.rows()),
              0.1 * static_cast<double>(whole.rows()));
  for (const auto& x : result.points.bottomRows(added).rowwise())
    EXPECT_LT((whole.rowwise() - x).rowwise().norm().minCoeff(), 0.5 / 12);
}

}  // namespace
}  // namespace symsurf
