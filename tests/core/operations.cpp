#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "bumpy_ball.h"
#include "expect_error.h"
#include "figure.h"
#include "random_cloud.h"
#include "triangle_soup.h"

namespace symsurf::operations_tests {
namespace {

TEST(Operations, AreDescribed) {
  for (const Operation& each : operations()) {
    EXPECT_FALSE(each.title.empty() || each.summary.empty()) << each.name;
    const Ball b = ball(0);
    const OperationResult result = operate(each.name, {b.points, b.faces}, middle);
    for (const PointArray& array : each.arrays) {
      // Where triangles are mirrored, and of homologous points.
      if (std::set<std::string>{"partner", "vector_sd", "known"}.count(array.name) &&
          !result.arrays.count(array.name))
        continue;
      EXPECT_EQ(result.arrays.at(array.name).rows(), result.points.rows()) << array.name;
      EXPECT_EQ(result.arrays.at(array.name).cols(), array.components) << array.name;
    }
    for (const PointArray& array : each.face_arrays)
      EXPECT_EQ(result.face_arrays.at(array.name).rows(), result.faces.rows()) << array.name;
    if (result.is_other_shape()) continue;
    EXPECT_EQ(result.faces, b.faces);
    EXPECT_EQ(result.points.rows(), b.points.rows());
    if (!each.moves_points) {
      EXPECT_EQ(result.points, b.points);
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
    const Triangles faces = each.needs_faces ? triangle_soup(points) : Triangles(0, 3);
    EXPECT_NO_THROW(operate(each.name, {points, faces}, plane));
    if (each.takes_any_mirror) continue;
    expect_error<InvalidInput>("diagonals away from this plane; the mirror must be in the unit",
                               [&] {
                                 operate(each.name, {scaled, faces}, plane);
                               });
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
  // Its square is no double.
  Points far = b.points;
  far(7, 2) = 1e300;
  for (const Operation& each : operations())
    expect_error<InvalidInput>("allowed are coordinates up to 1e+50", [&] {
      operate(each.name, {far, b.faces}, middle);
    });
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
}  // namespace symsurf::operations_tests
