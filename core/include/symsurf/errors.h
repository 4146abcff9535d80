#pragma once

#include <stdexcept>

namespace symsurf {

/// The points, the normals or the file cannot be used; the message says why and what is needed.
class InvalidInput : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// An unknown method or parameter, or a value out of its range; the message names both.
class InvalidParameter : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The caller's progress callback asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled by the caller") {}
};

}  // namespace symsurf
