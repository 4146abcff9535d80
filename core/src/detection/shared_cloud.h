#pragma once

#include <symsurf/errors.h>
#include <symsurf/method.h>

#include <string>
#include <vector>

#include "base/gathered.h"

namespace symsurf {

/// Throws on every process the InvalidInput that `check` throws on the first that it throws on.
/// Collective.
template <typename Check>
void check_together(const Context& context, const Check& check) {
  std::string message;
  try {
    check();
  } catch (const InvalidInput& error) {
    message = error.what();
  }
  for (const std::vector<char>& text :
       gathered(context, std::vector<char>(message.begin(), message.end())))
    if (!text.empty()) throw InvalidInput(std::string(text.begin(), text.end()));
}

/// checked_cloud() of a cloud of which each process has a part, maybe an empty one. Collective; the
/// errors are the same on all.
Cloud checked_shared_cloud(PointsView own, Index minimum_points, const Context& context);

}  // namespace symsurf
