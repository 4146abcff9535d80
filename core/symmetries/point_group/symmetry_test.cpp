#include "point_group/symmetry_test.h"

#include <algorithm>
#include <numbers>

#include "point_group/point_group.h"

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
      tree_(cloud.points, context.stage(0, 0.2)),
      points_(cloud.points, tree_, context.stage(0.2, 0.2)),
      coarse_(cloud, surfels, context.stage(0.2, 0.4)),
      fine_(cloud, coarse_, context.stage(0.4, 0.6)),
      score_(cloud, points_, context.stage(0.6, 1)),
      fit_(cloud, tree_, points_, coarse_, fine_) {}

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

}  // namespace symsurf
