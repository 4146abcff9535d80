#include <cmath>

#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/isotropic_remeshing.h"
#include "cloud/triangle_mesh.h"
#include "operations/meshes.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

constexpr double most_triangles = 1e7;  // of one side: some 4 GB

double mean_edge(PointsView points, TrianglesView faces) {
  double sum = 0;
  for (Index f = 0; f < faces.size(); ++f)
    for (int k = 0; k < 3; ++k) sum += (points[faces[f][k]] - points[faces[f][(k + 1) % 3]]).norm();
  return sum / (3 * static_cast<double>(faces.size()));
}

// Corners at the same position are one: no edge between faces is a boundary.
Triangles welded(const OperationInput& input, const Context& context) {
  const DistinctPoints distinct = distinct_points(input.points, context);
  Triangles faces = Eigen::Map<const Triangles>(input.faces.data(), input.faces.size(), 3);
  for (Index& corner : faces.reshaped()) corner = distinct.first[distinct.number[corner]];
  return faces;
}

// The half again, of other triangles, which take after the closest points of the shape.
Half remeshed(const Half& half, const OperationInput& input, const Mirror& mirror,
              const Remeshing& remeshing, const Context& context) {
  Remeshed made = isotropic_remeshing(half.points, half.faces, remeshing, context.stage(0, 0.8));
  const ClosestPointOnMesh surface(input.points, input.faces, context.stage(0.8, 0.9));
  Half other{std::move(made.points), std::move(made.faces), {}, {}, {}, std::move(made.marked)};
  const Index count = other.points.rows();
  other.parents.resize(count, 3);
  other.shares.resize(count, 3);
  for (Index i = 0; i < count; ++i) {
    if (i % 4096 == 0) context.check();
    if (other.on_mirror[i])
      if (const Vector3 foot = mirror.foot(other.points.row(i).transpose()); foot.allFinite())
        other.points.row(i) = foot.transpose();
    const ClosestPoint closest = surface(other.points.row(i).transpose());
    Index most;
    closest.weights.maxCoeff(&most);
    for (int k = 0; k < 3; ++k) {
      const Index corner = (most + k) % 3;
      other.parents(i, k) = input.faces[closest.face][corner];
      other.shares(i, k) = closest.weights[corner];
    }
  }
  for (const auto& face : other.faces.rowwise()) {
    const Vector3 centroid = other.points(face, Eigen::indexing::all).colwise().mean().transpose();
    other.face_sources.push_back(surface(centroid).face);
  }
  return other;
}

void run_remesh(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
                const Context& context, OperationResult& result) {
  const double diagonal = diagonal_of(input.points);
  const Triangles faces = welded(input, context.stage(0, 0.05));
  const Half half =
      half_of(input.points, faces, mirror, keeps_positive(values), context.stage(0.05, 0.15));
  const double area = surface_area(half.points, half.faces);
  if (!(area > 0))
    throw InvalidInput("the faces on the " + values.choice("side") +
                       " side of the mirror have no area; remesh needs a surface");
  Remeshing remeshing;
  remeshing.edge_length = values.real("edge_length") * diagonal;
  if (remeshing.edge_length == 0) remeshing.edge_length = mean_edge(input.points, faces);
  const double least = edge_length_of(area, most_triangles);
  if (remeshing.edge_length < least)
    throw InvalidParameter("edge_length is " + to_string(Value(remeshing.edge_length / diagonal)) +
                           " of the diagonal, which makes more than " +
                           to_string(Value(2 * most_triangles)) + " triangles; at least " +
                           to_string(Value(least / diagonal)) + " is allowed for this shape");
  remeshing.feature_angle = values.real("feature_angle");
  remeshing.marked = cut_edges(half);
  MirroredHalf made = with_image(remeshed(half, input, mirror, remeshing, context.stage(0.15, 0.9)),
                                 mirror, context.stage(0.9, 1));
  result.arrays = {{"partner", partner_array(made)}};
  const double edge_length = mean_edge(made.points, made.faces);
  result.statistics["edge_length"] = edge_length;
  result.statistics["edge_length_of_diagonal"] = edge_length / diagonal;
  set_shape(std::move(made), result);
}

}  // namespace

OperationImplementation remesh_operation() {
  OperationImplementation operation;
  operation.name = "remesh";
  operation.title = "Mirror remeshing";
  operation.summary =
      "Gives one side even triangles and the other their images: an exactly symmetric mesh.";
  operation.parameters = {
      Parameter::real("edge_length", 0, 0, 1, "diagonal",
                      "Of the triangles; 0: that which those of the shape have on average."),
      kept_side(),
      Parameter::real("feature_angle", 45, 0, 180, "degrees",
                      "Edges between faces whose normals differ by more stay sharp.")};
  operation.arrays = {{"partner", ParameterType::Integer, 1,
                       "The point that is its image, itself on the mirror.", false, true}};
  operation.moves_points = true;
  operation.makes_shape = true;
  operation.needs_faces = true;
  operation.run = run_remesh;
  return operation;
}

}  // namespace symsurf
