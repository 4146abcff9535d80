#include "symmetries/intrinsic/intrinsic_symmetry.h"

#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "cloud/point_tree.h"
#include "limbed_body.h"
#include "random_cloud.h"

namespace symsurf::intrinsic_symmetry_tests {
namespace {

struct Error {
  double mean = 0;   // distance along edges from images to where they belong, in the longest
  double moved = 0;  // that of the points themselves: what the identity would leave
};

Error error_of(const LimbedBody& body, const Eigen::MatrixXd& images) {
  const ConnectedSurface surface = connected_surface(body.points, body.faces, Context());
  constexpr Index checked = 100;
  Error error;
  double longest = 0, count = 0;
  for (Index i = 0; i < body.points.rows(); i += body.points.rows() / checked) {
    const Eigen::VectorXd away = edge_distances(surface, body.mirrored[i]);
    longest = std::max(longest, away.maxCoeff());
    error.mean += images(i) < 0 ? away.maxCoeff() : away[static_cast<Index>(images(i))];
    error.moved += away[i];
    ++count;
  }
  error.mean /= count * longest;
  error.moved /= count * longest;
  return error;
}

std::string verdict(const AnalysisResult& result) {
  return std::get<std::string>(result.statistics.at("verdict"));
}

AnalysisResult of_mesh(const LimbedBody& body) {
  AnalysisOptions options;
  options.faces = body.faces;
  return analyse("intrinsic_symmetry", body.points, options);
}

TEST(IntrinsicSymmetry, MapsLeftToRightWhateverThePose) {
  for (std::uint64_t seed = 0; seed < draws(3); ++seed) {
    const LimbedBody body = posed_animal(seed);
    const AnalysisResult result = of_mesh(body);
    EXPECT_EQ(verdict(result), "found") << seed;
    const Error error = error_of(body, result.arrays.at("image"));
    EXPECT_LT(error.mean, 0.03) << seed;
    EXPECT_GT(error.moved, 0.1) << seed;
  }
}

TEST(IntrinsicSymmetry, NeedsNoFaces) {
  for (std::uint64_t seed = 0; seed < draws(2); ++seed) {
    const LimbedBody body = posed_animal(seed);
    const AnalysisResult result = analyse("intrinsic_symmetry", body.points);
    EXPECT_EQ(verdict(result), "found") << seed;
    EXPECT_LT(error_of(body, result.arrays.at("image")).mean, 0.03) << seed;
  }
}

// More points than are searched.
TEST(IntrinsicSymmetry, CarriesTheImagesOfAThinnedSurface) {
  const LimbedBody body = posed_animal(0);
  const Index count = body.points.rows();
  RandomCloud random(0);
  Points points(count + 25'000, 3);
  points.topRows(count) = body.points;
  for (Index i = count; i < points.rows(); ++i) {
    const Index f = random.below(body.faces.rows());
    const double s = random.uniform(0, 1), t = random.uniform(0, 1 - s);
    points.row(i) = s * body.points.row(body.faces(f, 0)) + t * body.points.row(body.faces(f, 1)) +
                    (1 - s - t) * body.points.row(body.faces(f, 2));
  }
  const AnalysisResult result = analyse("intrinsic_symmetry", points);
  EXPECT_EQ(verdict(result), "found");
  const PointTree vertices(body.points);
  Eigen::MatrixXd images = result.arrays.at("image").topRows(count);
  for (double& image : images.reshaped())
    image = static_cast<double>(vertices.nearest(points.row(static_cast<Index>(image))).index);
  EXPECT_LT(error_of(body, images).mean, 0.03);
}

TEST(IntrinsicSymmetry, DoesNotDependOnPoseUnitAndOrder) {
  RandomCloud random(0);
  const LimbedBody body = posed_animal(1);
  LimbedBody other = body;
  std::vector<Index> order(body.points.rows()), place(body.points.rows());
  std::iota(order.begin(), order.end(), Index{0});
  for (Index i = body.points.rows() - 1; i > 0; --i)
    std::swap(order[i], order[random.below(i + 1)]);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<Index>(i);
  other.points = 1e3 * body.points(order, Eigen::indexing::all) * random.rotation().transpose();
  other.faces = body.faces.unaryExpr([&](Index v) { return place[v]; });
  for (std::size_t i = 0; i < order.size(); ++i) other.mirrored[i] = place[body.mirrored[order[i]]];
  const Eigen::MatrixXd one = of_mesh(body).arrays.at("image");
  const Eigen::MatrixXd two = of_mesh(other).arrays.at("image");
  EXPECT_LT(error_of(other, two).mean, 0.03);
  Eigen::MatrixXd carried(one.rows(), 1);
  for (Index i = 0; i < one.rows(); ++i)
    carried(i) = static_cast<double>(place[static_cast<Index>(one(order[i]))]);
  LimbedBody expected = other;
  for (Index i = 0; i < one.rows(); ++i) expected.mirrored[i] = static_cast<Index>(carried(i));
  EXPECT_LT(error_of(expected, two).mean, 0.01);
}

TEST(IntrinsicSymmetry, TakesTheLargestPartAndFacesOfAnyKind) {
  LimbedBody body = posed_animal(2);
  const Index count = body.points.rows(), faces = body.faces.rows();
  // Triangles whose corners are their own, a small part apart, a point of no face, and a face that
  // is a third at an edge.
  Points points(3 * faces + 5, 3);
  Triangles corners(faces + 2, 3);
  for (Index f = 0; f < faces; ++f)
    for (int c = 0; c < 3; ++c) {
      points.row(3 * f + c) = body.points.row(body.faces(f, c));
      corners(f, c) = 3 * f + c;
    }
  points.bottomRows(5) << 50, 50, 50, 51, 50, 50, 50, 51, 50, 60, 60, 60,
      points.row(0) + 0.5 * Vector3(1, 1, 1).transpose();
  corners.row(faces) << 3 * faces, 3 * faces + 1, 3 * faces + 2;
  corners.row(faces + 1) << 0, 1, 3 * faces + 4;
  AnalysisOptions options;
  options.faces = corners;
  const AnalysisResult result = analyse("intrinsic_symmetry", points, options);
  EXPECT_EQ(verdict(result), "found");
  EXPECT_EQ(std::get<Index>(result.statistics.at("parts")), 2);
  const Eigen::MatrixXd& images = result.arrays.at("image");
  EXPECT_EQ(images(3 * faces), -1);
  EXPECT_EQ(images(3 * faces + 3), -1);
  EXPECT_EQ(result.arrays.at("confidence")(3 * faces), 0);
  Eigen::MatrixXd merged(count, 1);
  for (Index f = 0; f < faces; ++f)
    for (int c = 0; c < 3; ++c) {
      const auto corner = static_cast<Index>(images(3 * f + c));
      // The point beside the edge stands for a corner of it.
      merged(body.faces(f, c)) = static_cast<double>(
          corner < 3 * faces ? body.faces(corner / 3, corner % 3) : body.faces(0, 0));
    }
  EXPECT_LT(error_of(body, merged).mean, 0.03);
}

// Front and hind part as meshes of their own, a twentieth of an edge apart.
TEST(IntrinsicSymmetry, JoinsPartsThatTouch) {
  LimbedBody body = posed_animal(0);
  const Index count = body.points.rows();
  Points points(2 * count, 3);
  points << body.points, (body.points.array() + 0.05).matrix();
  std::vector<Index> place(count);  // of each vertex, in the last part that has it
  Triangles corners = body.faces;
  for (Index f = 0; f < corners.rows(); ++f) {
    double y = 0;
    for (int c = 0; c < 3; ++c) y += body.points(body.faces(f, c), 1) / 3;
    for (int c = 0; c < 3; ++c) {
      if (y < 8) corners(f, c) += count;
      place[body.faces(f, c)] = corners(f, c);
    }
  }
  AnalysisOptions options;
  options.faces = corners;
  const AnalysisResult result = analyse("intrinsic_symmetry", points, options);
  EXPECT_EQ(verdict(result), "found");
  EXPECT_EQ(std::get<Index>(result.statistics.at("parts")), 1);
  Eigen::MatrixXd images(count, 1);
  for (Index v = 0; v < count; ++v) {
    const auto image = static_cast<Index>(result.arrays.at("image")(place[v]));
    images(v) = static_cast<double>(image < 0 ? image : image % count);
  }
  EXPECT_LT(error_of(body, images).mean, 0.03);
}

// A pair of balls beside a trunk that stands still; a scan's holes cut off such parts.
TEST(IntrinsicSymmetry, MapsPartsBesideTheBody) {
  const LimbedBody body = standing_animal();
  const Index count = body.points.rows(), added = 40;
  RandomCloud random(0);
  Points points(count + 2 * added, 3);
  points.topRows(count) = body.points;
  for (Index i = 0; i < added; ++i) {
    points.row(count + i) = (Vector3(12, 10, 3) + random.direction()).transpose();
    points.row(count + added + i) =
        points.row(count + i).cwiseProduct(Vector3(-1, 1, 1).transpose());
  }
  const AnalysisResult result = analyse("intrinsic_symmetry", points);
  EXPECT_EQ(verdict(result), "found");
  EXPECT_GE(std::get<Index>(result.statistics.at("parts")), 3);
  const Eigen::MatrixXd& images = result.arrays.at("image");
  double away = 0;
  for (Index i = 0; i < added; ++i) {
    ASSERT_GE(images(count + i), 0);
    away +=
        (points.row(static_cast<Index>(images(count + i))) - points.row(count + added + i)).norm();
  }
  EXPECT_LT(away / added, 0.5);  // half the radius of a ball
}

// A leaf's patches are flat, or rolled up: turns fit them about as well as reflections.
TEST(IntrinsicSymmetry, FindsTheMiddleOfASheet) {
  for (const double roll : {0.0, 1.0}) {
    RandomCloud random(1);
    const Index half = 1000;
    Points flat(2 * half, 3);
    for (Index i = 0; i < half;) {
      const double x = random.uniform(0, 3), y = random.uniform(0.01, 1);
      if (y > 0.9 * std::sin(std::numbers::pi * std::pow(x / 3, 0.7)) * (1 - 0.2 * x / 3)) continue;
      flat.row(i) << x, y, 0;
      flat.row(half + i++) << x, -y, 0;
    }
    Points points = flat;
    for (Index i = 0; i < points.rows() && roll > 0; ++i) {  // about a line aslant
      const double u = (flat(i, 0) + flat(i, 1)) / std::sqrt(2.0),
                   v = (flat(i, 0) - flat(i, 1)) / std::sqrt(2.0);
      points.row(i) << std::sin(roll * u) / roll, v, (1 - std::cos(roll * u)) / roll;
    }
    const AnalysisResult result = analyse("intrinsic_symmetry", points);
    ASSERT_EQ(verdict(result), "found") << roll;
    double away = 0;
    for (Index i = 0; i < points.rows(); ++i) {
      const auto image = static_cast<Index>(result.arrays.at("image")(i));
      away += (flat.row(image) - flat.row((i + half) % points.rows())).norm();
    }
    EXPECT_LT(away / static_cast<double>(points.rows()), 0.03) << roll;
  }
}

// Any plane through its middle mirrors a ball: no function's sign is determined.
TEST(IntrinsicSymmetry, SaysNoneOfABall) {
  Points points(3000, 3);
  for (Index i = 0; i < points.rows(); ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(points.rows());
    const double turn = 2.399963229728653 * static_cast<double>(i);
    points.row(i) << std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn),
        z;
  }
  const AnalysisResult result = analyse("intrinsic_symmetry", points);
  EXPECT_EQ(verdict(result), "none");
  EXPECT_EQ(result.arrays.at("image").maxCoeff(), -1);
  EXPECT_NE(std::get<std::string>(result.statistics.at("reason")).find("ball"), std::string::npos);
}

TEST(IntrinsicSymmetry, IsTheSameForAnyNumberOfThreads) {
  const LimbedBody body = posed_animal(3);
  AnalysisOptions options;
  options.faces = body.faces;
  const auto images = [&](int threads) -> Eigen::MatrixXd {
    return analyse("intrinsic_symmetry", body.points, options, Context({}, threads))
        .arrays.at("image");
  };
  EXPECT_EQ(images(1), images(3));
}

TEST(IntrinsicSymmetry, AnswersForFewPoints) {
  for (Index count = 4; count < 40; count += 5) {
    const Points points = RandomCloud(static_cast<std::uint64_t>(count)).box(count);
    const AnalysisResult result = analyse("intrinsic_symmetry", points);
    EXPECT_TRUE(result.arrays.at("confidence").allFinite());
    EXPECT_LT(result.arrays.at("image").maxCoeff(), static_cast<double>(count));
  }
}

// Most of the points lie nearer to each other than the numbers of the others resolve.
TEST(IntrinsicSymmetry, TakesPointsThatCrowd) {
  for (std::uint64_t seed = 0; seed < draws(60); ++seed) {
    RandomCloud random(seed);
    Points points(20 + static_cast<Index>(seed), 3);
    for (double& x : points.reshaped()) x = std::pow(10.0, random.uniform(-30, 0));
    try {
      const AnalysisResult result = analyse("intrinsic_symmetry", points, {});
      for (const auto& [name, array] : result.arrays) EXPECT_TRUE(array.allFinite()) << name;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("area"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace symsurf::intrinsic_symmetry_tests
