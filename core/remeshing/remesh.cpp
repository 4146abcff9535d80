#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "isotropic_remeshing.h"
#include "manifold_surface.h"
#include "operations/meshes.h"
#include "remeshing.h"

namespace symsurf {

namespace {

constexpr double most_triangles = 1e7;   // of one side: some 4 GB
constexpr double usual_triangles = 1e5;  // of one side: more are made where they are asked for
constexpr double usual_sagitta = 1e-3;   // diagonals
constexpr double bent_edges = 0.95;      // share of the edges that the usual length suits
constexpr double noticeable = 5e-3;      // diagonals

double mean_edge(PointsView points, TrianglesView faces) {
  double sum = 0;
  for (Index f = 0; f < faces.size(); ++f)
    for (int k = 0; k < 3; ++k) sum += (points[faces[f][k]] - points[faces[f][(k + 1) % 3]]).norm();
  return sum / (3 * static_cast<double>(faces.size()));
}

// The longest edge that the surface rises above by the sagitta at the most, but at features. Faces
// are chords of an arc, which turns by the angle between two of them along their heights.
double edge_length_for(double sagitta, double feature_angle, PointsView points,
                       TrianglesView faces) {
  std::map<std::pair<Index, Index>, Vector3> normals;
  std::vector<double> curvatures;
  for (Index f = 0; f < faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Index a = faces[f][k], b = faces[f][(k + 1) % 3];
      const Vector3 edge = points[b] - points[a];
      const Vector3 normal = edge.cross(points[faces[f][(k + 2) % 3]] - points[a]);
      const auto [other, is_first] = normals.try_emplace(std::minmax(a, b), normal);
      if (is_first) continue;
      const Vector3& n = other->second;
      const double angle = std::atan2(n.cross(normal).norm(), n.dot(normal));
      const double heights = (n.norm() + normal.norm()) / edge.norm();
      if (angle < feature_angle && heights > 0) curvatures.push_back(2 * angle / heights);
    }
  const double curvature = curvatures.empty() ? 0 : quantile(curvatures, bent_edges);
  return std::sqrt(8 * sagitta / curvature);
}

Vector3 centroid(const Half& half, Index face) {
  return half.points(half.faces.row(face), Eigen::indexing::all).colwise().mean().transpose();
}

// How far one surface lies from another at the most, at its vertices and centroids.
double distance_from(const ClosestPointOnMesh& surface, const Half& half, const Context& context) {
  double farthest = 0;
  const auto look = [&](const Vector3& x) {
    farthest = std::max(farthest, surface(x).squared_distance);
  };
  interruptible_for(context, half.points.rows(), [&](Index i) { look(half.points.row(i)); });
  interruptible_for(context, half.faces.rows(), [&](Index f) { look(centroid(half, f)); });
  return std::sqrt(farthest);
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
  for (Index f = 0; f < other.faces.rows(); ++f)
    other.face_sources.push_back(surface(centroid(other, f)).face);
  return other;
}

void report_distance(Values& statistics, const Half& half, const Half& other, double diagonal,
                     const Context& context) {
  const double distance = std::max(
      distance_from(ClosestPointOnMesh(other.points, other.faces), half, context.stage(0, 0.5)),
      distance_from(ClosestPointOnMesh(half.points, half.faces), other, context.stage(0.5, 1)));
  statistics["surface_distance"] = distance;
  statistics["surface_distance_of_diagonal"] = distance / diagonal;
  if (distance > noticeable * diagonal)
    statistics["warning"] = "the new triangles lie up to " + to_string(Value(distance)) + ", " +
                            to_string(Value(std::round(1e4 * distance / diagonal) / 100)) +
                            " % of the diagonal, from the surface; a smaller edge_length or "
                            "feature_angle brings them nearer";
}

void run_remesh(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
                const Context& context, OperationResult& result) {
  const double diagonal = diagonal_of(input.points);
  const ManifoldSurface surface =
      manifold_surface(input.points, input.faces, context.stage(0, 0.05));
  if (surface.faces.rows() == 0)
    throw InvalidInput("the faces have no area; remesh needs a surface");
  const Half half = half_of(surface.points, surface.faces, mirror, keeps_positive(values),
                            context.stage(0.05, 0.15));
  const double area = surface_area(half.points, half.faces);
  if (!(area > double_rounding * diagonal * diagonal))
    throw InvalidInput("the faces on the " + values.choice("side") +
                       " side of the mirror have no area; remesh needs a surface");
  // Faces without width have hardly any area, and still a triangle for each piece of their edges.
  const double edges = mean_edge(half.points, half.faces) * static_cast<double>(half.faces.rows());
  const auto shortest = [&](double triangles) {
    return std::max(edge_length_of(area, triangles), edges / triangles);
  };
  Remeshing remeshing;
  remeshing.edge_length = values.real("edge_length") * diagonal;
  remeshing.feature_angle = values.real("feature_angle");
  if (remeshing.edge_length == 0) {
    const double suited =
        edge_length_for(usual_sagitta * diagonal, remeshing.feature_angle * std::numbers::pi / 180,
                        half.points, half.faces);
    remeshing.edge_length = std::min(mean_edge(surface.points, surface.faces),
                                     std::max(suited, shortest(usual_triangles)));
  }
  const double least = shortest(most_triangles);
  if (remeshing.edge_length < least)
    throw InvalidParameter("edge_length is " + to_string(Value(remeshing.edge_length / diagonal)) +
                           " of the diagonal, which makes more than " +
                           to_string(Value(2 * most_triangles)) + " triangles; at least " +
                           to_string(Value(least / diagonal)) + " is allowed for this shape");
  remeshing.marked = cut_edges(half.faces, half.on_mirror);
  Half other = remeshed(half, input, mirror, remeshing, context.stage(0.15, 0.8));
  report_distance(result.statistics, half, other, diagonal, context.stage(0.8, 0.9));
  MirroredHalf made = with_image(std::move(other), mirror, context.stage(0.9, 1));
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
      "Remeshes one side with even triangles and mirrors them: an exactly symmetric mesh.";
  operation.parameters = {
      Parameter::real("edge_length", 0, 0, 1, "diagonal",
                      "Edge length of the triangles; 0: the longest that keeps them within 0.1 % "
                      "of the diagonal of the surface, at most the mean edge length of the shape."),
      kept_side(),
      Parameter::real("feature_angle", 45, 0, 180, "degrees",
                      "Edges between faces whose normals differ by more than this stay sharp.")};
  operation.arrays = {{"partner", ParameterType::Integer, 1,
                       "Index of the point that is its image, its own on the mirror.", false,
                       true}};
  operation.moves_points = true;
  operation.makes_shape = true;
  operation.needs_faces = true;
  operation.run = run_remesh;
  return operation;
}

}  // namespace symsurf
