#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

namespace {

// The foot of x, and for its normal the direction that x is mapped along; none that is not finite.
std::optional<Foot> mapped(const Mirror& mirror, const Vector3& x) {
  std::optional<Foot> foot = mirror.at(x);
  if (!foot || !foot->point.allFinite()) return std::nullopt;
  foot->normal = mirror.direction(*foot);
  return foot;
}

// Coordinates along a mirror, and the tangent plane they are laid out in.
struct Chart {
  Vector3 origin;
  Matrix3 axes;  // columns: the two directions of the coordinates and the normal
  std::function<Eigen::Vector2d(const Vector3& foot)> flatten;
  // The mirror's foot at the coordinates; none beyond the mirror.
  std::function<std::optional<Foot>(const Eigen::Vector2d& at)> lift;
  double rise = 1;  // heights over distances from the mirror
};

// Columns: the directions, laid along the mirror with this normal, and the normal.
Matrix3 along_mirror(const Vector3& direction, const Vector3& normal) {
  Matrix3 axes;
  const Vector3 along = direction - direction.dot(normal) * normal;
  axes.col(0) = along.norm() > 1e-6 ? Vector3(along.normalized()) : normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  axes.col(2) = normal;
  return axes;
}

// The feet of an object, their mean and the sum of their normals.
struct Layout {
  std::vector<Foot> feet;
  Vector3 middle = Vector3::Zero(), normal = Vector3::Zero();
};

Layout layout(const Mirror& mirror, PointsView object, const Context& context) {
  Layout l;
  for (Index i = 0; i < object.size(); ++i) {
    context.check();
    const std::optional<Foot> foot = mapped(mirror, object[i]);
    if (!foot) continue;
    l.feet.push_back(*foot);
    l.middle += foot->point;
    l.normal += foot->normal;
  }
  const auto count = static_cast<double>(l.feet.size());
  if (l.normal.isZero(1e-6 * count))
    throw InvalidInput("a mirror can be straightened only over points that have feet on it");
  l.middle /= count;
  return l;
}

// Unrolls the cylinder: arc length around it, height along it.
Chart unrolled(const Cylinder& cylinder, const Layout& layout) {
  const double radius = cylinder.radius();
  const Vector3& axis = cylinder.axis();
  const Vector3 outwards = layout.normal - layout.normal.dot(axis) * axis;
  const Matrix3 axes = along_mirror(axis.cross(outwards), outwards.normalized());
  const Vector3 centre = cylinder.point() + (layout.middle - cylinder.point()).dot(axis) * axis;
  return {centre + radius * axes.col(2), axes,
          [=](const Vector3& foot) -> Eigen::Vector2d {
            const Vector3 d = axes.transpose() * (foot - centre);
            return {radius * std::atan2(d.x(), d.z()), d.y()};
          },
          [=](const Eigen::Vector2d& at) {
            const double angle = at.x() / radius;
            const Vector3 normal = axes * Vector3(std::sin(angle), 0, std::cos(angle));
            return Foot{centre + radius * normal + at.y() * axes.col(1), normal, 0};
          }};
}

// Heights over an oblique plane become upright: what sheared the shape is undone.
Chart unsheared(const ObliquePlane& plane, const Layout& layout) {
  const Vector3 origin = layout.middle;
  const Matrix3 axes = along_mirror(plane.direction(), plane.normal());
  return {origin, axes,
          [=](const Vector3& foot) -> Eigen::Vector2d {
            return axes.leftCols<2>().transpose() * (foot - origin);
          },
          [=, direction = plane.direction()](const Eigen::Vector2d& at) {
            return Foot{origin + axes.leftCols<2>() * at, direction, 0};
          },
          plane.normal().dot(plane.direction())};
}

// The value at a key, between the two nearest ones; of at least two.
double between(const std::map<double, double>& values, double key) {
  auto next = values.lower_bound(key);
  if (next == values.begin()) ++next;
  if (next == values.end()) --next;
  const auto last = std::prev(next);
  const double share = (key - last->first) / (next->first - last->first);
  return last->second + share * (next->second - last->second);
}

// Feet projected on the tangent plane in the middle, each coordinate stretched to arc length.
Chart spread(const Mirror& mirror, const Layout& layout, const Context& context) {
  const auto from_middle = [&](const Foot& foot) {
    return (foot.point - layout.middle).squaredNorm();
  };
  const Foot& nearest = *std::min_element(
      layout.feet.begin(), layout.feet.end(),
      [&](const Foot& a, const Foot& b) { return from_middle(a) < from_middle(b); });
  const Vector3 origin = nearest.point, normal = nearest.normal;
  // It bends most where the normals vary most.
  Matrix3 variation = Matrix3::Zero();
  for (const Foot& foot : layout.feet) {
    const Vector3 across = foot.normal - foot.normal.dot(normal) * normal;
    variation += across * across.transpose();
  }
  const Matrix3 axes = along_mirror(eigen_of(variation).vectors.col(2), normal);

  // The mirror's point over the tangent plane's: Newton's method on the height.
  const auto above = [&mirror, origin, axes](const Eigen::Vector2d& at) -> std::optional<Foot> {
    const Vector3 base = origin + axes.leftCols<2>() * at;
    double height = 0;
    for (int step = 0; step < 60; ++step) {
      std::optional<Foot> foot = mapped(mirror, base + height * axes.col(2));
      const double steep = foot ? foot->normal.dot(axes.col(2)) : 0;
      if (!(steep > 0.05)) break;
      const double move = -foot->distance / steep;
      height += move;
      if (std::abs(move) > 1e-13 * (1 + std::abs(height))) continue;
      foot->point = base + height * axes.col(2);
      return foot;
    }
    return std::nullopt;
  };

  // Of lines across the mirror: arc length by the projection on the tangent plane, and back.
  std::array<std::map<double, double>, 2> lengths, projections;
  for (int axis = 0; axis < 2; ++axis) {
    constexpr int samples = 256;
    double low = 0, high = 0;
    for (const Foot& foot : layout.feet) {
      const double at = axes.col(axis).dot(foot.point - origin);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const double step = std::max((high - low) / samples, 1e-12);  // also where nothing extends
    lengths[axis] = {{0, 0}};
    for (const double sign : {-1.0, 1.0}) {
      const double end = sign > 0 ? high : -low;
      double length = 0;
      Vector3 last = origin;
      for (double at = step; at < end + step; at += step) {
        context.check();
        const std::optional<Foot> foot = above(sign * at * Eigen::Vector2d::Unit(axis));
        // Where the line leaves the mirror, lengths go on as in the plane.
        const Vector3 here = foot ? foot->point : last + sign * step * axes.col(axis);
        length += (here - last).norm();
        lengths[axis][sign * at] = sign * length;
        last = here;
      }
    }
    if (lengths[axis].size() < 2) lengths[axis][step] = step;
    for (const auto& [projected, length] : lengths[axis]) projections[axis][length] = projected;
  }
  return {origin, axes,
          [=](const Vector3& foot) -> Eigen::Vector2d {
            const Vector3 d = axes.transpose() * (foot - origin);
            return {between(lengths[0], d.x()), between(lengths[1], d.y())};
          },
          [=](const Eigen::Vector2d& at) {
            return above({between(projections[0], at.x()), between(projections[1], at.y())});
          }};
}

// Where the footprint lies about the origin and is 1 long: as exact there as where the object lies,
// in whatever unit. Throws InvalidInput when nothing of the footprint has a foot.
struct Workplace {
  Workplace(const Mirror& given, PointsView points, const Context& context) {
    require_extent(points, "points");
    require_extent(given.footprint(), "points of the footprint");
    const PointsView object = given.footprint().empty() ? points : given.footprint();
    const Points finite = finite_rows(object.matrix());
    if (finite.rows() > 0) {
      const Vector3 low = finite.colwise().minCoeff(),
                    size = finite.colwise().maxCoeff().transpose() - low;
      centre = low + size / 2;
      if (size.maxCoeff() > 0) extent = size.maxCoeff();
    }
    mirror = given.transformed(1 / extent, Matrix3::Identity(), -centre / extent);
    const Layout l =
        layout(*mirror, Points((finite.rowwise() - centre.transpose()) / extent), context);
    const auto* cylinder = dynamic_cast<const Cylinder*>(mirror.get());
    const auto* oblique = dynamic_cast<const ObliquePlane*>(mirror.get());
    chart = cylinder  ? unrolled(*cylinder, l)
            : oblique ? unsheared(*oblique, l)
                      : spread(*mirror, l, context);
  }

  Vector3 to_frame(const Vector3& x) const { return (x - centre) / extent; }
  Vector3 from_frame(const Vector3& x) const { return centre + extent * x; }

  // Not finite without a foot.
  Vector3 straightened(const Vector3& x) const {
    const std::optional<Foot> foot = mirror->at(x);
    if (!foot) return Vector3::Constant(NAN);
    const Eigen::Vector2d at = chart.flatten(foot->point);
    return chart.origin + chart.axes * Vector3(at.x(), at.y(), chart.rise * foot->distance);
  }

  // The derivative of straightened(); NaN without a foot.
  Matrix3 jacobian(const Vector3& x) const {
    const std::optional<Foot> foot = mirror->at(x);
    if (!foot) return Matrix3::Constant(NAN);
    constexpr double step = 1e-5;  // of the extent: its square and rounding over it are as small
    Matrix3 rows;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 beside = step * Vector3::Unit(axis);
      rows.col(axis).head<2>() =
          (chart.flatten(foot->point + beside) - chart.flatten(foot->point - beside)) / (2 * step);
    }
    rows.topRows<2>() *= mirror->foot_jacobian(*foot);
    const Vector3& normal = foot->normal;
    rows.row(2) = chart.rise / normal.dot(mirror->direction(*foot)) * normal.transpose();
    return chart.axes * rows;
  }

  Vector3 restored(const Vector3& x) const {
    const Vector3 at = chart.axes.transpose() * (x - chart.origin);
    const std::optional<Foot> foot = chart.lift(at.head<2>());
    return foot ? Vector3(foot->point + at.z() / chart.rise * foot->normal)
                : Vector3::Constant(NAN);
  }

  Vector3 centre = Vector3::Zero();
  double extent = 1;
  std::unique_ptr<Mirror> mirror;
  Chart chart;
};

constexpr Index chunk = 512;  // points; some ten microseconds each over a free-form mirror

// Points beyond the mirror, which have no place, go rigidly with the nearest that has one.
Index carry_unplaced(Points& out, PointsView points, Bend way, const Workplace& position,
                     const Context& context, std::vector<Matrix3>* jacobians) {
  std::vector<Index> placed, unplaced;
  for (Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) (out.row(i).allFinite() ? placed : unplaced).push_back(i);
  const auto count = static_cast<Index>(unplaced.size());
  if (count == 0) return 0;
  if (placed.empty())
    throw InvalidInput("none of the " + std::to_string(count) + " points has a foot on this " +
                       std::string(position.mirror->kind()));
  const Points from = chosen_rows(points, placed);
  const PointTree tree(from, context);
  parallel_for(context, count, chunk, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const Index i = unplaced[k], near = placed[tree.nearest(points[i]).index];
      const Vector3 there = out.row(near);
      const Vector3 on_body = way == Bend::Straighten ? points[near] : there;
      Matrix3 turn = Matrix3::Identity();
      if (const auto foot = mapped(*position.mirror, position.to_frame(on_body)))
        turn = position.chart.axes *
               along_mirror(position.chart.axes.col(0), foot->normal).transpose();
      if (way == Bend::Restore) turn.transposeInPlace();
      out.row(i) = there + turn * (points[i] - points[near]);
      if (jacobians) (*jacobians)[i] = turn;
    }
  });
  return count;
}

}  // namespace

Points bend(PointsView points, const Mirror& mirror, Bend way, const Context& context,
            Index* unplaced, std::vector<Matrix3>* jacobians) {
  context.report(0);
  const Workplace position(mirror, points, context);
  Points out(points.size(), 3);
  if (jacobians) jacobians->resize(points.size());
  parallel_for(context.stage(0, 0.9), points.size(), chunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vector3 x = position.to_frame(points[i]);
      out.row(i) = position.from_frame(way == Bend::Straighten ? position.straightened(x)
                                                               : position.restored(x));
      if (!jacobians) continue;
      (*jacobians)[i] = way == Bend::Straighten
                            ? position.jacobian(x)
                            : Matrix3(position.jacobian(position.to_frame(out.row(i))).inverse());
    }
  });
  const Index count = carry_unplaced(out, points, way, position, context.stage(0.9, 1), jacobians);
  context.report(1);
  if (unplaced) *unplaced = count;
  return out;
}

Plane straight_mirror(const Mirror& mirror, PointsView object) {
  const Workplace position(mirror, object, Context());
  const Vector3 normal = position.chart.axes.col(2);
  return Plane(normal, -normal.dot(position.from_frame(position.chart.origin)));
}

}  // namespace symsurf
