#include "point_group/symmetry_search.h"

#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/exact_isometries.h"
#include "point_group/point_group.h"

namespace symsurf {

namespace {

// Of the fit of the turns alone: a group that fits so much worse has more elements than the cloud.
constexpr double below_turns = 0.03;
// Of a part of a surface of revolution, of as much of the turn: as of continuous groups, and more
// the longer its rims are for what it has of surface.
constexpr double whole_turn = 0.95, most_outliers_of_whole = 0.04;

// Of a pose whose x is to point along a direction, which is laid across z.
GroupPose with_x(GroupPose pose, const Vector3& x) {
  const Vector3 z = pose.axes.col(2), across = (x - x.dot(z) * z).normalized();
  pose.axes << across, z.cross(across), z;
  return pose;
}

class SymmetrySearch {
 public:
  SymmetrySearch(const Cloud& cloud, double minimum_score,
                 const std::function<bool(const Symmetries&)>& accepts, const Context& context)
      : cloud_(cloud),
        accepts_(accepts),
        context_(context),
        test_(cloud, minimum_score, context.stage(0, 0.4)) {}

  Symmetries run() {
    planes_ = find_planes(test_);
    context_.report(0.5);
    centre_ = centre_of(planes_);
    axes_ = find_axes(test_, planes_, centre_);
    context_.report(0.8);
    if (std::optional<Symmetries> found = partly_turned()) return *found;
    for (const auto& kind : {&SymmetrySearch::spherical, &SymmetrySearch::polyhedral,
                             &SymmetrySearch::axial, &SymmetrySearch::of_two})
      if (std::optional<Symmetries> found = (this->*kind)()) return *found;
    Symmetries none = described({}, {}, {.support = 1}, cloud_.frame);
    accepts_(none);
    return none;
  }

 private:
  struct Placed {
    PointGroup group;
    GroupPose pose;
    double expected = 0;  // fit: that of the turns alone
  };

  // Part of a surface of revolution, whose axis whole turns did not find.
  std::optional<Symmetries> partly_turned() const {
    const bool is_found = std::any_of(axes_.begin(), axes_.end(),
                                      [](const FoundDirection& axis) { return axis.order == 0; });
    if (is_found) return {};
    const std::optional<Revolution> part = find_revolution(cloud_, test_, context_.stage(0.8, 0.8));
    if (!part || part->turn > whole_turn ||
        part->axis.vote.outliers > most_outliers_of_whole / part->turn)
      return {};
    // Of a gear turns map the body, those by a tooth all of it.
    for (const FoundDirection& axis : axes_)
      if (axis.order > 2 && axis.vote.fit > part->axis.vote.fit + below_turns) return {};
    OrbitVote vote = part->axis.vote;
    vote.missing = 1 - part->turn;
    Symmetries found =
        described(axial_group(0, {.vertical = true}), part->axis.pose, vote, cloud_.frame);
    if (!accepts_(found)) return {};
    return found;
  }

  std::optional<Symmetries> spherical() const {
    if (axes_.empty() || axes_.front().order != 0) return {};
    const FoundDirection& axis = axes_.front();
    const GroupPose across = GroupPose::along(Vector3(axis.pose.axes.col(0)), axis.pose.centre);
    const auto other = test_.tried(across, any_turns(Vector3::UnitZ(), 4));
    if (!other) return {};
    return verified({spherical_group(), other->pose});
  }

  using Passed = std::optional<SymmetryTest::Passed>;

  // The largest that holds the first two axes.
  std::optional<Symmetries> polyhedral() const {
    if (axes_.size() < 2 || axes_[1].order < 3 || axes_[0].order == 0) return {};
    for (const Index order : {5, 4, 3}) {
      const Passed turns = placed_on_axes(polyhedral_group(order, false, false));
      if (!turns) continue;
      const auto has = [&](const Matrix3& element) {
        return test_.tried(turns->pose, {element}).has_value();
      };
      const bool inversion = has(-Matrix3::Identity());
      const bool mirror = !inversion && order == 3 && has(reflection(Vector3(1, -1, 0)));
      for (const PointGroup& group :
           {polyhedral_group(order, inversion, mirror), polyhedral_group(order, false, false)})
        if (auto found = verified({group, turns->pose, turns->vote.fit})) return found;
    }
    return {};
  }

  // Where two axes of the turns lie along the first two that were found.
  Passed placed_on_axes(const PointGroup& turns) const {
    constexpr std::ptrdiff_t some = 4;
    const Vector3 a = axes_[0].z(), b = axes_[1].z();
    const std::vector<Matrix3> elements(turns.elements.begin() + 1,
                                        turns.elements.begin() + 1 + some);
    const std::vector<PointGroup::Axis> ideal = turns.axes();
    const auto first = std::find_if(ideal.begin(), ideal.end(), [&](const PointGroup::Axis& axis) {
      return axis.order == axes_[0].order;
    });
    if (first == ideal.end()) return {};
    Passed best;
    for (const PointGroup::Axis& second : ideal) {
      const double cosine = first->direction.dot(second.direction);
      if (second.order != axes_[1].order ||
          std::abs(std::abs(cosine) - std::abs(a.dot(b))) > same_direction)
        continue;
      const Vector3 other = cosine * a.dot(b) < 0 ? Vector3(-second.direction) : second.direction;
      const GroupPose pose{basis_of(a, b) * basis_of(first->direction, other).transpose(), centre_};
      const auto passed = test_.tried(pose, elements);
      if (passed && (!best || passed->vote.fit > best->vote.fit)) best = passed;
    }
    return best;
  }

  // About the axes of the highest order first, and of the groups about these the largest: where one
  // fails, those that it holds and its like about the other axes are left.
  std::optional<Symmetries> axial() const {
    for (auto first = axes_.begin(); first != axes_.end();) {
      const auto last = std::find_if(first, axes_.end(), [&](const FoundDirection& axis) {
        return axis.order != first->order;
      });
      std::vector<Placed> groups;
      for (; first != last; ++first) {
        const std::vector<Placed> some = about(*first);
        groups.insert(groups.end(), some.begin(), some.end());
      }
      std::stable_sort(groups.begin(), groups.end(), [](const Placed& a, const Placed& b) {
        return a.group.elements.size() > b.group.elements.size();
      });
      for (const Placed& placed : groups)
        if (std::optional<Symmetries> found = verified(placed)) return found;
    }
    return {};
  }

  // The best of the groups of one element beside the identity.
  std::optional<Symmetries> of_two() const {
    std::vector<std::pair<double, Placed>> groups;
    for (const FoundDirection& plane : planes_)
      groups.push_back({plane.vote.share(), {reflection_group(), plane.pose}});
    for (const FoundDirection& axis : axes_)
      if (axis.order == 2) groups.push_back({axis.vote.share(), {axial_group(2, {}), axis.pose}});
    if (const auto inverted = test_.tried({}, {Matrix3(-Matrix3::Identity())}))
      groups.push_back({inverted->vote.share(), {inversion_group(), inverted->pose}});
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [share, placed] : groups)
      if (std::optional<Symmetries> found = verified(placed)) return found;
    return {};
  }

  // The group of all that there is about an axis, then groups of less.
  std::vector<Placed> about(const FoundDirection& axis) const {
    const auto order = static_cast<double>(std::max<Index>(1, axis.order));
    const Matrix3 across = reflection(Vector3::UnitZ());
    const Matrix3 rotary = turn(Vector3::UnitZ(), std::numbers::pi / order) * across;
    AxialElements has;
    GroupPose pose = axis.pose;  // the turns leave it free along the axis
    // Whether the first of two, of which a round body may seem to have either; where it fits no
    // worse than the turns the other is not asked for.
    const auto is_first = [&](const Passed& one, const auto& other) {
      if (!one || one->vote.fit >= axis.vote.fit - below_turns) return one.has_value();
      const Passed second = other();
      return !second || one->vote.fit >= second->vote.fit;
    };
    const Passed flat = test_.tried(pose, {across});
    const auto turned_flat = [&] {
      return axis.order == 0 ? Passed() : test_.tried(pose, {rotary});
    };
    has.across = is_first(flat, turned_flat);
    const Passed level = has.across ? flat : turned_flat();
    has.rotary = level && !has.across;
    if (level) pose.centre = level->pose.centre;
    const Passed upright = scanned(axis, pose, reflection(Vector3::UnitX()));
    const auto half_turned = [&] {
      return scanned(axis, pose, turn(Vector3::UnitX(), std::numbers::pi));
    };
    has.vertical = is_first(upright, half_turned);
    const Passed standing = has.vertical ? upright : half_turned();
    has.twofold = standing && !has.vertical;
    if (standing) pose = standing->pose;
    const std::array<AxialElements, 4> choices{has,
                                               {.vertical = has.vertical, .twofold = has.twofold},
                                               {.across = has.across, .rotary = has.rotary},
                                               {}};
    std::vector<Placed> groups;
    for (const AxialElements& some : choices) {
      const PointGroup group = axial_group(axis.order, some);
      if (group.elements.size() <= 2 && axis.order == 2) continue;  // of_two() weighs these
      const bool is_new = std::none_of(groups.begin(), groups.end(), [&](const Placed& other) {
        return other.group.name == group.name;
      });
      if (is_new) groups.push_back({group, pose, axis.vote.fit});
    }
    return groups;
  }

  // The pose turned about its z to where the element along x is a symmetry.
  Passed scanned(const FoundDirection& axis, const GroupPose& about, const Matrix3& element) const {
    constexpr double width = 0.035;  // radians
    const Index order = std::max<Index>(1, axis.order);
    const double period = std::numbers::pi / static_cast<double>(order);
    std::vector<std::pair<double, GroupPose>> starts;
    const auto add = [&](const Vector3& x) {
      const GroupPose pose = with_x(about, x);
      starts.emplace_back(test_.fit().support(pose, element, rough_tolerance), pose);
    };
    for (const FoundDirection& plane : planes_)
      if (std::abs(plane.z().dot(axis.z())) < same_direction) {
        add(plane.z());
        add(plane.z().cross(axis.z()));
      }
    for (double angle = 0; angle < (axis.order == 0 ? width : period); angle += width)
      add(turn(axis.z(), angle) * Vector3(axis.pose.axes.col(0)));
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    constexpr std::size_t most = 4;
    constexpr double good_enough = 0.01;  // fit below that of the turns
    suppress_non_maxima(starts, most, [](const auto& a, const auto& b) {
      return are_parallel(a.second.axes.col(0), b.second.axes.col(0), 2.5 * width);
    });
    // With the turns, which hold the axis where it is.
    std::vector<Matrix3> elements{element};
    if (axis.order > 1) elements.push_back(turns_of(axis.order, 1).front());
    Passed best;
    for (const auto& [support, start] : starts) {
      const auto found = test_.tried(start, elements);
      if (found && (!best || found->vote.fit > best->vote.fit)) best = found;
      if (best && best->vote.fit >= axis.vote.fit - good_enough) break;
    }
    return best;
  }

  std::optional<Symmetries> verified(const Placed& placed) const {
    const bool continuous = placed.group.continuous || placed.group.all;
    const auto passed = test_.passed(placed.pose, tested_elements(placed.group), continuous);
    if (!passed || passed->vote.fit < placed.expected - below_turns) return {};
    Symmetries found = described(placed.group, passed->pose, passed->vote, cloud_.frame);
    if (!accepts_(found)) return {};
    return found;
  }

  const Cloud& cloud_;
  const std::function<bool(const Symmetries&)>& accepts_;
  const Context& context_;
  SymmetryTest test_;
  std::vector<FoundDirection> planes_, axes_;
  Vector3 centre_ = Vector3::Zero();
};

}  // namespace

Symmetries described(const PointGroup& group, const GroupPose& pose, const OrbitVote& vote,
                     const PrincipalFrame& frame) {
  const Matrix3 axes = frame.axes * pose.axes;
  Symmetries found;
  found.group = group.name;
  found.centre = frame.from_frame(pose.centre);
  for (const Vector3& normal : group.plane_normals()) {
    const Vector3 unit = pose.axes * normal;
    found.planes.push_back(in_input_units(UnitPlane{unit, -unit.dot(pose.centre)}, frame));
  }
  for (const PointGroup::Axis& axis : group.axes())
    found.axes.push_back({found.centre, axes * axis.direction, axis.order});
  found.inversion = group.inversion();
  for (const Matrix3& element : group.elements) {
    if (element.isIdentity(0))  // else it would be one but for rounding
      found.elements.emplace_back(Matrix4::Identity());
    else
      found.elements.push_back(
          map_taking(axes * element * axes.transpose(), found.centre, found.centre).matrix());
  }
  found.score = std::clamp(vote.support, 0.0, 1.0);  // rounding; the support may be negative
  found.missing = vote.missing;
  return found;
}

Symmetries search_symmetries(const Cloud& cloud, double minimum_score,
                             const std::function<bool(const Symmetries&)>& accepts,
                             const Context& context) {
  return SymmetrySearch(cloud, minimum_score, accepts, context).run();
}

}  // namespace symsurf
