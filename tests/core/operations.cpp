#include <gtest/gtest.h>
#include <symsurf/cylinder.h>
#include <symsurf/errors.h>
#include <symsurf/operation.h>
#include <symsurf/plane.h>
#include <symsurf/sphere.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "bumpy_ball.h"
#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

double diagonal(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

double figure(const OperationResult& result, const std::string& name) {
  return std::get<double>(result.statistics.at(name));
}

TEST(Operations, AreDescribed) {
  for (const Operation& each : operations()) {
    EXPECT_FALSE(each.title.empty() || each.summary.empty()) << each.name;
    const Ball b = ball(0);
    const OperationResult result = operate(each.name, {b.points, b.faces}, middle);
    ASSERT_EQ(result.arrays.size(), each.arrays.size()) << each.name;
    for (const PointArray& array : each.arrays) {
      EXPECT_EQ(result.arrays.at(array.name).rows(), b.points.rows()) << array.name;
      EXPECT_EQ(result.arrays.at(array.name).cols(), array.components) << array.name;
    }
    EXPECT_EQ(result.faces, b.faces);
    if (!each.moves_points) {
      EXPECT_EQ(result.points, b.points);
    }
  }
}

TEST(Asymmetry, IsZeroWhateverTheTriangulation) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = ball(seed);
    const OperationResult flat = operate("asymmetry", {b.points, b.faces}, middle);
    EXPECT_EQ(figure(flat, "matched_share"), 1);
    EXPECT_LE(figure(flat, "maximum_of_diagonal"), 1e-12) << seed;
    EXPECT_NEAR(figure(flat, "area_index"), 0, 0.01);
    EXPECT_NEAR(figure(flat, "volume_index"), 0, 0.01);
    const OperationResult bent = operate("asymmetry", {wrapped(b.points), b.faces}, round_mirror);
    EXPECT_EQ(figure(bent, "matched_share"), 1);
    EXPECT_LE(figure(bent, "maximum_of_diagonal"), 1e-12) << seed;
  }
}

// A bump on the positive side, as high as `height` where it is highest.
Points bumped(const Points& points, double height, Eigen::VectorXd& raised) {
  const Vector3 top = Vector3(1, 0.5, 0.3).normalized();
  Points out = points;
  raised = Eigen::VectorXd::Zero(points.rows());
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 x = points.row(i).transpose(), u = x.normalized();
    const double off = (u - top).squaredNorm() / 0.3;
    if (off >= 1) continue;
    raised[i] = height * (1 - off) * (1 - off);
    out.row(i) += raised[i] * u.transpose();
  }
  return out;
}

TEST(Asymmetry, IsAsHighAsABumpAndNothingElsewhere) {
  const Ball b = ball(1);
  Eigen::VectorXd raised;
  const Points with_bump = bumped(b.points, 0.05, raised);
  Index highest;
  ASSERT_GT(raised.maxCoeff(&highest), 0.04);
  for (const bool bent : {false, true}) {
    const Mirror& mirror = bent ? static_cast<const Mirror&>(round_mirror) : middle;
    const Points points = bent ? wrapped(with_bump) : with_bump;
    const OperationResult result = operate("asymmetry", {points, b.faces}, mirror);
    const Eigen::MatrixXd &distance = result.arrays.at("distance"),
                          &outward = result.arrays.at("signed");
    const Points flat = bent ? wrapped(b.points) : b.points;
    const double height = (points.row(highest) - flat.row(highest)).norm();
    EXPECT_NEAR(outward(highest, 0), -height, 0.05 * height) << bent;
    EXPECT_NEAR(distance(highest, 0), height, 0.05 * height) << bent;
    for (Index i = 0; i < points.rows(); ++i) {
      if (raised[i] == 0 && raised[b.partner[i]] == 0) {
        EXPECT_LE(distance(i, 0), 1e-3 * diagonal(points)) << bent << ' ' << i;
      }
    }
  }
}

// A disc as thick as a twentieth of the shift: the mirrored rear is closer to the front than the
// mirrored front is.
TEST(Asymmetry, OfThinPartsIsFromFrontToFront) {
  Ball b = ball(2);
  const double shift = 0.05;
  for (Index i = 0; i < b.points.rows(); ++i) {
    b.points.row(i).normalize();
    b.points(i, 2) *= 0.01;
    const double x = b.points(i, 0);
    if (x > 0) b.points(i, 2) += shift * x * x * (3 - 2 * x);
  }
  const OperationResult result = operate("asymmetry", {b.points, b.faces}, middle);
  EXPECT_GT(figure(result, "matched_share"), 0.9);
  const Eigen::MatrixXd& distance = result.arrays.at("distance");
  for (Index i = 0; i < b.points.rows(); ++i) {
    const Vector3 x = b.points.row(i).transpose();
    if (x.head<2>().norm() > 0.9 || result.arrays.at("matched")(i, 0) == 0) continue;
    const double raised = shift * x.x() * x.x() * (3 - 2 * std::abs(x.x()));
    EXPECT_NEAR(distance(i, 0), raised, 0.15 * raised + 0.002) << x.transpose();
  }
}

TEST(Asymmetry, OfACloudIsThatOfItsSurface) {
  const Ball b = ball(2);
  Eigen::VectorXd raised;
  const Points points = bumped(b.points, 0.05, raised);
  const OperationResult result = operate("asymmetry", {points}, middle);
  EXPECT_GT(figure(result, "matched_share"), 0.95);
  EXPECT_NEAR(result.arrays.at("distance")
                  .array()
                  .isFinite()
                  .select(result.arrays.at("distance").array(), 0)
                  .maxCoeff(),
              raised.maxCoeff(), 0.1 * raised.maxCoeff());
}

TEST(Asymmetry, HasNoneWhereTheOtherSideIsMissing) {
  const Ball b = ball(3);
  std::vector<Index> kept;
  for (Index f = 0; f < b.faces.rows(); ++f) {
    const Vector3 x = b.points.row(b.faces(f, 0)).transpose();
    if ((x - Vector3(1, 0, 0)).norm() > 0.5) kept.push_back(f);
  }
  Triangles faces(static_cast<Index>(kept.size()), 3);
  for (Index f = 0; f < faces.rows(); ++f) faces.row(f) = b.faces.row(kept[f]);
  const OperationResult result = operate("asymmetry", {b.points, faces}, middle);
  const Eigen::MatrixXd& matched = result.arrays.at("matched");
  for (Index i = 0; i < b.points.rows(); ++i) {
    const Vector3 image = b.points.row(i).transpose().cwiseProduct(Vector3(-1, 1, 1));
    const double to_hole = (image - Vector3(1, 0, 0)).norm();
    if (to_hole < 0.35 || to_hole > 0.75) {
      EXPECT_EQ(matched(i, 0), to_hole > 0.75) << i;
    }
    EXPECT_EQ(std::isfinite(result.arrays.at("distance")(i, 0)), matched(i, 0) == 1);
  }
  EXPECT_EQ(result.statistics.count("positive_volume"), 0u);
}

// The part of a ball of radius r beyond a plane at a distance d: pi h^2 (3 r - h) / 3 and 2 pi r h,
// h = r - d.
TEST(Asymmetry, MeasuresBothSides) {
  Ball b = ball(4);
  for (Index i = 0; i < b.points.rows(); ++i) b.points.row(i).normalize();
  const double d = 0.3, h = 1 - d;
  const OperationResult result =
      operate("asymmetry", {b.points, b.faces}, Plane(Vector3::UnitX(), -d));
  EXPECT_NEAR(figure(result, "positive_area"), 2 * std::numbers::pi * h, 0.05);
  EXPECT_NEAR(figure(result, "negative_area"), 2 * std::numbers::pi * (2 - h), 0.08);
  EXPECT_NEAR(figure(result, "positive_volume"), std::numbers::pi * h * h * (3 - h) / 3, 0.03);
  EXPECT_NEAR(figure(result, "negative_volume"),
              4 * std::numbers::pi / 3 - std::numbers::pi * h * h * (3 - h) / 3, 0.05);
  // Of the ball and another of radius R = 3 with its centre at d = 3 the part that both have:
  // pi (R + 1 - d)^2 (d^2 + 2 d - 3 + 2 d R + 6 R - 3 R^2) / (12 d).
  const OperationResult cut =
      operate("asymmetry", {b.points, b.faces}, Sphere(Vector3(3, 0, 0), 3));
  EXPECT_NEAR(figure(cut, "negative_volume"), std::numbers::pi * 21 / 36, 0.05);
}

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

Plane moved_plane(const OperationResult& result, const Plane& plane) {
  const Eigen::MatrixXd& m = std::get<Eigen::MatrixXd>(result.statistics.at("matrix"));
  const auto moved = plane.transformed(1, m.topLeftCorner<3, 3>(), m.topRightCorner<3, 1>());
  return dynamic_cast<const Plane&>(*moved);
}

TEST(Align, LaysThePlaneAcrossTheAxis) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 rotation = random.rotation();
    const Vector3 shift = 5 * random.in_box();
    const Points points = (ball(seed).points * rotation.transpose()).rowwise() + shift.transpose();
    const auto plane = middle.transformed(1, rotation, shift);
    for (const char* axis : {"x", "y", "z"})
      for (const char* frame : {"least", "principal"}) {
        const OperationResult result =
            operate("align", {points}, *plane, {{"axis", axis}, {"frame", frame}});
        const Eigen::MatrixXd& m = std::get<Eigen::MatrixXd>(result.statistics.at("matrix"));
        const Matrix3 turn = m.topLeftCorner<3, 3>();
        EXPECT_NEAR(turn.determinant(), 1, 1e-12);
        EXPECT_LE((turn * turn.transpose() - Matrix3::Identity()).norm(), 1e-12);
        const Plane moved = moved_plane(result, dynamic_cast<const Plane&>(*plane));
        EXPECT_NEAR(std::abs(moved.normal()[axis[0] - 'x']), 1, 1e-12);
        EXPECT_NEAR(moved.offset(), 0, 1e-10);
      }
    const Vector3 up = rotation * Vector3(0, 0.6, 0.8), front = rotation * Vector3(0, 0.8, -0.6);
    const OperationResult result =
        operate("align", {points}, *plane, {{"frame", "ras"}, {"up", up}, {"front", front}});
    const Matrix3 turn =
        std::get<Eigen::MatrixXd>(result.statistics.at("matrix")).topLeftCorner<3, 3>();
    EXPECT_LE((turn * up - Vector3::UnitZ()).norm(), 1e-9);
    EXPECT_LE((turn * front - Vector3::UnitY()).norm(), 1e-9);
  }
}

TEST(Align, LeavesAloneWhatLiesRight) {
  const OperationResult result = operate("align", {ball(0).points}, middle);
  const Eigen::MatrixXd& m = std::get<Eigen::MatrixXd>(result.statistics.at("matrix"));
  EXPECT_LE((m.topLeftCorner<3, 3>() - Matrix3::Identity()).norm(), 1e-12);
}

TEST(Align, RefusesAnUpAcrossTheMirror) {
  const Points points = ball(0).points;
  expect_error<InvalidParameter>("up is (1, 0, 0)", [&] {
    operate("align", {points}, middle, {{"up", Vector3(1, 0, 0)}});
  });
}

TEST(Symmetrize, LeavesNoAsymmetry) {
  const Ball b = ball(6);
  Eigen::VectorXd raised;
  const Points with_bump = bumped(b.points, 0.05, raised);
  for (const bool bent : {false, true})
    for (const char* side : {"average", "positive", "negative"}) {
      const Points points = bent ? wrapped(with_bump) : with_bump;
      const Mirror& mirror = bent ? static_cast<const Mirror&>(round_mirror) : middle;
      const OperationResult even =
          operate("symmetrize", {points, b.faces}, mirror, {{"side", side}});
      EXPECT_EQ(figure(even, "paired_share"), 1);
      const OperationResult left = operate("asymmetry", {even.points, b.faces}, mirror);
      EXPECT_LE(figure(left, "maximum_of_diagonal"), 1e-12) << bent << ' ' << side;
      const OperationResult none =
          operate("symmetrize", {points, b.faces}, mirror, {{"side", side}, {"strength", 0.0}});
      EXPECT_EQ(none.points, points);
    }
}

// An ellipsoid with a bump, whose vertices are no mirror images of one another.
TEST(Symmetrize, NeedsNoVerticesThatMirror) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = ball(seed);
    Points points = b.points.rowwise().normalized() * RandomCloud(seed).rotation();
    Eigen::VectorXd raised;
    points = (bumped(points, 0.05, raised) * Vector3(1, 1.5, 0.8).asDiagonal()).eval();
    for (const char* side : {"average", "positive", "negative"}) {
      const OperationResult even =
          operate("symmetrize", {points, b.faces}, middle, {{"side", side}});
      EXPECT_EQ(figure(even, "paired_share"), 1);
      const OperationResult left = operate("asymmetry", {even.points, b.faces}, middle);
      // The sagitta of an edge, 1.5 (2 pi / 48)^2 / 8, is 9e-4 of the diagonal.
      EXPECT_LE(figure(left, "p95_of_diagonal"), 2e-3) << seed << ' ' << side;
    }
  }
}

TEST(Symmetrize, MovesNothingOutsideOfTheMask) {
  const Ball b = ball(7);
  Eigen::VectorXd raised;
  const Points points = bumped(b.points, 0.05, raised);
  const Eigen::VectorXd mask = (points.col(0).array() > 0).cast<double>();
  const OperationResult result = operate("symmetrize", {points, b.faces, mask}, middle);
  for (Index i = 0; i < points.rows(); ++i)
    if (mask[i] == 0) {
      EXPECT_EQ(result.points.row(i), points.row(i));
    }
  EXPECT_GT((result.points - points).norm(), 0.01);
}

// The average of others may come near to the image of a point that nothing mirrored before.
TEST(Symmetrize, LeavesWhatHasNoCounterpart) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = RandomCloud(seed).box(13);
    const OperationResult result = operate("symmetrize", {points}, middle);
    const Eigen::MatrixXd& paired = result.arrays.at("paired");
    for (Index i = 0; i < points.rows(); ++i)
      if (paired(i, 0) == 0) {
        EXPECT_EQ(result.points.row(i), points.row(i)) << seed << ", " << i;
      }
  }
}

TEST(Straighten, LaysTheMirrorFlatAndBendsBack) {
  const Ball b = ball(8);
  const Points bent = wrapped(b.points);
  const OperationResult straight = operate("straighten", {bent, b.faces}, round_mirror);
  const Plane plane(std::get<Vector3>(straight.statistics.at("normal")),
                    figure(straight, "offset"));
  const OperationResult left = operate("asymmetry", {straight.points, b.faces}, plane);
  EXPECT_LE(figure(left, "maximum_of_diagonal"), 1e-9);
}

// Points twice the radius from the centre or farther have no image, nor have places next to them.
TEST(Operations, KeepTheirNumbersWhereImagesEnd) {
  Points cloud(54, 3);
  for (Index i = 0; i < 27; ++i) {
    const double y = static_cast<double>(i / 3 % 3);
    cloud.row(i) << static_cast<double>(i % 3), y, static_cast<double>(i / 9);
    cloud.row(27 + i) << cloud(i, 0), 0.2 - y, cloud(i, 2);
  }
  const Points twice = Points(cloud.replicate(2, 1));
  const Sphere mirror({0.9, 0.9, 0.9}, 0.9);
  for (const char* name : {"asymmetry", "correspondences", "complete", "symmetrize"}) {
    const OperationResult result = operate(name, {twice, Triangles(0, 3)}, mirror);
    EXPECT_TRUE(result.points.allFinite()) << name;
    const auto matched = result.arrays.find("matched");
    const auto distance = result.arrays.find("distance");
    if (matched == result.arrays.end() || distance == result.arrays.end()) continue;
    for (Index i = 0; i < twice.rows(); ++i)
      EXPECT_EQ(matched->second(i, 0) != 0, std::isfinite(distance->second(i, 0))) << name;
  }
}

TEST(Operations, RefuseAMirrorOfAnotherUnit) {
  RandomCloud random(0);
  Points points = random.box(200);
  points.col(0).array() += 50;
  const Plane plane(Vector3::UnitX(), -50);
  const Points scaled = 1000 * points;
  for (const Operation& each : operations()) {
    EXPECT_NO_THROW(operate(each.name, {points}, plane));
    expect_error<InvalidInput>("diagonals away from this plane; the mirror is to be in the unit",
                               [&] { operate(each.name, {scaled}, plane); });
  }
}

TEST(Operations, NameWhatIsWrong) {
  const Ball b = ball(0);
  const OperationInput input{b.points, b.faces};
  expect_error<InvalidParameter>("there is no operation 'melt'; there are asymmetry, ",
                                 [&] { operate("melt", input, middle); });
  expect_error<InvalidParameter>("strength", [&] {
    operate("symmetrize", input, middle, {{"strength", 1.5}});
  });
  expect_error<InvalidInput>("2 mask values given for", [&] {
    operate("symmetrize", {b.points, b.faces, Eigen::VectorXd::Ones(2)}, middle);
  });
  expect_error<InvalidInput>("points have an image over this sphere",
                             [&] { operate("asymmetry", input, Sphere(Vector3::Zero(), 0.01)); });
  Points broken = b.points;
  broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
  // Its square is no double.
  Points far = b.points;
  far(7, 2) = 1e300;
  for (const Operation& each : operations())
    expect_error<InvalidInput>("allowed are coordinates up to 1e+50", [&] {
      operate(each.name, {far, b.faces}, middle);
    });
  expect_error<InvalidInput>("point 3", [&] { operate("asymmetry", {broken, b.faces}, middle); });
}

// The half at x > 0 of a bumpy ball with open rims, and its image behind it, whose faces keep their
// winding.
Ball mirrored_without_turning(std::uint64_t seed) {
  const Ball whole = ball(seed);
  std::vector<Index> number(whole.points.rows(), -1), used;
  std::vector<std::array<Index, 3>> half;
  for (const auto& face : whole.faces.rowwise()) {
    bool is_ahead = true;
    for (const Index i : face) is_ahead = is_ahead && whole.points(i, 0) > 0;
    if (!is_ahead) continue;
    std::array<Index, 3>& corners = half.emplace_back();
    for (int c = 0; c < 3; ++c) {
      if (number[face[c]] < 0) {
        number[face[c]] = static_cast<Index>(used.size());
        used.push_back(face[c]);
      }
      corners[c] = number[face[c]];
    }
  }
  const auto count = static_cast<Index>(used.size()), faces = static_cast<Index>(half.size());
  Ball both{Points(2 * count, 3), Triangles(2 * faces, 3), {}};
  both.points << whole.points(used, Eigen::indexing::all),
      whole.points(used, Eigen::indexing::all) * Vector3(-1, 1, 1).asDiagonal();
  for (Index f = 0; f < faces; ++f) {
    both.faces.row(f) << half[f][0], half[f][1], half[f][2];
    both.faces.row(faces + f) = both.faces.row(f).array() + count;
  }
  for (Index i = 0; i < 2 * count; ++i) both.partner.push_back((i + count) % (2 * count));
  return both;
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

// Off by a hundredth of a face: no vertex has an exact partner.
TEST(Asymmetry, TakesNormalsForLinesWhereASideIsWoundTheOtherWay) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Ball b = mirrored_without_turning(seed);
    b.points += 1e-3 * RandomCloud(seed).box(b.points.rows());
    const OperationResult result = operate("asymmetry", {b.points, b.faces}, middle);
    EXPECT_GT(figure(result, "matched_share"), 0.95);
    EXPECT_LT(figure(result, "p95"), 2e-3);
    EXPECT_NEAR(figure(result, "unmatched_share"), 1 - figure(result, "matched_share"), 1e-12);
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

// All faces lie on one side; a flat cloud has no normal direction to separate along.
TEST(Operations, LeaveOutFiguresWithoutAValue) {
  Points points(40, 3);
  points << RandomCloud(0).box(40);
  for (Index i = 20; i < 40; ++i) points.row(i) = points.row(i - 20) * -1;
  Triangles face(1, 3);
  face << 0, 0, 0;
  const OperationResult result = operate("asymmetry", {points, face}, middle);
  EXPECT_EQ(result.statistics.count("area_index"), 0u);
  for (const auto& [name, value] : result.statistics)
    if (const double* number = std::get_if<double>(&value)) {
      EXPECT_TRUE(std::isfinite(*number)) << name;
    }
}

// What lies beyond the centre of a sphere, or above the axis of a cylinder, has no foot.
TEST(Straighten, GivesEveryPointAPlace) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Points points = RandomCloud(seed).box(300);
    points.row(7) << 0, 0.25, 0;
    const Sphere sphere(Vector3(0, 0.25, 0), 0.9);
    const Cylinder cylinder(Vector3(0, 0.25, 0), Vector3::UnitZ(), 0.9);
    for (const Mirror* mirror :
         {static_cast<const Mirror*>(&sphere), static_cast<const Mirror*>(&cylinder)})
      for (const bool back : {false, true}) {
        const OperationResult result = operate("straighten", {points}, *mirror, {{"back", back}});
        EXPECT_TRUE(result.points.allFinite()) << mirror->kind() << back;
      }
  }
}

}  // namespace
}  // namespace symsurf
