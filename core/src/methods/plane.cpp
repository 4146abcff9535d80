#include <symsurf/plane.h>

#include "../matching.h"
#include "methods.h"

namespace symsurf {

namespace {

Result run_plane(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  Result result;
  result.method = "plane";
  const Vector3 centre = cloud.points.matrix().colwise().mean();
  result.mirror = std::make_shared<Plane>(Vector3::UnitX(), -centre.x());
  const PointTree tree(cloud.points, context.stage(0.5, 0.6));
  add_pairs(result, cloud.points, tree, *result.mirror,
            values.real("pair_distance") * cloud.diagonal, context.stage(0.6, 1));
  return result;
}

}  // namespace

Method plane_method() {
  Method method;
  method.name = "plane";
  method.title = "Mirror plane";
  method.summary =
      "Finds the plane that mirrors the shape best (Hruda, Kolingerova and Vasa 2022), refined on "
      "the full cloud.";
  method.parameters = {
      Parameter::integer("sample_size", 1000, 100, 100000, "points",
                         "Points that the search for the plane works on."),
      Parameter::integer("max_candidates", 10, 0, 1000, "",
                         "Other planes to report at the most, best first."),
      Parameter::real("pair_distance", 0.05, 0, 1, "diagonal",
                      "A point whose image has no point of the cloud nearer than this has no "
                      "partner."),
  };
  method.automatic = true;
  method.run = run_plane;
  return method;
}

}  // namespace symsurf
