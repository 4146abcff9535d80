#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "point_group/point_group.h"
#include "point_group/symmetry_search.h"
#include "search/plane.h"

namespace symsurf {

namespace {

constexpr Index surfels = 1000;
constexpr std::size_t samples = 1500, samples_of_group = 6000;  // a step of the fit
constexpr std::size_t few_images = 6000, many_images = 24'000;  // that vote
// Shares of the images and of the points.
constexpr double most_missing = 0.35;
constexpr double most_outliers_of_elements = 0.3;  // of elements; others may show more
constexpr double most_outliers_of_group = 0.08, most_outliers_of_continuous = 0.042;
// Of points next to each other, outliers of the group: hardly any of true groups, two of three and
// more of others (tests/accuracy/symmetric_parts.py, 10,000 points, whole and with noise).
constexpr double most_of_window = 0.6;

// A few elements that define the pose, of a group that may have a hundred.
std::vector<Matrix3> spread(const std::vector<Matrix3>& elements) {
  constexpr std::size_t most = 12;
  std::vector<Matrix3> chosen;
  const std::size_t step = (elements.size() + most - 1) / most;
  for (std::size_t k = 1; k < elements.size(); k += step) chosen.push_back(elements[k]);
  return chosen;
}

// With part of a shape missing, most images of a point that is no part's alone still lie on the
// cloud; those of a feature that spoils the symmetry, such as a handle, do not. No single element
// distinguishes the two, as either has an image where the cloud has nothing.
// Looks at about so many images; a few hundred points at most are asked for theirs.
OrbitVote orbit_vote(const MirrorScore& score, const GroupPose& pose,
                     const std::vector<Matrix3>& elements, std::size_t most_images) {
  constexpr std::size_t points = 500;  // that the score is measured at
  constexpr double confirmed = 0.58;   // of the orbit: more than half, less than two of three
  constexpr double on_surface = 0.3;   // support from which on an image lies on the surface
  constexpr double rims = 4;           // what lies at the rim of a hole is judged less by this
  const std::size_t stride = std::max<std::size_t>(1, elements.size() * points / most_images);
  struct Orbit {
    double moved = 0, rim = 0, size = 0;  // weights
    double confirming = 0, missing = 0, images = 0;
  };
  std::vector<Orbit> orbits;
  double images = 0, confirming = 0, supports = 0, missing = 0;
  for (const Matrix3& element : elements) {
    if (element.isIdentity()) continue;
    for (const PointFit& fit : score.point_fits(pose.placed(element), stride)) {
      if (fit.point >= orbits.size()) orbits.resize(fit.point + 1);
      Orbit& orbit = orbits[fit.point];
      const double weight = fit.weight - fit.rim;
      const double there = weight - fit.missing;
      const double yes = fit.support > on_surface * there ? there : 0;
      orbit.moved += fit.weight;
      orbit.rim += fit.rim;
      ++orbit.size;
      orbit.images += weight;
      orbit.confirming += yes;
      images += weight;
      confirming += yes;
      supports += fit.support;
      missing += fit.missing;
    }
  }
  if (!(images > 0)) return {};
  const double there = std::max(images - missing, 1e-9);
  OrbitVote vote{confirming / there, supports / there, missing / images};
  double all = 0, outliers = 0;
  for (const Orbit& orbit : orbits) {
    if (!(orbit.moved > 0)) continue;
    const double weight =
        orbit.moved / orbit.size * std::clamp(1 - rims * orbit.rim / orbit.moved, 0.0, 1.0);
    const double own = orbit.images / orbit.size;
    all += weight;
    if (own + orbit.confirming < confirmed * (own + orbit.images)) outliers += weight;
  }
  if (all > 0) vote.outliers = outliers / all;
  return vote;
}

}  // namespace

SymmetryTest::SymmetryTest(const Cloud& cloud, double minimum_score, const Context& context)
    : minimum_score_(minimum_score),
      points_(cloud, context.stage(0, 0.2)),
      coarse_(cloud.patches(surfels, context.stage(0.2, 0.4))),
      fine_(cloud.finer_patches(surfels, context.stage(0.4, 0.6))),
      score_(cloud, context.stage(0.6, 1)),
      fit_(cloud, points_, coarse_, fine_) {}

bool SymmetryTest::may_be(const OrbitVote& vote) const {
  return vote.support >= minimum_score_ && vote.missing <= most_missing &&
         vote.outliers <= most_outliers_of_elements;
}

std::optional<SymmetryTest::Passed> SymmetryTest::tried(const GroupPose& start,
                                                        const std::vector<Matrix3>& fitted,
                                                        const std::vector<Matrix3>& voting) const {
  for (const Matrix3& element : fitted)
    if (fit_.support(start, element, glance_tolerance) < glance_support) return {};
  GroupPose pose = fit_.roughly(start, fitted);
  for (const Matrix3& element : fitted)
    if (fit_.support(pose, element, rough_tolerance) < rough_support) return {};
  return voted(fit_.closely(pose, fitted, samples), voting);
}

std::optional<SymmetryTest::Passed> SymmetryTest::voted(const GroupPose& pose,
                                                        const std::vector<Matrix3>& voting) const {
  const OrbitVote vote = orbit_vote(score_, pose, voting, few_images);
  if (!may_be(vote)) return {};
  return Passed{pose, vote};
}

std::optional<SymmetryTest::Passed> SymmetryTest::passed(const GroupPose& start,
                                                         const std::vector<Matrix3>& group,
                                                         bool continuous) const {
  const GroupPose pose = fit_.closely(start, spread(group), samples_of_group);
  const OrbitVote vote = orbit_vote(score_, pose, group, many_images);
  if (!may_be(vote)) return {};
  const double most_outliers = continuous ? most_outliers_of_continuous : most_outliers_of_group;
  const bool decided =
      group.size() > 2 ? vote.outliers <= most_outliers : vote.share() >= minimum_score_;
  if (!decided) return {};
  // Of two elements a part that is missing looks like one that there should not be.
  if (group.size() > 2 && fit_.worst_window(pose, group) > most_of_window) return {};
  return Passed{pose, vote};
}

std::vector<Matrix3> turns_of(Index order, std::size_t most) {
  std::vector<Matrix3> turns;
  const auto n = static_cast<double>(order);
  for (Index k = 1; k < order && turns.size() < most; ++k)
    turns.push_back(turn(Vector3::UnitZ(), 2 * std::numbers::pi * static_cast<double>(k) / n));
  return turns;
}

std::vector<Matrix3> any_turns(const Vector3& axis, int count) {
  std::vector<Matrix3> turns;
  for (int k = 1; k <= count; ++k)
    turns.push_back(turn(axis, 2 * std::numbers::pi * std::numbers::phi * k));
  return turns;
}

std::vector<Matrix3> tested_elements(const PointGroup& group) {
  constexpr int turns = 8;
  std::vector<Matrix3> elements = group.elements;
  // About every axis, as of K two make all turns.
  for (const PointGroup::Axis& axis : group.axes())
    if (axis.order == 0)
      for (const Matrix3& turned : any_turns(axis.direction, turns))
        for (const Matrix3& element : group.elements) elements.push_back(turned * element);
  return elements;
}

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
  for (const PlaneCandidate& candidate : candidate_planes(test.coarse(), map, 40))
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
