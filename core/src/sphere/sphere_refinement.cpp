#include "sphere_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "../plane/agreement.h"
#include "../sheet_spacing.h"

namespace symsurf {

namespace {

constexpr Index most_samples = 8192;
constexpr double reach = 0.06;  // how far a partner may be
constexpr double widest = 0.012, narrowest = 0.003;
constexpr double least_moved = 0.35;
constexpr std::array score_tolerances{0.01, 0.005, 0.0025, 0.00125};

double quantile(std::vector<double>& values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

SphereRefinement::SphereRefinement(const Cloud& cloud, const PointTree& tree,
                                   const Surfels& surfels)
    : cloud_(cloud),
      tree_(tree),
      surfels_(surfels),
      spacing_(sheet_spacing(cloud.points, tree) / cloud.frame.size) {
  const Index n = cloud.points.size(), count = std::min(n, most_samples);
  for (Index k = 0; k < count; ++k) {
    const Vector3 x = cloud.frame.enter(cloud.points[tree.order()[k * n / count]]);
    const Index surfel = surfels.containing(x);
    if (surfel >= 0) samples_.push_back({x, &surfels[surfel]});
  }
}

Index SphereRefinement::stride_for(Index wanted) const {
  return std::max<Index>(1, static_cast<Index>(samples_.size()) / wanted);
}

std::vector<SphereRefinement::Match> SphereRefinement::matches(const UnitSphere& sphere,
                                                               double limit, Index stride) const {
  const double size = cloud_.frame.size;
  std::vector<Match> found;
  for (std::size_t i = 0; i < samples_.size(); i += stride) {
    const Vector3 image = sphere.reflect(samples_[i].position);
    if (!image.allFinite()) continue;
    const Neighbour nearest = tree_.nearest(cloud_.frame.leave(image), limit * limit * size * size);
    if (nearest.index < 0) continue;
    const Vector3 partner = cloud_.frame.enter(cloud_.points[nearest.index]);
    const Index surfel = surfels_.containing(partner);
    if (surfel >= 0) found.push_back({&samples_[i], image - partner, &surfels_[surfel]});
  }
  return found;
}

SphereCandidate SphereRefinement::fitted(const SphereCandidate& start, Index wanted,
                                         int steps) const {
  const Index stride = stride_for(wanted);
  SphereCandidate candidate = start;
  double tolerance = widest;
  for (int step = 0; step < steps; ++step) {
    SphereStep sum(candidate.sphere);
    std::vector<double> residuals;
    for (const Match& match : matches(candidate.sphere, reach, stride)) {
      const Sample& s = *match.sample;
      const double weight = displaced(candidate.sphere.distance(s.position), widest);
      if (weight <= 0) continue;
      const Agreement agreement(match.gap,
                                candidate.sphere.reflect_direction(s.position, s.surfel->normal),
                                s.surfel->flatness, *match.partner);
      residuals.push_back(agreement.squared);
      sum.add(s.position, match.gap, agreement.metric(), weight * agreement.weight(tolerance));
    }
    if (residuals.size() < 5) break;
    double moved;
    candidate.sphere = sum.taken(&moved);
    tolerance = std::clamp(2.5 * std::sqrt(quantile(residuals, 0.5)), narrowest, widest);
    if (moved < 1e-5) break;
  }
  candidate.explained = explained(candidate.sphere, wanted);
  return candidate;
}

// By chance a tenth of all images comes within a fifth of the spacing at best.
SphereCandidate SphereRefinement::fitted_to_exact_pairs(const SphereCandidate& start) const {
  constexpr int steps = 16;
  constexpr double worth_trying = 0.12, exact = 0.01;  // of the spacing
  const Index stride = stride_for(1200);
  SphereCandidate candidate = start;
  double typical = 0;
  for (int step = 0; step < steps; ++step) {
    std::vector<Match> found = matches(candidate.sphere, spacing_, stride);
    std::erase_if(found, [&](const Match& match) {
      return displaced(candidate.sphere.distance(match.sample->position), spacing_) < 1;
    });
    if (found.size() < 10) return start;
    std::vector<double> gaps;
    for (const Match& match : found) gaps.push_back(match.gap.norm());
    typical = quantile(gaps, 0.1);
    if (typical > worth_trying * spacing_) return start;
    SphereStep sum(candidate.sphere);
    for (const Match& match : found)
      if (match.gap.norm() <= 3 * typical)
        sum.add(match.sample->position, match.gap, Matrix3::Identity(), 1);
    double moved;
    candidate.sphere = sum.taken(&moved);
    if (moved < 1e-14) break;
  }
  if (typical >= exact * spacing_) return start;
  candidate.explained = explained(candidate.sphere, 1200);
  return candidate;
}

namespace {

// The mean over tolerances from coarse to fine: images that meet a point exactly count in full,
// chance agreement less the finer one looks.
double closeness(const Agreement& agreement) {
  double sum = 0;
  for (const double tolerance : score_tolerances) sum += agreement.weight(tolerance);
  return sum / static_cast<double>(score_tolerances.size());
}

}  // namespace

double SphereRefinement::explained(const UnitSphere& sphere, Index wanted) const {
  const Index stride = stride_for(wanted);
  const double tolerance = std::max(score_tolerances.front(), spacing_ / 2);
  double moved = 0, agreeing = 0;
  Index looked = 0;
  for (std::size_t i = 0; i < samples_.size(); i += stride, ++looked)
    moved += displaced(sphere.distance(samples_[i].position), tolerance);
  for (const Match& match : matches(sphere, reach, stride)) {
    const Sample& s = *match.sample;
    const Agreement agreement(match.gap, sphere.reflect_direction(s.position, s.surfel->normal),
                              s.surfel->flatness, *match.partner);
    agreeing += displaced(sphere.distance(s.position), tolerance) * closeness(agreement);
  }
  return agreeing / std::max(moved, least_moved * static_cast<double>(looked));
}

double SphereRefinement::self_explained() const {
  const Index stride = stride_for(1000);
  double sum = 0;
  Index looked = 0;
  std::vector<Neighbour> nearest;
  for (std::size_t i = 0; i < samples_.size(); i += stride, ++looked) {
    const Sample& s = samples_[i];
    tree_.nearest(cloud_.frame.leave(s.position), 2, nearest);
    const Vector3 other = cloud_.frame.enter(cloud_.points[nearest.back().index]);
    const Index surfel = surfels_.containing(other);
    if (surfel < 0) continue;
    sum += closeness(
        Agreement(s.position - other, s.surfel->normal, s.surfel->flatness, surfels_[surfel]));
  }
  return sum / static_cast<double>(looked);
}

}  // namespace symsurf
