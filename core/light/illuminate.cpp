#include <symsurf/mirrors.h>

#include <cmath>
#include <limits>

#include "cloud/triangle_mesh.h"
#include "reflection_search.h"

namespace symsurf {

namespace {

void run_illuminate(const OperationInput& input, const Mirror& mirror,
                    const ParameterValues& values, const Context& context,
                    OperationResult& result) {
  const PointsView points = input.points;
  // The way back is the same: the points are the sources and the light is the eye.
  const ReflectionPoints found =
      reflection_points(mirror, points, values.vector("light"), context.stage(0, 0.9));
  Points normals;
  if (!input.faces.empty())
    normals = TriangleMesh(points, input.faces, context.stage(0.9, 1)).vertex_normals();
  Eigen::VectorXd paths = Eigen::VectorXd::Zero(points.size()), irradiance = paths;
  Points reflection = Points::Constant(points.size(), 3, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < found.positions.rows(); ++k) {
    const Index i = found.sources[k];
    if (paths[i]++ == 0) reflection.row(i) = found.positions.row(k);  // the shortest comes first
    const Vector3 way = points[i] - found.positions.row(k).transpose();
    const double cosine =
        normals.rows() > 0 ? std::abs(way.normalized().dot(normals.row(i).transpose())) : 1;
    if (cosine > 0) irradiance[i] += cosine * found.irradiance[k];
  }
  const auto count = static_cast<double>(points.size());
  result.statistics["lit_share"] = static_cast<double>((paths.array() > 0).count()) / count;
  result.statistics["most_paths"] = static_cast<Index>(paths.maxCoeff());
  result.arrays = {{"paths", paths}, {"irradiance", irradiance}, {"reflection", reflection}};
}

}  // namespace

OperationImplementation illuminate_operation() {
  OperationImplementation operation;
  operation.name = "illuminate";
  operation.title = "Mirror illumination";
  operation.summary =
      "Computes how a point light reaches each point of a screen by reflection at the mirror: "
      "number of paths and irradiance.";
  operation.parameters = {
      Parameter::position("light",
                          "Position of the light, in the unit and pose of the points; both sides "
                          "of the mirror reflect, and nothing casts shadows.")};
  operation.arrays = {
      {"paths", ParameterType::Integer, 1,
       "Number of reflected paths from the light to the point."},
      {"irradiance", ParameterType::Real, 1,
       "Irradiance over all paths for a light of unit intensity, per square input unit: on the "
       "surface of a mesh, across each path for a cloud; infinite in a focus."},
      {"reflection", ParameterType::Real, 3,
       "Point where the shortest path meets the mirror, input units; NaN without one."}};
  operation.shown = "irradiance";
  operation.takes_any_mirror = true;
  operation.run = run_illuminate;
  return operation;
}

}  // namespace symsurf
