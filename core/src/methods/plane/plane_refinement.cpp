#include "methods/plane/plane_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math.h"
#include "methods/parametric/exact_pairs.h"
#include "methods/parametric/plane_step.h"
#include "score/correspondence.h"

namespace symsurf {

namespace {

// To fit to; ranking planes apart asks for more.
constexpr Index few_samples = 250, many_samples = 1000, ranking_samples = 1300;
constexpr double reach = 0.06;  // how far a partner may be
constexpr double score_tolerance = 0.015;
// Stricter than the score: where much is missing, how close the rest comes distinguishes a false
// plane from the true. As close as the noise lets it.
constexpr double closest = 0.0003, close = 0.001;
constexpr double near_miss = 0.016, penalty = 0.4;

// Along the Z-order curve of the principal frame, not of the input's: pose must not show.
std::uint32_t place_on_curve(const Vector3& x) {
  constexpr int bits = 8;
  constexpr double shift = 0.038197;  // off any lattice, as the surfels' grid
  const Eigen::Vector3i cell = ((x.array() + 1 + shift) * (1 << (bits - 1)) / 1.1).cast<int>();
  std::uint32_t position = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (int axis = 0; axis < 3; ++axis) position = position << 1 | (cell[axis] >> bit & 1);
  return position;
}

}  // namespace

Refinement::Refinement(const Cloud& cloud, const NearestPoints& points, const Surfels& coarse,
                       const Surfels& fine)
    : cloud_(cloud),
      points_(points),
      coarse_(coarse),
      fine_(fine),
      spacing_(coarse.spacing_of(cloud.partition.total())) {
  for (Index k = 0; k < fine.size(); ++k) {
    const Vector3& x = fine[k].sampled;
    if (const Surfel* surfel = surfel_at(x)) samples_.push_back({x, surfel, place_on_curve(x)});
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.position < b.position; });
  noise_ = measured_noise();
  kernel_ = {.inlier = std::clamp(noise_.deviation(), closest, close),
             .near_miss = near_miss,
             .penalty = penalty};
  for (Sample& s : samples_) s.smoothed = noise_.smoothed(s.point, *s.surfel);
}

SurfaceNoise Refinement::measured_noise() const {
  const Index stride = stride_for(few_samples);
  std::vector<OnSurface> asked;
  for (std::size_t i = 0; i < samples_.size(); i += stride)
    asked.push_back({samples_[i].point, samples_[i].surfel});
  return {asked, neighbours_of(asked, cloud_.frame, points_)};
}

Vector3 Refinement::smoothed_gap(const UnitPlane& plane, const Match& match) const {
  return plane.reflect(samples_[match.sample].smoothed) -
         noise_.smoothed(match.partner, *match.surfel);
}

std::vector<Refinement::Match> Refinement::matches(const UnitPlane& plane, double limit,
                                                   Index stride) const {
  std::vector<Vector3> images;
  images.reserve(samples_.size() / stride + 1);
  for (std::size_t i = 0; i < samples_.size(); i += stride)
    images.push_back(cloud_.frame.from_frame(plane.reflect(samples_[i].point)));
  const std::vector<Vector3> partners = points_.nearest(images, limit * cloud_.frame.size);
  std::vector<Match> found;
  found.reserve(images.size());
  for (Index k = 0; k < static_cast<Index>(partners.size()); ++k) {
    if (!partners[k].allFinite()) continue;
    const Vector3 x = cloud_.frame.to_frame(partners[k]);
    if (const Surfel* surfel = surfel_at(x)) found.push_back({k * stride, x, surfel});
  }
  return found;
}

double Refinement::support(const UnitPlane& plane, Index stride) const {
  double moved = 0, support = 0;
  Index looked = 0;
  for (std::size_t i = 0; i < samples_.size(); i += stride, ++looked)
    moved += displaced(plane.distance(samples_[i].smoothed), score_tolerance);
  for (const Match& match : matches(plane, reach, stride)) {
    const Sample& s = samples_[match.sample];
    const double weight = displaced(plane.distance(s.smoothed), score_tolerance);
    const Vector3 gap = smoothed_gap(plane, match);
    const Correspondence correspondence(gap, plane.reflect_direction(s.surfel->normal),
                                        s.surfel->flatness, *match.surfel);
    support += weight * kernel_(distance_past(gap, *match.surfel, spacing_),
                                correspondence.normal_consistency);
  }
  return support / std::max(moved, 0.35 * static_cast<double>(looked));
}

Index Refinement::stride_for(Index wanted) const {
  return std::max<Index>(1, (static_cast<Index>(samples_.size()) + wanted / 2) / wanted);
}

PlaneCandidate Refinement::quick(const UnitPlane& start) const {
  const Index few = stride_for(few_samples);
  return rated(fitted(start, 0.02, few, 2), few);
}

PlaneCandidate Refinement::careful(const UnitPlane& start) const {
  return rated(fitted(start, 0.01, stride_for(many_samples), 2), stride_for(ranking_samples));
}

// To all that roughly agrees, then to what agrees closely, which nothing beside a hole pulls away.
UnitPlane Refinement::refined(const UnitPlane& start) const {
  constexpr double wide = 0.01;
  const double narrow = std::clamp(noise_.deviation(), 0.003, wide);  // noise agrees no closer
  constexpr int steps = 12;
  const Index many = stride_for(many_samples);
  const UnitPlane close = fitted(fitted(start, wide, many, steps), narrow, many, steps);
  return exact(fitted(close, narrow, 1, 2));
}

PlaneCandidate Refinement::rated(const UnitPlane& plane, Index stride) const {
  return {plane, support(plane, stride)};
}

// Reweighted least squares. The tolerance follows the residuals of what it lets in, down to what
// the cloud's noise leaves: images that only just miss the cloud, at the edge of a hole or where
// nothing mirrors them, stop pulling. Looking for partners is most of the work: they stay until the
// plane has moved by a part of the spacing, or has converged between them.
UnitPlane Refinement::fitted(UnitPlane plane, double tolerance, Index stride, int steps) const {
  constexpr double least_tolerance = 0.002, widening = 2, still = 1e-4;
  constexpr double along_surface = 0.01;  // partners hold the plane hardly where they may slide
  const double stale = 0.1 * spacing_, converged = 0.02 * spacing_;
  std::vector<Match> found;
  double moved = std::numeric_limits<double>::infinity();
  for (int step = 0; step < steps; ++step) {
    if (moved > stale) {
      found = matches(plane, std::min(reach, 4 * tolerance + spacing_), stride);
      moved = 0;
    }
    PlaneStep sum(plane);
    double squares = 0, weights = 0;
    for (const Match& match : found) {
      const Sample& s = samples_[match.sample];
      const double weight = displaced(plane.distance(s.smoothed), tolerance);
      if (weight <= 0) continue;
      const Facet p{match.surfel->normal, match.surfel->flatness_without(noise_.deviation())};
      const Vector3 gap = smoothed_gap(plane, match);
      const Correspondence correspondence(gap, plane.reflect_direction(s.surfel->normal),
                                          s.surfel->flatness, p);
      const double r = distance_past(gap, p, spacing_) / tolerance;
      const double trusted = weight * correspondence.normal_consistency *
                             inside_surface(gap, p, spacing_) * fading(r * r / 2);
      squares += trusted * r * r;
      weights += trusted;
      sum.add(s.smoothed, gap, correspondence.metric(along_surface), trusted);
    }
    if (weights < 4) return plane;
    double change;
    plane = sum.taken(&change);
    moved += change;
    tolerance =
        std::clamp(widening * tolerance * std::sqrt(squares / weights), least_tolerance, tolerance);
    if (change < still) {
      if (moved < converged) return plane;
      moved = std::numeric_limits<double>::infinity();
    }
  }
  return plane;
}

UnitPlane Refinement::exact(const UnitPlane& start) const {
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < samples_.size(); i += stride_for(many_samples))
    positions.push_back(samples_[i].point);
  return fitted_to_exact_pairs(start, positions, points_, cloud_.frame, spacing_).value_or(start);
}

}  // namespace symsurf
