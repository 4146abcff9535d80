// The candidates' numbers as the hosts hand them on, a row each.

#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

namespace symsurf::candidate_values_tests {

namespace {

Result scored(std::shared_ptr<Mirror> mirror, double score) {
  Result result;
  result.mirror = std::move(mirror);
  result.score = score;
  return result;
}

TEST(CandidateValues, AreNoneWithoutCandidates) {
  EXPECT_TRUE(candidate_values(scored(std::make_shared<Plane>(Vector3(1, 0, 0), 2), 1)).empty());
}

TEST(CandidateValues, OfPlanesHaveNormalsAndOffsets) {
  Result result;
  result.candidates.push_back(scored(std::make_shared<Plane>(Vector3(0, 2, 0), 4), 0.9));
  result.candidates.push_back(scored(std::make_shared<Plane>(Vector3(0, 0, 1), -1), 0.5));
  const Values values = candidate_values(result);
  EXPECT_EQ(std::get<Eigen::MatrixXd>(values.at("candidate_scores")),
            (Eigen::MatrixXd(2, 1) << 0.9, 0.5).finished());
  EXPECT_EQ(std::get<Eigen::MatrixXd>(values.at("candidate_normals")),
            (Eigen::MatrixXd(2, 3) << 0, 1, 0, 0, 0, 1).finished());
  EXPECT_EQ(std::get<Eigen::MatrixXd>(values.at("candidate_offsets")),
            (Eigen::MatrixXd(2, 1) << 2, -1).finished());
}

TEST(CandidateValues, OfOthersHaveScoresAlone) {
  Result result;
  result.candidates.push_back(scored(std::make_shared<Sphere>(Vector3(0, 2, 0), 4), 0.9));
  const Values values = candidate_values(result);
  EXPECT_EQ(values.size(), 1u);
  EXPECT_EQ(std::get<Eigen::MatrixXd>(values.at("candidate_scores"))(0, 0), 0.9);
}

}  // namespace

}  // namespace symsurf::candidate_values_tests
