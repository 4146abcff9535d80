#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/parameter.h>

#include <cmath>
#include <limits>
#include <set>

#include "expect_error.h"
#include "registry.h"

namespace symsurf::parameter_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::nan("");

const Parameter boolean = Parameter::boolean("closed", true, "Whether it is closed.");
const Parameter integer = Parameter::integer("count", 10, 1, 100, "points", "How many.");
const Parameter real = Parameter::real("share", 0.5, 0, 1, "", "How much.");
const Parameter open = Parameter::real("length", 1, 0, infinity, "diagonal", "How long.");
const Parameter choice = Parameter::choice("kind", "pca", {"regression", "pca"}, "Which.");
const Parameter direction = Parameter::direction("axis", "Where to.");
const Parameter position = Parameter::position("origin", "Where.");

TEST(Parameter, TakesWhatItAllows) {
  EXPECT_EQ(boolean.checked(false), Value(false));
  for (const Index allowed : {1, 50, 100})
    EXPECT_EQ(integer.checked(allowed), Value(Index{allowed}));
  for (const double allowed : {0.0, 0.3, 1.0}) EXPECT_EQ(real.checked(allowed), Value(allowed));
  EXPECT_EQ(real.checked(Index{1}), Value(1.0)) << "an integer will do for a real";
  EXPECT_EQ(open.checked(1e300), Value(1e300));
  EXPECT_EQ(choice.checked(std::string("regression")), Value(std::string("regression")));
  EXPECT_EQ(direction.checked(Vector3(0, 0, 5)), Value(Vector3(0, 0, 5)));
  EXPECT_EQ(position.checked(Vector3(1, 2, 3)), Value(Vector3(1, 2, 3)));
}

TEST(Parameter, NamesItsUnit) {
  EXPECT_EQ(integer.allowed(), "[1, 100] points");
  EXPECT_EQ(real.allowed(), "[0, 1]");
  EXPECT_EQ(open.allowed(), "[0, inf) of the diagonal");
  EXPECT_EQ(choice.allowed(), "regression | pca");
}

TEST(Parameter, RefusesTheRestNamingItselfTheValueAndTheRange) {
  struct Case {
    Parameter parameter;
    Value value;
    std::string error;
  };
  const Case cases[] = {
      {boolean, Index{1}, "closed is 1; allowed is boolean true | false"},
      {integer, Index{0}, "count is 0; allowed is integer [1, 100] points"},
      {integer, Index{101}, "count is 101; allowed is integer [1, 100] points"},
      {integer, 5.0, "count is 5; allowed is integer [1, 100] points"},
      {real, -0.1, "share is -0.1; allowed is real [0, 1]"},
      {real, 1.1, "share is 1.1; allowed is real [0, 1]"},
      {real, Index{2}, "share is 2; allowed is real [0, 1]"},
      {real, nan, "share is nan; allowed is real [0, 1]"},
      {real, std::string("half"), "share is half; allowed is real [0, 1]"},
      {real, true, "share is true; allowed is real [0, 1]"},
      {open, -1.0, "length is -1; allowed is real [0, inf) of the diagonal"},
      {choice, std::string("guess"), "kind is guess; allowed is choice regression | pca"},
      {choice, Index{0}, "kind is 0; allowed is choice regression | pca"},
      {direction, 1.0, "axis is 1; allowed is direction 3 finite numbers"},
      {direction, Vector3(0, 0, nan), "axis is (0, 0, nan); allowed is direction"},
      {position, Vector3(infinity, 0, 0), "origin is (inf, 0, 0); allowed is position"},
  };
  for (const Case& c : cases)
    expect_error<InvalidParameter>(c.error, [&] { c.parameter.checked(c.value); });
}

TEST(Parameter, IsInfiniteNowhereItSaysItIsNot) {
  expect_error<InvalidParameter>("share is inf", [] { real.checked(infinity); });
  expect_error<InvalidParameter>("share is -inf", [] { real.checked(-infinity); });
}

TEST(ParameterValues, AreTheDefaultsButForWhatIsGiven) {
  const ParameterValues values("test", {boolean, integer, real, choice, direction},
                               {{"count", Index{7}}, {"share", Index{1}}});
  EXPECT_EQ(values.boolean("closed"), true);
  EXPECT_EQ(values.integer("count"), 7);
  EXPECT_EQ(values.real("share"), 1.0);
  EXPECT_EQ(values.choice("kind"), "pca");
  EXPECT_EQ(values.vector("axis"), Vector3(0, 0, 0));
  EXPECT_EQ(values.all().size(), 5u);
}

TEST(ParameterValues, RefuseNamesThereAreNotListingThoseThereAre) {
  expect_error<InvalidParameter>("'test' has no parameter 'counts'; it has count, share", [] {
    ParameterValues("test", {integer, real}, {{"counts", Index{7}}});
  });
  expect_error<InvalidParameter>("'test' has no parameter 'count'; it has none", [] {
    ParameterValues("test", {}, {{"count", Index{7}}});
  });
  expect_error<InvalidParameter>("count is 0", [] {
    ParameterValues("test", {integer}, {{"count", Index{0}}});
  });
}

bool is_sentence(const std::string& text) {
  return text.size() > 1 && std::isupper(static_cast<unsigned char>(text[0])) && text.back() == '.';
}

TEST(Methods, DescribeThemselves) {
  const std::set<std::string> units{"", "diagonal", "points", "degrees"};
  std::set<std::string> names;
  for (const Method& described : methods()) {
    EXPECT_TRUE(names.insert(described.name).second) << described.name << " is there twice";
    EXPECT_EQ(&method(described.name), &described);
    EXPECT_TRUE(is_sentence(described.summary)) << described.summary;
    EXPECT_FALSE(described.title.empty()) << described.name;
    EXPECT_TRUE(implementation(described.name).run) << described.name;
    std::set<std::string> parameters;
    for (const Parameter& parameter : described.parameters) {
      EXPECT_TRUE(parameters.insert(parameter.name).second) << parameter.name;
      EXPECT_TRUE(is_sentence(parameter.doc)) << parameter.doc;
      EXPECT_TRUE(units.count(parameter.unit)) << parameter.unit;
      EXPECT_NO_THROW(parameter.checked(parameter.default_value)) << parameter.name;
      EXPECT_EQ(parameter.checked(parameter.default_value), parameter.default_value);
    }
  }
  EXPECT_TRUE(names.count("auto") && names.count("plane"));
}

TEST(Methods, AreListedWhereANameIsNotAmongThem) {
  for (const Method& known : methods())
    expect_error<InvalidParameter>(known.name, [] { method("planes"); });
  expect_error<InvalidParameter>("there is no method 'planes'", [] { method("planes"); });
}

}  // namespace
}  // namespace symsurf::parameter_tests
