#include <gtest/gtest.h>
#include <symsurf/attributes.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::attributes_tests {
namespace {

using Mirrors = std::map<std::string, std::shared_ptr<Mirror>>;

// z = 0.2 x^2 - 0.1 x y + 0.15 y^2 in patches that overlap.
std::shared_ptr<Mirror> free_form() {
  std::vector<Patch> patches;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      const double x = 0.4 * i, y = 0.4 * j;
      Patch patch{{x, y, 0}, Matrix3::Identity(), {}, 0.9};
      patch.height << 0.2 * x * x - 0.1 * x * y + 0.15 * y * y, 0.4 * x - 0.1 * y,
          -0.1 * x + 0.3 * y, 0.2, -0.1, 0.15 + 0.02 * std::sin(3.0 * i + j);
      patches.push_back(patch);
    }
  return std::make_shared<FreeForm>(std::move(patches));
}

Mirrors mirrors(RandomCloud& random) {
  const Matrix3 turn = random.rotation();
  Points nodes = random.box(60);
  nodes.col(2) = 0.1 * nodes.col(0).cwiseProduct(nodes.col(1));
  const Matrix3 bowl = turn * Vector3(0.2, 0.3, 0).asDiagonal() * turn.transpose();
  return {
      {"plane", std::make_shared<Plane>(turn.col(0), 0.1)},
      {"oblique", std::make_shared<ObliquePlane>(turn.col(0), 0.1, turn * Vector3(1, 0.3, 0.2))},
      {"sphere", std::make_shared<Sphere>(-4 * turn.col(0), 4.1)},
      {"cylinder", std::make_shared<Cylinder>(-4 * turn.col(0), turn.col(1), 4.1)},
      {"quadric", std::make_shared<Quadric>(bowl, turn.col(2), 0.1)},
      {"height field", std::make_shared<HeightField>(Vector3::UnitZ(), nodes)},
      {"free form", free_form()},
      {"surface", std::make_shared<SurfaceMirror>(surface("f1"), Mapping::Perpendicular, 1.5, turn,
                                                  Vector3(0.1, 0.2, 0))},
      {"fixed surface", std::make_shared<SurfaceMirror>(surface("f1"), Mapping::Fixed)}};
}

// Central differences of the eighth order.
Matrix3 by_differences(const Mirror& mirror, const Vector3& x) {
  constexpr double step = 2e-3, weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  Matrix3 found = Matrix3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 1; k <= 4; ++k) {
      const Vector3 beside = k * step * Vector3::Unit(axis);
      found.col(axis) +=
          weights[k - 1] / step * (mirror.reflect(x + beside) - mirror.reflect(x - beside));
    }
  return found;
}

// Patches and interpolated heights have jumps in their third derivatives, which differences see.
TEST(Attributes, JacobiansAreThoseOfDifferences) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = 0.5 * random.box(30);
    for (const auto& [name, mirror] : mirrors(random)) {
      SCOPED_TRACE(name);
      const double within = name == "free form" || name == "height field" ? 1e-2 : 2e-9;
      for (Index i = 0; i < points.rows(); ++i) {
        const Matrix3 found = mirror->jacobian(points.row(i)),
                      expected = by_differences(*mirror, points.row(i));
        if (expected.allFinite()) {
          EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), within);
        }
      }
    }
  }
}

TEST(Attributes, ReflectedTwiceAreThemselves) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = 0.5 * random.box(50);
    const Eigen::MatrixXd given = random.box(50), tensors = given.replicate(1, 2);
    for (const auto& [name, mirror] : mirrors(random)) {
      SCOPED_TRACE(name);
      const Points images = mirror->reflect(points);
      if (!images.allFinite()) continue;
      const AttributeTransform there(*mirror, points), back(*mirror, images);
      EXPECT_TRUE(there.turns());
      for (const auto kind :
           {AttributeKind::Vector, AttributeKind::Normal, AttributeKind::Tensor}) {
        const Eigen::MatrixXd& values = kind == AttributeKind::Tensor ? tensors : given;
        const Eigen::MatrixXd once = there(values, kind), twice = back(once, kind);
        EXPECT_GT((once - values).cwiseAbs().maxCoeff(), 0.1);
        EXPECT_LE((twice - values).cwiseAbs().maxCoeff(), 1e-9);
      }
    }
  }
}

TEST(Attributes, NormalsStayAcrossTheSurfaceAtTheirLength) {
  RandomCloud random(1);
  const Points points = 0.5 * random.box(50), one = random.box(50), other = random.box(50);
  Points normals(50, 3);
  for (Index i = 0; i < 50; ++i)
    normals.row(i) = Vector3(one.row(i)).cross(Vector3(other.row(i))).transpose();
  for (const auto& [name, mirror] : mirrors(random)) {
    SCOPED_TRACE(name);
    const AttributeTransform by(*mirror, points);
    const Eigen::MatrixXd turned = by(normals, AttributeKind::Normal),
                          along = by(one, AttributeKind::Vector);
    EXPECT_LE(turned.cwiseProduct(along).rowwise().sum().cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE((turned.rowwise().norm() - normals.rowwise().norm()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Attributes, RefuseOtherShapesOfValues) {
  const Plane plane(Vector3::UnitX(), 0);
  const Points points = RandomCloud(0).box(5);
  const AttributeTransform by(plane, points);
  expect_error<InvalidInput>("(4, 3)", [&] { by(points.topRows(4), AttributeKind::Vector); });
  expect_error<InvalidInput>("6 or 9 of tensors", [&] { by(points, AttributeKind::Tensor); });
  EXPECT_EQ(by(Eigen::MatrixXd::Ones(5, 7), AttributeKind::Scalar), Eigen::MatrixXd::Ones(5, 7));
}

}  // namespace
}  // namespace symsurf::attributes_tests
