#pragma once

// Values, and the descriptions of parameters that front ends are made from.

#include <symsurf/points.h>

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace symsurf {

/// A parameter's value or a reported figure, in a form every front end can hand on.
using Value = std::variant<bool, Index, double, std::string, Vector3, Eigen::MatrixXd>;
using Values = std::map<std::string, Value>;

/// The value as text: "0.05", "plane", "(0, 0, 1)".
std::string to_string(const Value& value);

enum class ParameterType { Boolean, Integer, Real, Choice, Direction, Position };

/// "boolean", "integer", "real", "choice", "direction", "position".
std::string_view to_string(ParameterType type);

/// The one description of a parameter, from which every front end is made.
struct Parameter {
  std::string name;
  ParameterType type;
  std::string unit;  ///< "diagonal" (a fraction of the bounding box's), "points", "degrees" or ""
  Value default_value;
  double minimum = 0, maximum = 0;   ///< inclusive, numbers only; infinite where open
  std::vector<std::string> choices;  ///< choices only
  std::string doc;                   ///< one sentence

  static Parameter boolean(std::string name, bool value, std::string doc);
  static Parameter integer(std::string name, Index value, Index minimum, Index maximum,
                           std::string unit, std::string doc);
  static Parameter real(std::string name, double value, double minimum, double maximum,
                        std::string unit, std::string doc);
  static Parameter choice(std::string name, std::string value, std::vector<std::string> choices,
                          std::string doc);
  /// A vector of any length but not NaN; (0, 0, 0) stands for "not given".
  static Parameter direction(std::string name, std::string doc);
  static Parameter position(std::string name, std::string doc);

  /// "[0, 1]", "[1, inf)", "regression | pca", "true | false" or "3 numbers".
  std::string range() const;
  /// The range with its unit: "[0, 1] of the diagonal", "[0, 90] degrees".
  std::string allowed() const;

  /// The value in this parameter's type (an integer will do for a real).
  /// Throws InvalidParameter naming the parameter, what was given and what is allowed.
  Value checked(const Value& value) const;
};

/// Every parameter of a method with the value it has in one run.
class ParameterValues {
 public:
  ParameterValues() = default;
  /// Defaults, overridden by what was given.
  /// Throws InvalidParameter for a name `owner` does not have or a value out of range.
  ParameterValues(std::string_view owner, const std::vector<Parameter>& described,
                  const Values& given);

  bool boolean(const std::string& name) const;
  Index integer(const std::string& name) const;
  double real(const std::string& name) const;
  const std::string& choice(const std::string& name) const;
  const Vector3& vector(const std::string& name) const;

  const Values& all() const { return values_; }

 private:
  Values values_;
};

}  // namespace symsurf
