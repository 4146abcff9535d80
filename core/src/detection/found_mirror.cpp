#include <symsurf/context.h>
#include <symsurf/detect.h>

namespace symsurf {

FoundMirror found_mirror(const Result& result, bool require_found) {
  const bool found = result.verdict() == "found";
  if (!found && (require_found || !result.mirror))
    throw InvalidInput("the shape has no mirror: " + result.reason());
  if (!result.mirror) throw InvalidInput("the result of " + result.method + " has no mirror");
  if (found) return {result.mirror, ""};
  return {result.mirror, "the verdict on the mirror is \"none\": " + result.reason() +
                             "; it is used all the same, with require_found this is an error"};
}

const Parameter& require_found_parameter() {
  static const Parameter parameter = Parameter::boolean(
      "require_found", false,
      "Refuse a mirror that is found with the verdict \"none\"; otherwise it is used, with a "
      "warning.");
  return parameter;
}

}  // namespace symsurf
