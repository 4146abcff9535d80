#include "point_group/coloured_group.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/math.h"
#include "point_group/point_group.h"
#include "point_group/symmetry_search.h"

namespace symsurf {

namespace {

struct PlacedGroup {
  PointGroup group;
  GroupPose pose;
};

class ColouredAxis {
 public:
  ColouredAxis(const ColouredSurface& surface, const Vector3& axis, const Vector3& centre)
      : surface_(surface), pose_(GroupPose::along(axis, centre)), order_(order()) {}

  // How many elements its group may have at most.
  double most_elements() const { return order_ == 0 ? infinity : 4 * static_cast<double>(order_); }

  // With what the shape has beside its turns about the axis, where the colours have it.
  PlacedGroup group(const AxialElements& shape) {
    AxialElements has;
    const Matrix3 across = reflection(Vector3::UnitZ());
    has.across = shape.across && keeps(across);
    has.rotary =
        shape.across && !has.across && order_ > 0 &&
        keeps(turn(Vector3::UnitZ(), std::numbers::pi / static_cast<double>(order_)) * across);
    has.vertical = shape.vertical && turned_to(reflection(Vector3::UnitX()));
    has.twofold =
        shape.twofold && !has.vertical && turned_to(turn(Vector3::UnitX(), std::numbers::pi));
    return {axial_group(order_, has), pose_};
  }

 private:
  bool keeps(const Matrix3& element) const { return surface_.is_kept_by(pose_.placed(element)); }

  // Of the turns; 0: any.
  Index order() const {
    constexpr int some = 8;
    constexpr Index largest = 64, most = 128;  // as of shapes
    const auto all_kept = [&](const std::vector<Matrix3>& turns) {
      return std::all_of(turns.begin(), turns.end(),
                         [&](const Matrix3& each) { return keeps(each); });
    };
    if (all_kept(any_turns(Vector3::UnitZ(), some))) return 0;
    Index order = 1;
    for (const Index prime : {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31})
      for (Index power = prime; power <= largest && order * prime <= most; power *= prime) {
        if (!all_kept(turns_of(power))) break;
        order *= prime;
      }
    return order;
  }

  // Turns the pose about its axis to where an element with its axis or normal along x keeps the
  // colours; false: nowhere.
  bool turned_to(const Matrix3& element) {
    if (order_ == 0) return keeps(element);
    constexpr double step = 0.0175;    // radians: a degree, that samples lie apart
    constexpr double finest = 0.0005;  // radians
    constexpr Index looked = 5000;     // samples at each step
    constexpr std::size_t most = 4;    // minima
    const double period = std::numbers::pi / static_cast<double>(order_);
    const auto at = [&](double angle) {
      GroupPose pose = pose_;
      pose.axes = turn(pose_.axes.col(2), angle) * pose_.axes;
      return pose;
    };
    const auto difference = [&](double angle, Index count) {
      return surface_.mean_difference(at(angle).placed(element), count);
    };
    std::vector<std::pair<double, double>> starts;
    for (double angle = 0; angle < period; angle += step)
      starts.emplace_back(difference(angle, looked), angle);
    std::stable_sort(starts.begin(), starts.end());
    suppress_non_maxima(starts, most, [&](const auto& a, const auto& b) {
      const double apart = std::abs(a.second - b.second);
      return std::min(apart, period - apart) < 4 * step;
    });
    for (auto [least, angle] : starts) {
      least = difference(angle, surface_.size());
      for (double reach = step / 2; reach > finest; reach /= 2)
        for (const double other : {angle - reach, angle + reach})
          if (const double there = difference(other, surface_.size()); there < least) {
            least = there;
            angle = other;
          }
      if (!surface_.is_kept_by(at(angle).placed(element))) continue;
      pose_ = at(angle);
      return true;
    }
    return false;
  }

  const ColouredSurface& surface_;
  GroupPose pose_;
  Index order_;
};

// The elements that keep the colours, less those that make none of a group with the rest.
PlacedGroup kept_elements(const Symmetries& found, const ColouredSurface& surface) {
  std::vector<Matrix3> kept, generators;
  GroupPose pose;
  pose.centre = found.centre;
  for (const Matrix4& element : found.elements)
    if (surface.is_kept_by(Eigen::Isometry3d(element)))
      kept.push_back(element.topLeftCorner<3, 3>());
  std::vector<Matrix3> elements{Matrix3::Identity()};
  for (const Matrix3& element : kept) {
    if (contains(elements, element)) continue;
    generators.push_back(element);
    std::vector<Matrix3> more = closed(generators);
    if (std::all_of(more.begin(), more.end(),
                    [&](const Matrix3& each) { return contains(kept, each); }))
      elements = std::move(more);
    else
      generators.pop_back();
  }
  return {PointGroup(std::move(elements)), pose};
}

// A sphere's: that of the colours as a relief, or that about one of its axes or a principal
// direction, the largest.
PlacedGroup group_of_sphere(const Symmetries& found, const ColouredSurface& surface,
                            const Context& context) {
  constexpr AxialElements all{.across = true, .vertical = true, .twofold = true};
  constexpr double least_score = 0.7;  // as of shapes
  const bool any_turn = std::all_of(found.axes.begin(), found.axes.end(), [&](const auto& axis) {
    return ColouredAxis(surface, axis.direction, found.centre).most_elements() == infinity;
  });
  if (any_turn) return {spherical_group(), {}};
  const Points relief = surface.relief(found.centre);
  const Symmetries raised = search_symmetries(
      checked_cloud(relief, {}, 4, context), false, least_score,
      [&](const Symmetries& group) {
        return std::all_of(group.elements.begin(), group.elements.end(), [&](const Matrix4& each) {
          return surface.is_kept_by(Eigen::Isometry3d(each));
        });
      },
      context);
  std::vector<Vector3> directions = surface.principal_directions(found.centre);
  for (const SymmetryAxis& axis : raised.axes) directions.push_back(axis.direction);
  suppress_non_maxima(directions, directions.size(), [](const Vector3& a, const Vector3& b) {
    constexpr double same = 0.01;  // radians
    return are_parallel(a, b, same);
  });
  const auto size = [](const PlacedGroup& placed) {
    return placed.group.continuous ? infinity : static_cast<double>(placed.group.elements.size());
  };
  PlacedGroup best = kept_elements(raised, surface);
  for (const Vector3& direction : directions) {
    ColouredAxis axis(surface, direction, found.centre);
    if (axis.most_elements() <= size(best)) continue;
    PlacedGroup other = axis.group(all);
    if (size(other) > size(best)) best = std::move(other);
  }
  return best;
}

}  // namespace

Symmetries coloured_group(const Symmetries& found, const ColouredSurface& surface,
                          const Context& context) {
  const auto has_plane = [&](bool across) {
    return std::any_of(found.planes.begin(), found.planes.end(), [&](const Plane& plane) {
      return (std::abs(plane.normal().dot(found.axes.front().direction)) > 0.5) == across;
    });
  };
  PlacedGroup kept;
  if (found.axes.empty() || found.axes.front().order != 0)
    kept = kept_elements(found, surface);
  else if (found.group == "K")
    kept = group_of_sphere(found, surface, context);
  else
    kept = ColouredAxis(surface, found.axes.front().direction, found.centre)
               .group({.across = has_plane(true),
                       .vertical = has_plane(false),
                       .twofold = found.axes.size() > 1});
  if (kept.group.name == found.group) return found;
  return described(kept.group, kept.pose, {.support = found.score, .missing = found.missing}, {});
}

}  // namespace symsurf
