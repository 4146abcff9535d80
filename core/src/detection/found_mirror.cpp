#include <symsurf/errors.h>
#include <symsurf/found_mirror.h>

namespace symsurf {

std::shared_ptr<Mirror> found_mirror(const Result& result, const std::string& advice) {
  if (result.verdict() != "found")
    throw InvalidInput("the shape has no mirror: " + result.reason() + "; " + advice);
  if (!result.mirror) throw InvalidInput("the result of " + result.method + " has no mirror");
  return result.mirror;
}

}  // namespace symsurf
