#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "reflection_search.h"

namespace symsurf {

namespace {

using Found = std::vector<SurfacePoint>;

Found on_plane(const Plane& plane, const LightPath& path) {
  const double s = plane.signed_distance(path.source), e = plane.signed_distance(path.eye);
  if (!(s * e > 0)) return {};
  const Vector3 position = (e * plane.foot(path.source) + s * plane.foot(path.eye)) / (s + e);
  return {{position, plane.normal(), Matrix3::Zero()}};
}

// In the plane through both ends and the centre.
Found on_sphere(const Sphere& sphere, const LightPath& path) {
  const Vector3 s = (path.source - sphere.centre()) / sphere.radius();
  const Vector3 e = (path.eye - sphere.centre()) / sphere.radius();
  const Vector3& longer = s.squaredNorm() > e.squaredNorm() ? s : e;
  if (longer.isZero(0)) return {};
  const Vector3 first = longer.normalized(), other = longer == s ? e : s;
  Vector3 second = other - other.dot(first) * first;
  constexpr double rounding = 1e-14;
  second = second.norm() > rounding * longer.norm() ? Vector3(second.normalized())
                                                    : Vector3(orthogonal_to(first).col(0));
  Found found;
  for (const Eigen::Vector2d& z :
       circle_reflection({s.dot(first), s.dot(second)}, {e.dot(first), e.dot(second)})) {
    const Vector3 normal = z.x() * first + z.y() * second;
    const Matrix3 shape = (Matrix3::Identity() - normal * normal.transpose()) / sphere.radius();
    found.push_back({sphere.centre() + sphere.radius() * normal, normal, shape});
  }
  return found;
}

// As the circle does across the axis; along it the path is straight when unrolled.
Found on_cylinder(const Cylinder& cylinder, const LightPath& path) {
  const auto across = orthogonal_to(cylinder.axis());
  const auto flat = [&](const Vector3& x) -> Eigen::Vector2d {
    return across.transpose() * (x - cylinder.point()) / cylinder.radius();
  };
  const auto height = [&](const Vector3& x) { return (x - cylinder.point()).dot(cylinder.axis()); };
  const Eigen::Vector2d s = flat(path.source), e = flat(path.eye);
  Found found;
  for (const Eigen::Vector2d& z : circle_reflection(s, e)) {
    const double from = (s - z).norm(), to = (e - z).norm();
    const Vector3 normal = across * z, around = cylinder.axis().cross(normal);
    const double along = (to * height(path.source) + from * height(path.eye)) / (from + to);
    found.push_back({cylinder.point() + cylinder.radius() * normal + along * cylinder.axis(),
                     normal, around * around.transpose() / cylinder.radius()});
  }
  return found;
}

std::function<Found(const LightPath&)> finder_of(const Mirror& mirror, const Vector3& eye) {
  if (const auto* plane = dynamic_cast<const Plane*>(&mirror))
    return [plane](const LightPath& path) { return on_plane(*plane, path); };
  if (const auto* sphere = dynamic_cast<const Sphere*>(&mirror))
    return [sphere](const LightPath& path) { return on_sphere(*sphere, path); };
  if (const auto* cylinder = dynamic_cast<const Cylinder*>(&mirror))
    return [cylinder](const LightPath& path) { return on_cylinder(*cylinder, path); };
  if (const auto* quadric = dynamic_cast<const Quadric*>(&mirror))
    return [search = QuadricReflection(*quadric, eye)](const LightPath& path) {
      return search(path.source);
    };
  return [search = std::make_shared<FootprintReflection>(mirror, eye)](const LightPath& path) {
    return (*search)(path.source);
  };
}

struct Reflection {
  Index source;
  double length, irradiance;
  Vector3 position;
};

// Each point once, by path length.
void add(const LightPath& path, Index source, const Found& found, std::vector<Reflection>& all) {
  constexpr double same = 1e-7;     // of the path: two points nearer to each other are one
  constexpr double at_end = 1e-12;  // of the path: a point nearer to an end is the end
  std::vector<Reflection> own;
  for (const SurfacePoint& at : found) {
    const double length = path.length(at.position);
    const double nearer =
        std::min((path.source - at.position).norm(), (path.eye - at.position).norm());
    if (!(nearer > at_end * length) || !path.is_reflected(at)) continue;
    const bool is_known = std::any_of(own.begin(), own.end(), [&](const Reflection& other) {
      return (other.position - at.position).norm() <= same * length;
    });
    if (!is_known) own.push_back({source, length, path.irradiance(at), at.position});
  }
  std::sort(own.begin(), own.end(), [](const Reflection& a, const Reflection& b) {
    if (a.length != b.length) return a.length < b.length;
    return std::lexicographical_compare(a.position.begin(), a.position.end(), b.position.begin(),
                                        b.position.end());
  });
  all.insert(all.end(), own.begin(), own.end());
}

}  // namespace

ReflectionPoints reflection_points(const Mirror& mirror, PointsView sources, const Vector3& eye,
                                   const Context& context) {
  require_finite(sources, "source");
  if (!eye.allFinite())
    throw InvalidInput("the eye is " + to_string(Value(eye)) + "; coordinates must be finite");
  const auto find = finder_of(mirror, eye);
  constexpr Index grain = 64;
  std::vector<std::vector<Reflection>> parts((sources.size() + grain - 1) / grain);
  parallel_for(context, sources.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      context.check();  // over a quadric near two planes a source takes long
      const LightPath path{sources[i], eye};
      add(path, i, find(path), parts[begin / grain]);
    }
  });
  Index count = 0;
  for (const auto& part : parts) count += static_cast<Index>(part.size());
  ReflectionPoints all{Points(count, 3), {}, Eigen::VectorXd(count), Eigen::VectorXd(count)};
  all.sources.resize(count);
  Index row = 0;
  for (const auto& part : parts)
    for (const Reflection& one : part) {
      all.positions.row(row) = one.position.transpose();
      all.sources[row] = one.source;
      all.path_lengths[row] = one.length;
      all.irradiance[row++] = one.irradiance;
    }
  return all;
}

}  // namespace symsurf
