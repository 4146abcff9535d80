#pragma once

#include <symsurf/parameter.h>
#include <symsurf/result.h>

#include <memory>
#include <string>

namespace symsurf {

/// The mirror that a detection gives to what needs one.
struct FoundMirror {
  std::shared_ptr<Mirror> mirror;
  std::string warning;  ///< for the caller, where the verdict is "none"; else empty
};

/// The mirror of a result, whatever its verdict. Throws InvalidInput where there is none, and, with
/// `require_found`, with the reason where the verdict is "none".
FoundMirror found_mirror(const Result& result, bool require_found = false);

/// The description of `require_found`, for what finds a mirror first.
const Parameter& require_found_parameter();

}  // namespace symsurf
