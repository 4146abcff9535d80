#pragma once

#include <symsurf/types.h>

#include <map>
#include <string>
#include <variant>

namespace symsurf {

/// A parameter's value or a reported figure, in a form every front end can hand on.
using Value = std::variant<bool, Index, double, std::string, Vector3, Eigen::MatrixXd>;
using Values = std::map<std::string, Value>;

/// The value as text: "0.05", "plane", "(0, 0, 1)".
std::string to_string(const Value& value);

}  // namespace symsurf
