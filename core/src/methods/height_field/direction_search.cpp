#include "methods/height_field/direction_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace symsurf {

namespace {

constexpr Index tried = 180;  // directions on the half sphere, 12 degrees apart
constexpr Index screened_size = 1000;
constexpr double apart = 0.12;  // radians between candidates
constexpr double first_step = 0.09, last_step = 0.04;
constexpr double pi = std::numbers::pi;

bool better(const DirectionCandidate& a, const DirectionCandidate& b) {
  return a.support > b.support;
}

std::vector<DirectionCandidate> distinct(std::vector<DirectionCandidate> candidates, Index count) {
  std::stable_sort(candidates.begin(), candidates.end(), better);
  std::vector<DirectionCandidate> kept;
  for (const DirectionCandidate& c : candidates) {
    const bool seen = std::any_of(kept.begin(), kept.end(), [&](const DirectionCandidate& other) {
      return c.direction.cross(other.direction).norm() < apart;
    });
    if (!seen) kept.push_back(c);
    if (static_cast<Index>(kept.size()) == count) break;
  }
  return kept;
}

void maximise_measure(MidSurface& surface, DirectionCandidate& candidate, const Context& context) {
  for (double step = first_step; step >= last_step; step /= 2) {
    const auto across = orthogonal_to(candidate.direction);
    const Vector3 centre = candidate.direction;
    for (int k = 0; k < 6; ++k) {
      context.check();
      const double angle = k * pi / 3;
      const Vector3 moved =
          centre + step * across * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const DirectionCandidate next{moved.normalized(), surface.support(moved.normalized())};
      if (better(next, candidate)) candidate = next;
    }
  }
}

// The i-th of `count` directions spread evenly over the half sphere: a Fibonacci spiral.
Vector3 spread_direction(Index i, Index count) {
  const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  const double angle = static_cast<double>(i) * pi * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

std::vector<DirectionCandidate> supported_directions(const SurfacePoints& cloud,
                                                     const std::vector<ChordPeak>& hints,
                                                     Index count, const Context& context) {
  const SurfacePoints coarse(cloud.points, screened_size, context.stage(0, 0));
  std::vector<DirectionCandidate> candidates;
  for (Index i = 0; i < tried; ++i) candidates.push_back({spread_direction(i, tried)});
  for (const ChordPeak& hint : hints) candidates.push_back({hint.direction});
  for (DirectionCandidate& c : candidates) {
    context.check();
    c.support = MidSurface::support_bound(coarse, c.direction);
  }
  std::stable_sort(candidates.begin(), candidates.end(), better);

  MidSurface screen(coarse, context);
  std::vector<double> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    context.report(0.8 * static_cast<double>(i) / static_cast<double>(candidates.size()));
    std::sort(best.begin(), best.end(), std::greater<>());
    if (static_cast<Index>(best.size()) > count && candidates[i].support < best[count]) {
      candidates.resize(i);
      break;
    }
    candidates[i].support = screen.support(candidates[i].direction);
    best.push_back(candidates[i].support);
  }
  candidates = distinct(std::move(candidates), count);
  MidSurface surface(cloud, context);
  for (DirectionCandidate& candidate : candidates) {
    candidate.support = surface.support(candidate.direction);
    maximise_measure(surface, candidate, context);
  }
  return distinct(std::move(candidates), count);
}

}  // namespace symsurf
