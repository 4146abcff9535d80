#pragma once

#include <symsurf/result.h>

#include <memory>
#include <string>

namespace symsurf {

/// The mirror of a detection whose verdict is "found", for what needs one. Throws InvalidInput with
/// the reason and the advice for another verdict, or where the method gives surface points only.
std::shared_ptr<Mirror> found_mirror(const Result& result, const std::string& advice);

}  // namespace symsurf
