#include "point_group/element_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/eigenvectors.h"
#include "base/least_squares.h"
#include "base/math.h"
#include "point_group/point_group.h"
#include "search/plane_candidates.h"

namespace symsurf {

namespace {

constexpr std::size_t most_planes = 12;      // fitted to the full cloud
constexpr std::size_t most_directions = 40;  // of axes that are tried
constexpr double same_guess = 0.035;         // radians
constexpr double below_true = 0.1;           // fit: of what is none beside a true one
constexpr double certain = 0.95;             // fit
constexpr std::array<Index, 11> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31};
constexpr Index greatest_power = 64;
constexpr Index greatest_order = 128;  // a body of which more orders hold is one of revolution
// Shares of points: where part of a body of revolution is missing, as many any turn leaves out.
constexpr double most_outliers = 0.08, hardly_any = 0.02;
// Turns that fit so much worse than others about their axis are none of the shape's: of a gear any
// turn maps the body, and some the teeth, too.
constexpr double below_power = 0.025, below_best = 0.04, above_any = 0.03, good_fit = 0.98;

const Matrix3 mirror_across = reflection(Vector3::UnitZ());

// The principal axes, where planes meet or what is across two axes, and the directions themselves.
// Between three at right angles, as the axes of order 2 of a tetrahedron, are those of order 3.
std::vector<Vector3> axis_guesses(const std::vector<FoundDirection>& directions) {
  std::vector<Vector3> guesses;
  for (int axis = 0; axis < 3; ++axis) guesses.push_back(Vector3::Unit(axis));
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 a = directions[i].z(), b = directions[j].z(), line = a.cross(b);
      if (line.norm() > same_direction) guesses.push_back(line.normalized());
    }
  for (const FoundDirection& each : directions) guesses.push_back(each.z());
  for (std::size_t i = 0; i < directions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 a = directions[i].z(), b = directions[j].z();
      if (std::abs(a.dot(b)) < same_direction)
        for (const double along_a : {1.0, -1.0})
          for (const double along_b : {1.0, -1.0})
            guesses.push_back((along_a * a + along_b * b + a.cross(b)).normalized());
    }
  return guesses;
}

// As shapes with axes of order 3 or more in several directions are: to the principal axes no
// direction is better than another.
bool is_isotropic(const Surfels& surfels) {
  constexpr double least_ratio = 0.8;  // of variances
  const Points positions = surfels.positions(surfels.size());
  const SymmetricEigen<3> scatter =
      eigen_of_scatter(Points(positions.rowwise() - positions.colwise().mean()));
  return scatter.values[0] > least_ratio * scatter.values[2];
}

// Axes about which half turns take surfels to others with such a normal and as far from the centre.
// Each surfel has one vote, divided among its partners: a ball, any half turn of which maps it,
// decides nothing.
std::vector<Vector3> half_turn_guesses(const SymmetryTest& test, const Vector3& centre) {
  constexpr double same_radius = 0.01, least_radius = 0.1;  // diagonals
  constexpr double same_normal = 0.9;                       // cosine
  constexpr double bins = 8;                                // a unit of a cube's face: 7 degrees
  constexpr std::size_t most_bins = 60, most_guesses = 8;
  std::map<std::array<int, 3>, Vector3> votes;
  const Surfels& surfels = test.coarse();
  for (Index i = 0; i < surfels.size(); ++i) {
    const Vector3 a = surfels[i].position - centre;
    std::vector<Vector3> axes;
    for (Index j = 0; j < surfels.size(); ++j) {
      const Vector3 b = surfels[j].position - centre, sum = a + b;
      if (i == j || std::abs(a.norm() - b.norm()) > same_radius || sum.norm() < least_radius)
        continue;
      const Vector3 axis = sum.normalized();
      const Vector3 turned = 2 * axis.dot(surfels[i].normal) * axis - surfels[i].normal;
      if (std::abs(turned.dot(surfels[j].normal)) > same_normal) axes.push_back(axis);
    }
    for (const Vector3& axis : axes) {
      int major;
      axis.cwiseAbs().maxCoeff(&major);
      const Vector3 cell = (bins / axis[major] * axis).array().round();
      const std::array<int, 3> bin{static_cast<int>(cell.x()), static_cast<int>(cell.y()),
                                   static_cast<int>(cell.z())};
      Vector3& sum = votes.try_emplace(bin, Vector3::Zero()).first->second;
      sum += (axis[major] < 0 ? -1 : 1) / static_cast<double>(axes.size()) * axis;
    }
  }
  std::vector<std::pair<double, Vector3>> best;
  for (const auto& [cell, sum] : votes) best.emplace_back(sum.norm(), sum.normalized());
  const auto sort_best = [&] {
    std::stable_sort(best.begin(), best.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
  };
  sort_best();
  best.resize(std::min(best.size(), most_bins));
  const Matrix3 half = turn(Vector3::UnitZ(), std::numbers::pi);
  for (auto& [support, axis] : best) {
    const GroupPose pose = test.fit().roughly(GroupPose::along(axis, centre), {half});
    support = test.fit().support(pose, half, rough_tolerance);
    axis = pose.axes.col(2);
  }
  sort_best();
  std::vector<Vector3> guesses;
  for (const auto& [support, axis] : best)
    if (support >= rough_support) guesses.push_back(axis);
  suppress_non_maxima(guesses, most_guesses, [](const Vector3& a, const Vector3& b) {
    return are_parallel(a, b, same_direction);
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

// Those whose least turn maps the surfels better than any turn does, by a quarter as much at least
// as that of the best.
std::vector<Index> likely_primes(const SymmetryTest& test, const GroupPose& start) {
  constexpr double least_share = 0.25;
  constexpr int turns = 8;
  const auto support = [&](const Matrix3& element) {
    return test.fit().support(start, element, glance_tolerance);
  };
  double any = 0, best = 0;
  for (const Matrix3& turned : any_turns(Vector3::UnitZ(), turns)) any += support(turned) / turns;
  std::vector<std::pair<Index, double>> supports;
  for (const Index prime : primes) {
    supports.emplace_back(prime, support(turns_of(prime, 1).front()));
    best = std::max(best, supports.back().second);
  }
  std::vector<Index> likely;
  for (const auto& [prime, own] : supports)
    if (own >= any + least_share * (best - any)) likely.push_back(prime);
  return likely;
}

// Of the greatest order: its prime powers are tried first, then their product.
std::optional<FoundDirection> finite_axis(const SymmetryTest& test, const GroupPose& start) {
  std::vector<FoundDirection> found;  // a power of each prime
  for (const Index prime : likely_primes(test, start)) {
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

void drop_far_below_best(std::vector<FoundDirection>& found) {
  double best = 0;
  for (const FoundDirection& each : found) best = std::max(best, each.vote.fit);
  std::erase_if(found,
                [&](const FoundDirection& each) { return each.vote.fit < best - below_true; });
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
  drop_far_below_best(planes);
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
  return solved(products, sum);
}

std::vector<FoundDirection> find_axes(const SymmetryTest& test,
                                      const std::vector<FoundDirection>& planes,
                                      const Vector3& centre) {
  std::vector<FoundDirection> axes;
  std::vector<Vector3> tried;
  const auto is_enough = [&] {
    Index high = 0;
    for (const FoundDirection& axis : axes)
      if (axis.vote.fit >= certain && axis.order != 2) high += axis.order == 0 ? 2 : 1;
    return high > 1;
  };
  const auto is_known = [&](const Vector3& direction) {
    return std::any_of(axes.begin(), axes.end(), [&](const FoundDirection& axis) {
      return are_parallel(axis.z(), direction, same_direction);
    });
  };
  const auto try_all = [&](const std::vector<Vector3>& guesses) {
    for (const Vector3& guess : guesses) {
      if (is_enough() || tried.size() == most_directions) return;
      const bool is_old = std::any_of(tried.begin(), tried.end(), [&](const Vector3& other) {
        return are_parallel(other, guess, same_guess);
      });
      if (is_old || is_known(guess)) continue;
      tried.push_back(guess);
      const std::optional<FoundDirection> axis = axis_along(test, GroupPose::along(guess, centre));
      if (axis && !is_known(axis->z())) axes.push_back(*axis);
    }
  };
  if (is_isotropic(test.coarse())) {
    try_all(half_turn_guesses(test, centre));
    try_all(axis_guesses(axes));
  }
  try_all(axis_guesses(planes));
  drop_far_below_best(axes);
  std::stable_sort(axes.begin(), axes.end(),
                   [](const auto& a, const auto& b) { return rank(a.order) > rank(b.order); });
  return axes;
}

}  // namespace symsurf
