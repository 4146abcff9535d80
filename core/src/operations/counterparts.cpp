#include "operations/counterparts.h"

#include <symsurf/errors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "base/parallel.h"
#include "cloud/normals.h"
#include "cloud/surface_spacing.h"
#include "mesh/closest_point_on_mesh.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

constexpr Index grain = 512;          // points; some ten microseconds each over a free-form mirror
constexpr double corner = 1e-9;       // a barycentric weight below this is rounding
constexpr double rim_of_mesh = 0.1;   // of the face's longest edge: how far past it is on it still
constexpr double rim_of_cloud = 1.5;  // spacings: inside a surface the nearest point is nearer
constexpr Index neighbours = 10;      // that a cloud's normals are estimated from

void require_images(const Points& images, std::string_view kind) {
  const Index count = images.rowwise().sum().array().isFinite().count();
  if (2 * count < images.rows())
    throw InvalidInput("only " + std::to_string(count) + " of " + std::to_string(images.rows()) +
                       " points have an image over this " + std::string(kind) +
                       "; at least half are needed: the mirror is to be in the unit and the pose "
                       "of the points");
}

// NaN where one is not known: of a vertex that no face uses.
double cosine_between(const Vector3& a, const Vector3& b) {
  return a.isZero(0) || b.isZero(0) ? std::numeric_limits<double>::quiet_NaN() : a.dot(b);
}

double volume_of(PointsView points, TrianglesView faces) {
  const Vector3 origin = points[0];
  double volume = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    const Vector3 a = points[faces[f][0]] - origin, b = points[faces[f][1]] - origin;
    volume += a.cross(b).dot(points[faces[f][2]] - origin) / 6;
  }
  return volume;
}

// How the mirror turns a normal at x: by what it does to two tangents, as it need not be an
// isometry.
Vector3 mirrored_normal(const Mirror& mirror, const Vector3& x, const Vector3& image,
                        const Vector3& normal, double step) {
  const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vector3 along_u = mirror.reflect(Vector3(x + step * u)) - image;
  const Vector3 along_v = mirror.reflect(Vector3(x + step * v)) - image;
  return -along_u.cross(along_v).stableNormalized();
}

}  // namespace

Counterparts::Counterparts(const OperationInput& input, const Mirror& mirror, const Limits& limits,
                           const Context& context)
    : all_(input.points.size()), images_(mirror.reflect(input.points, context.stage(0, 0.3))) {
  require_images(images_, mirror.kind());
  const Context rest = context.stage(0.3, 1);
  if (input.faces.empty())
    match_cloud(input, mirror, limits, rest);
  else
    match_mesh(input, limits, rest);
  matched_ =
      std::count_if(all_.begin(), all_.end(), [](const Counterpart& c) { return c.matched; });
}

void Counterparts::settle(Index i, const Limits& limits, double cosine) {
  Counterpart& c = all_[i];
  c.agreement = std::isfinite(cosine) ? std::clamp(cosine, 0.0, 1.0) : 1;
  c.matched = !c.past_rim && c.gap <= limits.distance && c.agreement >= limits.cosine;
}

void Counterparts::match_mesh(const OperationInput& input, const Limits& limits,
                              const Context& context) {
  const TriangleMesh& mesh = mesh_.emplace(input.points, input.faces, context.stage(0, 0));
  const std::vector<bool> is_boundary = mesh.is_boundary();
  normals_ = mesh.vertex_normals();
  // A mirror turns the winding round.
  const Points image_normals = -mesh.vertex_normals(TriangleMesh::Weight::Angle, images_);
  const bool is_closed = std::none_of(is_boundary.begin(), is_boundary.end(), std::identity());
  is_watertight_ = is_closed && mesh.refused().total() == 0;
  const double outwards = is_closed && volume_of(input.points, input.faces) < 0 ? -1 : 1;

  const ClosestPointOnMesh mirrored(images_, input.faces, context.stage(0, 0.2));
  const auto settle_at = [&](Index i, const ClosestPoint& closest) {
    Counterpart& c = all_[i];
    const Vector3 x = input.points[i];
    const Index* corners = input.faces[closest.face];
    c.face = closest.face;
    c.weights = closest.weights;
    c.place = closest.point;
    c.gap = std::sqrt(closest.squared_distance);
    c.on_surface = Vector3::Zero();
    Vector3 normal = Vector3::Zero();
    c.on_rim = true;
    double longest = 0, nearest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const Vector3 y = image(corners[k]);
      c.on_surface += closest.weights[k] * input.points[corners[k]];
      normal += closest.weights[k] * image_normals.row(corners[k]).transpose();
      c.on_rim = c.on_rim && (closest.weights[k] < corner || is_boundary[corners[k]]);
      longest = std::max(longest, (image(corners[(k + 1) % 3]) - y).norm());
      const double squared = (y - x).squaredNorm();
      if (squared < nearest) {
        nearest = squared;
        c.nearest = corners[k];
      }
    }
    normal.stableNormalize();
    const Vector3 gap = x - closest.point;
    c.past_rim = c.on_rim && (gap - gap.dot(normal) * normal).norm() > rim_of_mesh * longest;
    settle(i, limits, cosine_between(normal, normals_.row(i).transpose()));
  };
  parallel_for(context.stage(0.2, 1), input.points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const ClosestPoint closest = mirrored(input.points[i]);
      if (closest.face < 0) continue;
      settle_at(i, closest);
      if (all_[i].agreement >= limits.cosine) continue;
      // Where the sides of a thin part differ, the closest layer is the wrong one.
      const ClosestPoint facing = mirrored.facing(input.points[i], -normals_.row(i).transpose(),
                                                  limits.cosine, limits.distance * limits.distance);
      if (facing.face >= 0) settle_at(i, facing);
    }
  });
  normals_ *= outwards;
  spacing_ =
      std::sqrt(surface_area(input.points, input.faces) / static_cast<double>(input.points.size()));
}

void Counterparts::match_cloud(const OperationInput& input, const Mirror& mirror,
                               const Limits& limits, const Context& context) {
  const PointsView points = input.points;
  const PointTree tree(points, context.stage(0, 0.1));
  normals_ = estimate_normals(points, tree, std::min(neighbours, points.size()), "pca",
                              context.stage(0.1, 0.3));
  const Vector3 centroid = points.matrix().colwise().mean().transpose();
  for (Index i = 0; i < points.size(); ++i)
    if ((points[i] - centroid).dot(normals_.row(i).transpose()) < 0) normals_.row(i) *= -1;
  spacing_ = surface_spacing(points, tree);
  const double step = 1e-2 * spacing_;

  const PointTree mirrored(images_, context.stage(0.3, 0.4));
  parallel_for(context.stage(0.4, 1), points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      Counterpart& c = all_[i];
      const Vector3 x = points[i];
      c.nearest = mirrored.nearest(x).index;
      if (c.nearest < 0) continue;
      const Vector3 y = image(c.nearest), gap = x - y;
      const Vector3 normal =
          mirrored_normal(mirror, points[c.nearest], y, normals_.row(c.nearest).transpose(), step);
      const Vector3 along = gap - gap.dot(normal) * normal;
      c.place = y + along;
      c.on_surface = mirror.reflect(c.place);
      if (!c.on_surface.allFinite()) {  // past the points that have images
        c = {};
        continue;
      }
      c.gap = std::abs(gap.dot(normal));
      c.past_rim = along.norm() > rim_of_cloud * spacing_;
      // Estimated normals have no sign.
      settle(i, limits, std::abs(normal.dot(normals_.row(i).transpose())));
    }
  });
}

Parameter max_distance() {
  return Parameter::real("max_distance", 0.1, 0, 1, "diagonal",
                         "A point whose image is farther from the surface has no counterpart.");
}

Parameter max_angle() {
  return Parameter::real("max_angle", 60, 0, 90, "degrees",
                         "A point whose mirrored normal differs by more from that of the surface "
                         "has no counterpart.");
}

Counterparts::Limits limits_of(const ParameterValues& values, PointsView points) {
  // A right angle is allowed to be one to rounding.
  return {values.real("max_distance") * diagonal_of(points),
          std::cos(values.real("max_angle") * std::numbers::pi / 180) - 1e-12};
}

}  // namespace symsurf
