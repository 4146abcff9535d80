#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "expect_error.h"

namespace symsurf::make_mirror_tests {
namespace {

using Table = Eigen::MatrixXd;

Values patch() {
  return {{"centres", Table(Table::Zero(1, 3))},
          {"tangents", Table(Vector3::UnitX().transpose())},
          {"normals", Table(Vector3::UnitZ().transpose())},
          {"heights", Table(Table::Zero(1, 6))},
          {"radii", Table(Table::Ones(1, 1))}};
}

Values surface() {
  return {{"surface", std::string("f1")},
          {"mapping", std::string("fixed")},
          {"scale", 1.0},
          {"rotation", Table(Matrix3::Identity())},
          {"translation", Vector3(0, 0, 0)}};
}

Values with(Values numbers, const char* name, Value value) {
  numbers[name] = std::move(value);
  return numbers;
}

TEST(MakeMirror, TakesWholeNumbersAndTablesOfOneRow) {
  const Vector3 x(0.3, 0.2, 0.1);
  const Values plane{{"normal", Vector3(0, 0, 1)}, {"offset", Index{2}}};
  EXPECT_EQ(make_mirror("plane", plane)->signed_distance(x), 2.1);
  Values one = patch();
  for (const char* name : {"centres", "tangents", "normals"})
    one[name] = Vector3(std::get<Table>(one[name]).transpose());
  one["radii"] = 1.0;
  EXPECT_EQ(make_mirror("free-form", one)->reflect(x),
            make_mirror("free-form", patch())->reflect(x));
}

TEST(MakeMirror, SaysWhatIsWrong) {
  const auto refused = [](const std::string& error, const char* kind, const Values& numbers) {
    expect_error<InvalidInput>(error, [&] { make_mirror(kind, numbers); });
  };
  refused("no mirror of the kind 'plan'", "plan", {});
  refused("the mirror's normal is missing", "plane", {{"offset", 0.0}});
  refused("offset is far; a number is needed", "plane",
          {{"normal", Vector3(0, 0, 1)}, {"offset", std::string("far")}});
  refused("normal is 1; 3 numbers are needed", "plane", {{"normal", 1.0}, {"offset", 0.0}});
  refused("mapping is Fixed; allowed is fixed | perpendicular", "surface",
          with(surface(), "mapping", std::string("Fixed")));
  refused("rotation is 2 x 3 numbers; 3 x 3 are needed", "surface",
          with(surface(), "rotation", Table(Table::Zero(2, 3))));
  refused("centres is 1 x 2 numbers; rows of 3 are needed", "free-form",
          with(patch(), "centres", Table(Table::Zero(1, 2))));
  expect_error<InvalidParameter>(
      "f9", [] { make_mirror("surface", with(surface(), "surface", std::string("f9"))); });
}

// Finite numbers whose sums, squares or quotients a double does not hold.
TEST(MakeMirror, RefusesWhatDoublesCannotHold) {
  constexpr double largest = std::numeric_limits<double>::max();
  const Vector3 far = Vector3::Constant(largest);
  const auto refused = [](const char* kind, const Values& numbers) {
    EXPECT_THROW(make_mirror(kind, numbers), InvalidInput) << kind;
  };
  refused("plane", {{"normal", far}, {"offset", 0.0}});
  refused("plane", {{"normal", Vector3(1e-100, 0, 0)}, {"offset", largest}});
  refused("cylinder", {{"point", Vector3(0, 0, 0)}, {"axis", far}, {"radius", 1.0}});
  const Values quadric{{"matrix", Table(Matrix3::Identity())},
                       {"origin", Vector3(0, 0, 0)},
                       {"gradient", Vector3(1, 0, 0)},
                       {"value", 0.0}};
  refused("quadric", with(quadric, "matrix", Table(Table::Constant(3, 3, largest))));
  refused("quadric", with(quadric, "origin", far));
  Table nodes = Table::Zero(2, 3);
  nodes(0, 0) = 1e160;
  refused("height field", {{"direction", Vector3(0, 0, 1)}, {"nodes", nodes}});
  const auto surface_mirror = make_mirror("surface", surface());
  for (const double scale : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(surface_mirror->transformed(scale, Matrix3::Identity(), Vector3::Zero()),
                 InvalidInput);
}

}  // namespace
}  // namespace symsurf::make_mirror_tests
