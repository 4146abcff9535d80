#include <symsurf/context.h>
#include <symsurf/mirror.h>

#include <algorithm>
#include <limits>
#include <string>
#include <variant>

#include "base/parallel.h"
#include "cloud/cloud.h"

namespace symsurf {

namespace {

// A foot of a free-form mirror takes some ten microseconds.
constexpr Index grain = 1024;

// Cells along the longer side of a mesh, which holds their square: some gigabytes.
constexpr int finest = 4096;

template <typename Function>
Points each(PointsView points, const Context& context, const Function& function) {
  Points out(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) out.row(i) = function(points[i]).transpose();
  });
  return out;
}

// Eigen compares matrices of one size only.
bool are_equal(const Value& a, const Value& b) {
  const auto* one = std::get_if<Eigen::MatrixXd>(&a);
  const auto* other = std::get_if<Eigen::MatrixXd>(&b);
  if (one && other && (one->rows() != other->rows() || one->cols() != other->cols())) return false;
  return a == b;
}

}  // namespace

Vector3 Mirror::no_point() { return Vector3::Constant(std::numeric_limits<double>::quiet_NaN()); }

Vector3 Mirror::reflect(const Vector3& x) const {
  return has_image(x) ? Vector3(x + 2 * (foot(x) - x)) : no_point();
}

Points Mirror::reflect(PointsView points, const Context& context) const {
  return each(points, context, [this](const Vector3& x) { return reflect(x); });
}

Points Mirror::project(PointsView points, const Context& context) const {
  return each(points, context, [this](const Vector3& x) { return foot(x); });
}

Eigen::VectorXd Mirror::signed_distance(PointsView points, const Context& context) const {
  Eigen::VectorXd out(points.size());
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) out[i] = signed_distance(points[i]);
  });
  return out;
}

bool Mirror::operator==(const Mirror& other) const {
  if (kind() != other.kind()) return false;
  const Values own = numbers(), others = other.numbers();
  return std::equal(own.begin(), own.end(), others.begin(), others.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && are_equal(a.second, b.second);
                    });
}

Mesh Mirror::mesh(PointsView object, int resolution, const Context& context) const {
  if (object.empty())
    throw InvalidInput(
        "there are no points to lay the mesh over: a mirror made by hand has no "
        "footprint of its own, give the points of the object");
  require_finite(object, "point");
  require_extent(object, "points");
  if (resolution < 1 || resolution > finest)
    throw InvalidParameter("resolution is " + std::to_string(resolution) + "; allowed is 1 to " +
                           std::to_string(finest));
  Mesh mesh = mesh_over(object, resolution, context);
  require_finite(mesh.vertices, "vertex of the mirror's mesh");
  return mesh;
}

}  // namespace symsurf
