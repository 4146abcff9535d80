#include "symmetries/point_group/element_search.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/math.h"
#include "methods/plane/plane_candidates.h"
#include "symmetries/point_group/point_group.h"

namespace symsurf {

namespace {

constexpr std::size_t most_planes = 12;      // fitted to the full cloud
constexpr std::size_t most_directions = 40;  // of axes that are tried
constexpr double same_guess = 0.035;         // radians
constexpr std::array<Index, 11> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31};
constexpr Index greatest_power = 64;
constexpr Index greatest_order = 128;  // a body of which more orders hold is one of revolution
// Shares of points: where part of a body of revolution is missing, as many any turn leaves out.
constexpr double most_outliers = 0.08, hardly_any = 0.02;
// Turns that fit so much worse than others about their axis are none of the shape's: of a gear any
// turn maps the body, and some the teeth, too.
constexpr double below_power = 0.025, below_best = 0.04, above_any = 0.03, good_fit = 0.95;

const Matrix3 mirror_across = reflection(Vector3::UnitZ());

std::vector<Vector3> axis_guesses(const std::vector<FoundDirection>& planes) {
  std::vector<Vector3> guesses;
  for (int axis = 0; axis < 3; ++axis) guesses.push_back(Vector3::Unit(axis));
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 line = planes[i].z().cross(planes[j].z());
      if (line.norm() > same_direction) guesses.push_back(line.normalized());
    }
  for (const FoundDirection& plane : planes) guesses.push_back(plane.z());
  suppress_non_maxima(guesses, most_directions, [](const Vector3& a, const Vector3& b) {
    return are_parallel(a, b, same_guess);
  });
  return guesses;
}

std::optional<FoundDirection> turned_about(const SymmetryTest& test, const GroupPose& start,
                                           Index order) {
  constexpr std::size_t fitted = 3;
  const std::vector<Matrix3> some = turns_of(order, fitted);
  const auto passed = test.tried(start, some, turns_of(order));
  if (!passed || (order > 2 && passed->vote.outliers > most_outliers)) return {};
  return FoundDirection{passed->pose, passed->vote, order};
}

// Of the greatest order: its prime powers are tried first, then their product.
std::optional<FoundDirection> finite_axis(const SymmetryTest& test, const GroupPose& start) {
  std::vector<FoundDirection> found;  // a power of each prime
  for (const Index prime : primes) {
    std::optional<FoundDirection> last;
    for (Index power = prime; power <= greatest_power; power *= prime) {
      const std::optional<FoundDirection> axis =
          turned_about(test, last ? last->pose : start, power);
      if (!axis || (last && axis->vote.fit < last->vote.fit - below_power)) break;
      last = axis;
    }
    if (last) found.push_back(*last);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.vote.fit > b.vote.fit; });
  std::optional<FoundDirection> whole;
  for (const FoundDirection& axis : found) {
    if (!whole) {
      whole = axis;
      continue;
    }
    if (axis.vote.fit < found.front().vote.fit - below_best) break;
    if (whole->order * axis.order > greatest_order) return {};
    const auto both = turned_about(test, whole->pose, whole->order * axis.order);
    if (both && both->vote.fit >= found.front().vote.fit - below_best) whole = both;
  }
  return whole;
}

std::optional<FoundDirection> axis_along(const SymmetryTest& test, const GroupPose& start) {
  constexpr int fitted = 4, voting = 12;
  std::optional<FoundDirection> any;
  const auto passed =
      test.tried(start, any_turns(Vector3::UnitZ(), fitted), any_turns(Vector3::UnitZ(), voting));
  if (passed && passed->vote.outliers <= most_outliers) {
    any = FoundDirection{passed->pose, passed->vote, 0};
    if (any->vote.outliers <= hardly_any && any->vote.fit >= good_fit) return any;
  }
  const std::optional<FoundDirection> finite = finite_axis(test, start);
  if (any && (!finite || finite->vote.fit < any->vote.fit + above_any)) return any;
  return finite;
}

Index rank(Index order) { return order == 0 ? 1 << 20 : order; }

}  // namespace

std::vector<FoundDirection> find_planes(const SymmetryTest& test) {
  const SymmetryFit& fit = test.fit();
  const SurfelMap map(test.coarse());
  std::vector<GroupPose> starts;
  for (int axis = 0; axis < 3; ++axis)
    starts.push_back(GroupPose::along(Vector3::Unit(axis), Vector3::Zero()));
  for (const PlaneCandidate& candidate : candidate_planes(test.coarse(), map, usual_search, 40))
    starts.push_back(
        GroupPose::along(candidate.shape.normal, -candidate.shape.offset * candidate.shape.normal));
  std::vector<std::pair<double, GroupPose>> rough;
  for (const GroupPose& start : starts) {
    const GroupPose pose = fit.roughly(start, {mirror_across});
    const double support = fit.support(pose, mirror_across, rough_tolerance);
    if (support >= rough_support) rough.emplace_back(support, pose);
  }
  std::stable_sort(rough.begin(), rough.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  suppress_non_maxima(rough, most_planes, [](const auto& a, const auto& b) {
    return are_parallel(a.second.axes.col(2), b.second.axes.col(2), same_guess);
  });
  std::vector<FoundDirection> planes;
  for (const auto& [support, start] : rough)
    if (const auto passed = test.tried(start, {mirror_across}))
      planes.push_back({passed->pose, passed->vote});
  std::stable_sort(planes.begin(), planes.end(),
                   [](const auto& a, const auto& b) { return a.vote.share() > b.vote.share(); });
  suppress_non_maxima(planes, planes.size(), [](const auto& a, const auto& b) {
    return are_parallel(a.z(), b.z(), same_direction);
  });
  return planes;
}

Vector3 centre_of(const std::vector<FoundDirection>& planes) {
  constexpr double free = 1e-6;
  Matrix3 products = free * Matrix3::Identity();
  Vector3 sum = Vector3::Zero();
  for (const FoundDirection& plane : planes) {
    products += plane.z() * plane.z().transpose();
    sum += plane.z().dot(plane.pose.centre) * plane.z();
  }
  return products.ldlt().solve(sum);
}

std::vector<FoundDirection> find_axes(const SymmetryTest& test,
                                      const std::vector<FoundDirection>& planes,
                                      const Vector3& centre) {
  std::vector<FoundDirection> axes;
  for (const Vector3& guess : axis_guesses(planes)) {
    const bool is_known = std::any_of(axes.begin(), axes.end(), [&](const FoundDirection& axis) {
      return are_parallel(axis.z(), guess, same_direction);
    });
    if (is_known) continue;
    const std::optional<FoundDirection> axis = axis_along(test, GroupPose::along(guess, centre));
    if (!axis) continue;
    axes.push_back(*axis);
    if (axis->order == 0) break;
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const auto& a, const auto& b) { return rank(a.order) > rank(b.order); });
  return axes;
}

}  // namespace symsurf
