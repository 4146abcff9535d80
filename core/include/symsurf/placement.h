#pragma once

// Where dialogs and panels put parameters.

#include <string_view>

namespace symsurf {

/// A parameter's place in a dialog.
struct Placement {
  std::string_view group{};  ///< its heading; none: that of the method or operation
  bool is_advanced = false;  ///< few need it: it is folded away at first
  /// Another parameter and its value with which alone this one counts; none: it always does.
  std::string_view condition{}, value{};
};

/// Of the parameters of that name, which mean the same in all methods, operations and analyses.
const Placement& placement(std::string_view parameter);

}  // namespace symsurf
