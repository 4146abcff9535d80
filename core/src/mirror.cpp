#include <symsurf/errors.h>
#include <symsurf/mirror.h>

#include <limits>
#include <string>

namespace symsurf {

namespace {

template <typename Function>
Points each(PointsView points, const Function& function) {
  Points out(points.size(), 3);
  for (Index i = 0; i < points.size(); ++i) out.row(i) = function(points[i]).transpose();
  return out;
}

}  // namespace

Vector3 Mirror::no_point() { return Vector3::Constant(std::numeric_limits<double>::quiet_NaN()); }

Points Mirror::reflect(PointsView points) const {
  return each(points, [this](const Vector3& x) { return reflect(x); });
}

Points Mirror::project(PointsView points) const {
  return each(points, [this](const Vector3& x) { return foot(x); });
}

Eigen::VectorXd Mirror::signed_distance(PointsView points) const {
  Eigen::VectorXd out(points.size());
  for (Index i = 0; i < points.size(); ++i) out[i] = signed_distance(points[i]);
  return out;
}

Mesh Mirror::mesh(PointsView object, int resolution) const {
  if (object.empty())
    throw InvalidInput("a mirror made by hand has no footprint: give the points of the object");
  if (resolution < 1)
    throw InvalidParameter("resolution is " + std::to_string(resolution) +
                           "; allowed is 1 and above");
  return mesh_over(object, resolution);
}

}  // namespace symsurf
