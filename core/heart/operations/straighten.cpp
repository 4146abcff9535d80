#include <symsurf/mirrors.h>

#include "operations/operation_registry.h"

namespace symsurf {

namespace {

void run_straighten(const OperationInput& input, const Mirror& mirror,
                    const ParameterValues& values, const Context& context,
                    OperationResult& result) {
  const bool back = values.boolean("back");
  Index unplaced = 0;
  result.points =
      bend(input.points, mirror, back ? Bend::Restore : Bend::Straighten, context, &unplaced);
  const Plane plane = straight_mirror(mirror, input.points);
  result.statistics["normal"] = plane.normal();
  result.statistics["offset"] = plane.offset();
  result.statistics["unplaced_points"] = unplaced;
}

}  // namespace

OperationImplementation straighten_operation() {
  OperationImplementation operation;
  operation.name = "straighten";
  operation.title = "Mirror straightening";
  operation.summary =
      "Carries the shape along while its curved mirror is laid flat, and back: each point keeps "
      "its "
      "distance from the mirror and the place of its foot.";
  operation.parameters = {Parameter::boolean(
      "back", false, "The way back: bends what was straightened over the same mirror.")};
  operation.moves_points = true;
  operation.run = run_straighten;
  return operation;
}

}  // namespace symsurf
