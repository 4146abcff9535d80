#include <symsurf/errors.h>
#include <symsurf/surface_mirror.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/math.h"
#include "mirrors/closest_point.h"
#include "mirrors/grid_mesh.h"

namespace symsurf {

namespace {

// Where the surface is undefined the grid has holes.
Mesh without_holes(const Mesh& grid) {
  Mesh mesh;
  std::vector<Index> renamed(grid.vertices.rows(), -1);
  mesh.vertices.resize(grid.vertices.rows(), 3);
  Index rows = 0;
  for (Index v = 0; v < grid.vertices.rows(); ++v) {
    if (!grid.vertices.row(v).allFinite()) continue;
    renamed[v] = rows;
    mesh.vertices.row(rows++) = grid.vertices.row(v);
  }
  mesh.vertices.conservativeResize(rows, 3);
  mesh.triangles.resize(grid.triangles.rows(), 3);
  Index kept = 0;
  for (const auto& t : grid.triangles.rowwise()) {
    const Index a = renamed[t[0]], b = renamed[t[1]], c = renamed[t[2]];
    if (a >= 0 && b >= 0 && c >= 0) mesh.triangles.row(kept++) << a, b, c;
  }
  mesh.triangles.conservativeResize(kept, 3);
  return mesh;
}

}  // namespace

SurfaceMirror::SurfaceMirror(const Surface& surface, Mapping mapping)
    : surface_(symsurf::surface(surface.name)), mapping_(mapping) {}

SurfaceMirror::SurfaceMirror(const Surface& surface, Mapping mapping, double scale,
                             const Matrix3& rotation, const Vector3& translation)
    : SurfaceMirror(surface, mapping) {
  const Matrix3 product = rotation * rotation.transpose();
  if (!(scale > 0) || !std::isfinite(scale) || !translation.allFinite() ||
      !(product - Matrix3::Identity()).isZero(1e-9))
    throw InvalidInput("a surface needs a scale above 0, a rotation and a finite translation");
  scale_ = scale;
  rotation_ = rotation;
  translation_ = translation;
}

Vector3 SurfaceMirror::closest_in_frame(const Vector3& x) const {
  return closest_point(surface_, x);
}

Vector3 SurfaceMirror::foot_in_frame(const Vector3& x) const {
  if (mapping_ == Mapping::Perpendicular) return closest_in_frame(x);
  const double height = surface_(x.x(), x.y());
  return std::isfinite(height) ? Vector3(x.x(), x.y(), height) : no_point();
}

Vector3 SurfaceMirror::foot(const Vector3& x) const { return position(foot_in_frame(to_frame(x))); }

double SurfaceMirror::signed_distance(const Vector3& x) const {
  const Vector3 inside = to_frame(x), foot = foot_in_frame(inside);
  const double height = surface_(inside.x(), inside.y());
  const bool below = std::isfinite(height) ? inside.z() < height : inside.z() < foot.z();
  return scale_ * (below ? -1 : 1) * (inside - foot).norm();
}

Values SurfaceMirror::numbers() const {
  return {{"surface", surface_.name},
          {"mapping", std::string(mapping_ == Mapping::Fixed ? "fixed" : "perpendicular")},
          {"scale", scale_},
          {"rotation", Eigen::MatrixXd(rotation_)},
          {"translation", translation_}};
}

std::unique_ptr<Mirror> SurfaceMirror::transformed(double scale, const Matrix3& rotation,
                                                   const Vector3& translation) const {
  return std::make_unique<SurfaceMirror>(surface_, mapping_, scale * scale_, rotation * rotation_,
                                         scale * (rotation * translation_) + translation);
}

Mesh SurfaceMirror::mesh_over(PointsView object, int resolution) const {
  Eigen::Array2d low = Eigen::Array2d::Constant(infinity), high = -low;
  for (Index i = 0; i < object.size(); ++i) {
    const Vector3 foot = foot_in_frame(to_frame(object[i]));
    if (!foot.allFinite()) continue;
    low = low.min(foot.head<2>().array());
    high = high.max(foot.head<2>().array());
  }
  if (!low.allFinite())
    throw InvalidInput("surface " + surface_.name + " is undefined at all " +
                       std::to_string(object.size()) + " points");
  const Eigen::Array2d size = high - low;
  const GridCells cells = grid_cells(size.x(), size.y(), resolution);
  const Mesh grid = grid_mesh(cells, [&](double s, double t) -> Vector3 {
    const double x = low.x() + s * size.x(), y = low.y() + t * size.y();
    return position({x, y, surface_(x, y)});
  });
  return without_holes(grid);
}

}  // namespace symsurf
