#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

namespace {

// Coordinates along a mirror, and the tangent plane they are laid out in.
class Chart {
 public:
  virtual ~Chart() = default;

  const Vector3& origin() const { return origin_; }
  // Columns: the two directions of the coordinates and the normal.
  const Matrix3& axes() const { return axes_; }

  // From a point of the mirror to its coordinates.
  virtual Eigen::Vector2d flatten(const Vector3& foot) const = 0;
  // The point of the mirror at the coordinates, and the normal there; false beyond the mirror.
  virtual bool lift(const Eigen::Vector2d& at, Vector3& foot, Vector3& normal) const = 0;

 protected:
  Vector3 origin_;
  Matrix3 axes_;
};

// The feet of the footprint and the normals there.
struct Layout {
  std::vector<Vector3> feet, normals;
  Vector3 middle = Vector3::Zero(), normal = Vector3::Zero();
};

// The mirror's normal at the foot of x, towards where signed_distance is positive; false without.
bool foot_and_normal(const Mirror& mirror, const Vector3& x, Vector3& foot, Vector3& normal) {
  constexpr double least = 1e-7, off = 1e-5;
  foot = mirror.foot(x);
  double distance = mirror.signed_distance(x);
  if (!foot.allFinite()) return false;
  // On the mirror itself the normal shows only from a little way off.
  if (std::abs(distance) > least) {
    normal = (x - foot) / distance;
    return true;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 beside = x + off * Vector3::Unit(axis);
    distance = mirror.signed_distance(beside);
    if (!(std::abs(distance) > 0.5 * off)) continue;
    normal = (beside - mirror.foot(beside)) / distance;
    // That is the normal a little aside; straight above x it is x's own.
    const Vector3 above = x + off * normal;
    normal = (above - mirror.foot(above)) / mirror.signed_distance(above);
    return normal.allFinite();
  }
  return false;
}

Layout layout(const Mirror& mirror, PointsView object, const Context& context) {
  Layout l;
  for (Index i = 0; i < object.size(); ++i) {
    context.check();
    Vector3 foot, normal;
    if (!foot_and_normal(mirror, object[i], foot, normal)) continue;
    l.feet.push_back(foot);
    l.normals.push_back(normal);
    l.middle += foot;
    l.normal += normal;
  }
  if (l.feet.empty() || l.normal.isZero(1e-6 * static_cast<double>(l.feet.size())))
    throw InvalidInput("a mirror can be straightened only over points that have feet on it");
  l.middle /= static_cast<double>(l.feet.size());
  return l;
}

// Unrolls the cylinder: arc length around it, height along it.
class Unrolled final : public Chart {
 public:
  Unrolled(const Cylinder& cylinder, const Layout& layout)
      : radius_(cylinder.radius()), centre_(cylinder.point()) {
    const Vector3 axis = cylinder.axis();
    Vector3 outwards = Vector3::Zero();
    for (const Vector3& n : layout.normals) outwards += n - n.dot(axis) * axis;
    axes_.col(2) = outwards.normalized();
    axes_.col(1) = axis;
    axes_.col(0) = axis.cross(outwards).normalized();
    centre_ += (layout.middle - centre_).dot(axis) * axis;
    origin_ = centre_ + radius_ * axes_.col(2);
  }

  Eigen::Vector2d flatten(const Vector3& foot) const override {
    const Vector3 d = axes_.transpose() * (foot - centre_);
    return {radius_ * std::atan2(d.x(), d.z()), d.y()};
  }

  bool lift(const Eigen::Vector2d& at, Vector3& foot, Vector3& normal) const override {
    const double angle = at.x() / radius_;
    normal = axes_ * Vector3(std::sin(angle), 0, std::cos(angle));
    foot = centre_ + radius_ * normal + at.y() * axes_.col(1);
    return true;
  }

 private:
  double radius_;
  Vector3 centre_;
};

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
class Spread final : public Chart {
 public:
  Spread(const Mirror& mirror, const Layout& layout, const Context& context) : mirror_(mirror) {
    Vector3 normal;
    Index nearest = 0;
    for (std::size_t i = 0; i < layout.feet.size(); ++i)
      if ((layout.feet[i] - layout.middle).squaredNorm() <
          (layout.feet[nearest] - layout.middle).squaredNorm())
        nearest = static_cast<Index>(i);
    origin_ = layout.feet[nearest];
    normal = layout.normals[nearest];
    // It bends most where the normals vary most.
    Matrix3 spread = Matrix3::Zero();
    for (const Vector3& n : layout.normals) {
      const Vector3 across = n - n.dot(normal) * normal;
      spread += across * across.transpose();
    }
    Vector3 most = eigen_of(spread).vectors.col(2);
    most -= most.dot(normal) * normal;
    axes_.col(0) =
        most.norm() > 0.5 ? Vector3(most.normalized()) : Vector3(normal.unitOrthogonal());
    axes_.col(1) = normal.cross(axes_.col(0));
    axes_.col(2) = normal;
    for (int axis = 0; axis < 2; ++axis) measure(axis, layout, context);
  }

  Eigen::Vector2d flatten(const Vector3& foot) const override {
    const Vector3 d = axes_.transpose() * (foot - origin_);
    return {between(lengths_[0], d.x()), between(lengths_[1], d.y())};
  }

  bool lift(const Eigen::Vector2d& at, Vector3& foot, Vector3& normal) const override {
    return above({between(projections_[0], at.x()), between(projections_[1], at.y())}, foot,
                 normal);
  }

 private:
  // The mirror's point over the tangent plane's: Newton's method on the height.
  bool above(const Eigen::Vector2d& at, Vector3& foot, Vector3& normal) const {
    const Vector3 base = origin_ + axes_.leftCols<2>() * at;
    double height = 0;
    for (int step = 0; step < 60; ++step) {
      const Vector3 x = base + height * axes_.col(2);
      if (!foot_and_normal(mirror_, x, foot, normal)) return false;
      const double steep = normal.dot(axes_.col(2));
      if (!(steep > 0.05)) return false;
      const double move = normal.dot(foot - x) / steep;
      height += move;
      if (std::abs(move) <= 1e-13 * (1 + std::abs(height))) {
        foot = base + height * axes_.col(2);
        return true;
      }
    }
    return false;
  }

  void measure(int axis, const Layout& layout, const Context& context) {
    constexpr int samples = 256;
    double low = 0, high = 0;
    for (const Vector3& foot : layout.feet) {
      const double at = axes_.col(axis).dot(foot - origin_);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    const double step = std::max((high - low) / samples, 1e-12);  // also where nothing extends
    std::map<double, double>& lengths = lengths_[axis] = {{0, 0}};
    for (const double sign : {-1.0, 1.0}) {
      const double end = sign > 0 ? high : -low;
      double length = 0;
      Vector3 last = origin_;
      for (double at = step; at < end + step; at += step) {
        context.check();
        Eigen::Vector2d where = Eigen::Vector2d::Zero();
        where[axis] = sign * at;
        Vector3 foot, normal;
        // Where the line leaves the mirror, lengths go on as in the plane.
        if (!above(where, foot, normal)) foot = last + sign * step * axes_.col(axis);
        length += (foot - last).norm();
        lengths[sign * at] = sign * length;
        last = foot;
      }
    }
    if (lengths.size() < 2) lengths[step] = step;
    for (const auto& [projected, length] : lengths) projections_[axis][length] = projected;
  }

  const Mirror& mirror_;
  // Of lines across the mirror: arc length by the projection on the tangent plane, and back.
  std::array<std::map<double, double>, 2> lengths_, projections_;
};

// Laid out over an object that lies about the origin and is 1 long. The mirror must outlive it.
// Throws InvalidInput when nothing of the object has a foot.
std::unique_ptr<Chart> chart_of(const Mirror& mirror, PointsView object, const Context& context) {
  const Layout l = layout(mirror, object, context);
  if (const auto* cylinder = dynamic_cast<const Cylinder*>(&mirror))
    return std::make_unique<Unrolled>(*cylinder, l);
  return std::make_unique<Spread>(mirror, l, context);
}

// Where the footprint lies about the origin and is 1 long: as exact there as where the object lies,
// in whatever unit.
class Workplace {
 public:
  Workplace(const Mirror& mirror, PointsView points, const Context& context) {
    require_extent(points, "points");
    require_extent(mirror.footprint(), "points of the footprint");
    const PointsView object = mirror.footprint().empty() ? points : mirror.footprint();
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (Index i = 0; i < object.size(); ++i) {
      if (!object[i].allFinite()) continue;
      low = low.cwiseMin(object[i]);
      high = high.cwiseMax(object[i]);
    }
    if ((low.array() <= high.array()).all()) centre_ = low + (high - low) / 2;
    if ((low.array() < high.array()).any()) extent_ = (high - low).maxCoeff();
    Points entered(object.size(), 3);
    for (Index i = 0; i < object.size(); ++i) entered.row(i) = to_frame(object[i]).transpose();
    mirror_ = mirror.transformed(1 / extent_, Matrix3::Identity(), -centre_ / extent_);
    chart_ = chart_of(*mirror_, entered, context);
  }

  Vector3 to_frame(const Vector3& x) const { return (x - centre_) / extent_; }
  Vector3 from_frame(const Vector3& x) const { return centre_ + extent_ * x; }
  const Mirror& mirror() const { return *mirror_; }
  const Chart& chart() const { return *chart_; }

 private:
  Vector3 centre_ = Vector3::Zero();
  double extent_ = 1;
  std::unique_ptr<Mirror> mirror_;
  std::unique_ptr<Chart> chart_;
};

constexpr Index chunk = 512;  // points; some ten microseconds each over a free-form mirror

Vector3 straightened(const Vector3& x, const Mirror& mirror, const Chart& chart) {
  const Vector3 foot = mirror.foot(x);
  const Eigen::Vector2d at = chart.flatten(foot);
  return chart.origin() + chart.axes() * Vector3(at.x(), at.y(), mirror.signed_distance(x));
}

Vector3 restored(const Vector3& x, const Chart& chart) {
  const Vector3 at = chart.axes().transpose() * (x - chart.origin());
  Vector3 foot, normal;
  if (!chart.lift(at.head<2>(), foot, normal))
    return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  return foot + at.z() * normal;
}

// Columns: the chart's directions, laid along the mirror with this normal, and the normal.
Matrix3 along_mirror(const Chart& chart, const Vector3& normal) {
  Matrix3 axes;
  const Vector3 first = chart.axes().col(0);
  const Vector3 along = first - first.dot(normal) * normal;
  axes.col(0) = along.norm() > 1e-6 ? Vector3(along.normalized()) : normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  axes.col(2) = normal;
  return axes;
}

// Points beyond the mirror, which have no place, go rigidly with the nearest that has one.
Index carry_unplaced(Points& out, PointsView points, Bend way, const Workplace& position,
                     const Context& context) {
  std::vector<Index> placed, unplaced;
  for (Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) (out.row(i).allFinite() ? placed : unplaced).push_back(i);
  if (unplaced.empty()) return 0;
  if (placed.empty())
    throw InvalidInput("none of the " + std::to_string(unplaced.size()) +
                       " points has a foot on this " + std::string(position.mirror().kind()));
  const Points from = chosen_rows(points, placed);
  const PointTree tree(from, context);
  parallel_for(context, static_cast<Index>(unplaced.size()), chunk, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const Index i = unplaced[k], near = placed[tree.nearest(points[i]).index];
      const Vector3 there = out.row(near).transpose();
      const Vector3 on_body = way == Bend::Straighten ? points[near] : there;
      Vector3 foot, normal;
      Matrix3 turn = Matrix3::Identity();
      if (foot_and_normal(position.mirror(), position.to_frame(on_body), foot, normal))
        turn = position.chart().axes() *
               along_mirror(position.chart(), normal.normalized()).transpose();
      if (way == Bend::Restore) turn.transposeInPlace();
      out.row(i) = (there + turn * (points[i] - points[near])).transpose();
    }
  });
  return static_cast<Index>(unplaced.size());
}

}  // namespace

Points bend(PointsView points, const Mirror& mirror, Bend way, const Context& context,
            Index* unplaced) {
  context.report(0);
  const Workplace position(mirror, points, context);
  Points out(points.size(), 3);
  parallel_for(context.stage(0, 0.9), points.size(), chunk, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vector3 x = position.to_frame(points[i]);
      const Vector3 carried = way == Bend::Straighten
                                  ? straightened(x, position.mirror(), position.chart())
                                  : restored(x, position.chart());
      out.row(i) = position.from_frame(carried).transpose();
    }
  });
  const Index count = carry_unplaced(out, points, way, position, context.stage(0.9, 1));
  context.report(1);
  if (unplaced) *unplaced = count;
  return out;
}

Plane straight_mirror(const Mirror& mirror, PointsView object) {
  const Workplace position(mirror, object, Context());
  const Vector3 normal = position.chart().axes().col(2);
  return Plane(normal, -normal.dot(position.from_frame(position.chart().origin())));
}

}  // namespace symsurf
