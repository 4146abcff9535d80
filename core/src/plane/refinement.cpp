#include "refinement.h"

#include <algorithm>
#include <cmath>

#include "agreement.h"
#include "plane_step.h"

namespace symsurf {

namespace {

constexpr Index small_cloud = 8192;  // whose every point is a sample
constexpr Index most_samples = 1000, few_samples = 250;
constexpr double by_chance = 0.1;  // few points look flatter than they are
constexpr double reach = 0.06;     // how far a partner may be
constexpr double score_tolerance = 0.01;
constexpr double close = 0.002;

double quantile(std::vector<double>& values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

Refinement::Refinement(const Cloud& cloud, const PointTree& tree,
                       std::vector<const Surfels*> scales)
    : cloud_(cloud), tree_(tree), scales_(std::move(scales)) {
  const Index n = cloud.points.size();
  const Surfels& surfels = *scales_.front();
  spacing_ =
      surfels.spacing() * std::sqrt(static_cast<double>(surfels.size()) / static_cast<double>(n));

  // Evenly spread ones first; of a small cloud the rest as well.
  std::vector<std::uint8_t> taken(n <= small_cloud ? n : 0, 0);
  const auto take = [&](Index i) {
    const Vector3 x = cloud.frame.enter(cloud.points[i]);
    if (const Surfel* surfel = surfel_at(x)) samples_.push_back({x, surfel});
    if (!taken.empty()) taken[i] = 1;
  };
  const Surfels& finest = *scales_.back();
  for (Index k = 0; k < finest.size(); ++k) take(finest[k].sample);
  even_samples_ = static_cast<Index>(samples_.size());
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i]) take(static_cast<Index>(i));
}

const Surfel* Refinement::surfel_at(const Vector3& x) const {
  const Surfel* flattest = nullptr;
  for (const Surfels* surfels : scales_) {
    const Index i = surfels->containing(x);
    if (i < 0) continue;
    const Surfel& surfel = (*surfels)[i];
    if (!flattest || surfel.flatness > flattest->flatness + by_chance) flattest = &surfel;
  }
  return flattest;
}

std::vector<Refinement::Match> Refinement::matches(const UnitPlane& plane, double limit,
                                                   Subset subset) const {
  const double size = cloud_.frame.size;
  std::vector<Match> found;
  found.reserve(subset.end / subset.stride + 1);
  for (Index i = 0; i < subset.end; i += subset.stride) {
    const Vector3 image = plane.reflect(samples_[i].position);
    const Neighbour nearest = tree_.nearest(cloud_.frame.leave(image), limit * limit * size * size);
    if (nearest.index < 0) continue;
    const Vector3 partner = cloud_.frame.enter(cloud_.points[nearest.index]);
    if (const Surfel* surfel = surfel_at(partner)) found.push_back({i, image - partner, surfel});
  }
  return found;
}

// Along a sheet, or inside a blob, a partner is as near as the spacing allows: only what exceeds it
// counts.
double Refinement::closeness(const Match& match, const Surfel& own, const UnitPlane* plane) const {
  const Surfel& partner = *match.partner;
  const double length = match.gap.norm();
  const double off_sheet = std::abs(match.gap.dot(partner.normal));
  const double along_sheet = std::sqrt(std::max(0.0, length * length - off_sheet * off_sheet));
  const double sheet = std::hypot(off_sheet, 0.3 * std::max(0.0, along_sheet - spacing_));
  const double blob = 0.6 * std::max(0.0, length - spacing_);
  const double flat = partner.flatness;
  const double residual = std::min(std::hypot(flat * sheet, (1 - flat) * blob), 3 * length);
  const Vector3 normal = plane ? plane->reflect_direction(own.normal) : own.normal;
  const Agreement agreement(match.gap, normal, own.flatness, partner);
  return agreement.facing / (1 + residual * residual / (close * close));
}

double Refinement::explained(const UnitPlane& plane, const std::vector<Match>& found, Subset subset,
                             Sharpness sharpness) const {
  double moved = 0, explained = 0;
  Index looked = 0;
  for (Index i = 0; i < subset.end; i += subset.stride, ++looked)
    moved += displaced(plane.distance(samples_[i].position), score_tolerance);
  for (const Match& match : found) {
    const Sample& s = samples_[match.sample];
    const double weight = displaced(plane.distance(s.position), score_tolerance);
    if (sharpness == Sharpness::Sharp) {
      explained += weight * closeness(match, *s.surfel, &plane);
    } else {
      const Agreement agreement(match.gap, plane.reflect_direction(s.surfel->normal),
                                s.surfel->flatness, *match.partner);
      explained += weight * agreement.weight(score_tolerance);
    }
  }
  return explained / std::max(moved, 0.35 * static_cast<double>(looked));
}

double Refinement::self_explained() const {
  const Subset most = about(most_samples);
  double sum = 0;
  Index looked = 0;
  std::vector<Neighbour> nearest;
  for (Index i = 0; i < most.end; i += most.stride, ++looked) {
    const Sample& s = samples_[i];
    tree_.nearest(cloud_.frame.leave(s.position), 2, nearest);
    const Vector3 other = cloud_.frame.enter(cloud_.points[nearest.back().index]);
    if (const Surfel* surfel = surfel_at(other))
      sum += closeness({static_cast<Index>(i), s.position - other, surfel}, *s.surfel, nullptr);
  }
  return sum / static_cast<double>(looked);
}

Refinement::Subset Refinement::about(Index wanted) const {
  return {even_samples_, std::max<Index>(1, even_samples_ / wanted)};
}

Refinement::Subset Refinement::all() const { return {static_cast<Index>(samples_.size()), 1}; }

PlaneCandidate Refinement::quick(const PlaneCandidate& start) const {
  const Subset few = about(few_samples);
  const UnitPlane plane = fitted(start.plane, 0.02, few, 2);
  return {plane, explained(plane, matches(plane, reach, few), few, Sharpness::Blunt)};
}

PlaneCandidate Refinement::careful(const PlaneCandidate& start) const {
  const Subset most = about(most_samples);
  const UnitPlane plane = fitted(start.plane, 0.01, most, 2);
  return {plane, explained(plane, matches(plane, reach, most), most, Sharpness::Sharp)};
}

PlaneCandidate Refinement::final(const PlaneCandidate& start) const {
  const Subset most = about(most_samples);
  const UnitPlane plane = fitted_to_exact_pairs(fitted(start.plane, 0.01, all(), 1));
  return {plane, explained(plane, matches(plane, reach, most), most, Sharpness::Sharp)};
}

UnitPlane Refinement::fitted(UnitPlane plane, double tolerance, Subset subset, int steps) const {
  for (int step = 0; step < steps; ++step) {
    PlaneStep sum(plane);
    std::vector<double> residuals;
    for (const Match& match : matches(plane, reach, subset)) {
      const Sample& s = samples_[match.sample];
      const double weight = displaced(plane.distance(s.position), tolerance);
      if (weight <= 0) continue;
      const Agreement agreement(match.gap, plane.reflect_direction(s.surfel->normal),
                                s.surfel->flatness, *match.partner);
      residuals.push_back(agreement.squared);
      sum.add(s.position, match.gap, agreement.metric, weight * agreement.weight(tolerance));
    }
    if (residuals.size() < 4) return plane;
    double moved;
    plane = sum.taken(&moved);
    tolerance = std::clamp(2.5 * std::sqrt(quantile(residuals, 0.5)), 0.003, tolerance);
    if (moved < 1e-4) return plane;
  }
  return plane;
}

// Where the same points, or some of them, stand on both sides, their gaps all but vanish at the
// true plane, while by chance a tenth of all images comes within a fifth of the spacing at best.
UnitPlane Refinement::fitted_to_exact_pairs(const UnitPlane& start) const {
  constexpr int steps = 12;
  constexpr double worth_trying = 0.1, exact = 0.01;  // of the spacing
  UnitPlane plane = start;
  double typical = 0;
  for (int step = 0; step < steps; ++step) {
    // A first look at few is mostly the last.
    const Subset looked = about(step == 0 ? few_samples : most_samples);
    std::vector<Match> found = matches(plane, spacing_, looked);
    std::erase_if(found, [&](const Match& match) {
      return displaced(plane.distance(samples_[match.sample].position), spacing_) < 1;
    });
    if (found.size() < 10) return start;
    std::vector<double> gaps;
    for (const Match& match : found) gaps.push_back(match.gap.norm());
    typical = quantile(gaps, 0.1);
    if (typical > worth_trying * spacing_) return start;
    PlaneStep sum(plane);
    for (const Match& match : found)
      if (match.gap.norm() <= 3 * typical)
        sum.add(samples_[match.sample].position, match.gap, Matrix3::Identity(), 1);
    double moved;
    plane = sum.taken(&moved);
    if (moved < 1e-15) break;
  }
  return typical < exact * spacing_ ? plane : start;
}

}  // namespace symsurf
