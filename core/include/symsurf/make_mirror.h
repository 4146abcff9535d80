#pragma once

#include <symsurf/mirror.h>

#include <memory>
#include <string_view>

namespace symsurf {

/// The mirror that Mirror::kind() and Mirror::numbers() describe: how a mirror comes back from a
/// file or from a host's data. Numbers that do not belong to the kind are passed over.
/// Throws InvalidInput for an unknown kind, or a number that is missing, of another type or not
/// allowed; InvalidParameter for the name of a surface that there is not.
std::shared_ptr<Mirror> make_mirror(std::string_view kind, const Values& numbers);

}  // namespace symsurf
