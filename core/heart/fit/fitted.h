#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/surfels.h"
#include "pairing/correspondence.h"

namespace symsurf {

/// One Gauss-Newton step of a map by its numbers: sums weighted squared gaps between images and
/// partners, in their metrics. `Map::slopes(x)`: by how much each number moves the image of x;
/// `Map::stepped(change)`: the map after a change that is cut to what is small, and its length;
/// `Map::ridge`: of the trace, what holds numbers that nothing else does.
template <typename Map>
class GaussNewton {
 public:
  using Change = typename Map::Change;
  static constexpr int size = Change::RowsAtCompileTime;
  using Hessian = Eigen::Matrix<double, size, size>;

  /// `map`: one that sends x to the image that is `gap` past its partner.
  void add(const Map& map, const Vector3& x, const Vector3& gap, const Metric& metric,
           double weight) {
    const Eigen::Matrix<double, 3, size> slopes = map.slopes(x);
    const Change across = slopes.transpose() * metric.normal;
    const double off = weight * metric.off_surface, all = weight * metric.isotropic;
    if (all == 0) {
      hessian_.noalias() += off * across * across.transpose();
      gradient_ += off * metric.normal.dot(gap) * across;
      return;
    }
    Eigen::Matrix<double, 3, size> weighted = all * slopes;
    weighted.noalias() += off * metric.normal * across.transpose();
    hessian_.noalias() += slopes.transpose() * weighted;
    gradient_.noalias() += weighted.transpose() * gap;
  }

  const Hessian& hessian() const { return hessian_; }
  const Change& gradient() const { return gradient_; }

  /// The map after the step, and how far its numbers moved; the same one where nothing holds it.
  std::pair<Map, double> taken(const Map& map) const {
    const Hessian damped =
        hessian_ + Hessian((Map::ridge * hessian_.trace() + 1e-300) * Hessian::Identity());
    return map.stepped(solved(damped, Change(-gradient_)));
  }

 private:
  Hessian hessian_ = Hessian::Zero();
  Change gradient_ = Change::Zero();
};

/// A point, its image's partner on the cloud, and the surface at both. `map`: the number of the map
/// that has the image.
struct Match {
  Vector3 point;
  Facet facet;
  Vector3 partner;
  Facet partner_facet;
  std::size_t map = 0;
};

/// What a match counts: offsets of its image by the metric, times the weight; how far off the image
/// is, in tolerances.
struct Counted {
  Metric metric;
  double weight = 0, residual = 0;
};

/// How far off partners may be at first and at last, in diagonals, how many steps a fit takes, and
/// the length of one, in what the map's numbers are measured by, after which nothing moves any
/// more.
struct Schedule {
  double widest, narrowest;
  int steps;
  double still = 1e-4;
};

/// Images on surfaces. The tolerance follows the residuals of what it lets in: images that only
/// just miss the cloud, at the edge of a hole or where nothing mirrors them, stop pulling.
/// `along_surface`: how much an offset along it counts, as partners hardly hold a map where they
/// may slide.
struct SurfaceKernel {
  double spacing, along_surface;

  template <typename Map>
  Counted operator()(const Map& map, const Match& match, const Vector3& off,
                     double tolerance) const {
    const double weight = displaced(map.distance(match.point), tolerance);
    if (weight <= 0) return {};
    const Facet& facet = match.partner_facet;
    const Correspondence correspondence(off, map.reflect_direction(match.point, match.facet.normal),
                                        match.facet.flatness, facet);
    const double r = distance_past(off, facet, spacing) / tolerance;
    return {correspondence.metric(along_surface),
            weight * correspondence.normal_consistency * inside_surface(off, facet, spacing) *
                fading(r * r / 2),
            r};
  }

  double narrowed(double tolerance, const std::vector<Counted>& counted) const {
    constexpr double widening = 2, least = 4;
    double squares = 0, weights = 0;
    for (const Counted& one : counted) {
      squares += one.weight * one.residual * one.residual;
      weights += one.weight;
    }
    return weights < least ? -1 : widening * tolerance * std::sqrt(squares / weights);
  }
};

/// The same points on both sides: at the true map the gaps between images and the points nearest to
/// them all but vanish, while by chance a tenth of all images comes within a fifth of the spacing
/// at best. The tolerance follows the gaps that a share of the points stays below.
struct PartnerKernel {
  static constexpr double rounding = 1e-15;  // diagonals: a step that moves nothing any more

  double spacing, share = 0.1, worth_trying = 0.12;  // worth_trying: of the spacing

  template <typename Map>
  Counted operator()(const Map& map, const Match& match, const Vector3& off,
                     double tolerance) const {
    // What lies on the mirror has itself for a partner.
    if (displaced(map.distance(match.point), spacing) < 1) return {};
    const double residual = off.norm() / tolerance;
    return {Metric{1, 0, Vector3::Zero()}, biweight(residual), residual};
  }

  double narrowed(double tolerance, const std::vector<Counted>& counted) const {
    if (counted.size() < 10) return -1;
    std::vector<double> gaps;
    for (const Counted& one : counted) gaps.push_back(tolerance * one.residual);
    const double typical = quantile(std::move(gaps), share);
    return typical > worth_trying * spacing ? -1 : 3 * typical;
  }
};

/// The maps, and the tolerance of the last step; infinite where too few partners held them.
template <typename Map>
struct Fitted {
  std::vector<Map> maps;
  double tolerance;
};

/// Maps that share their numbers, as elements of a group in one pose do, or a single one, moved
/// until the shape lies on itself: reweighted least squares. Looking for partners is most of the
/// work: they stay until the maps have moved by a part of the spacing, or have converged between
/// them.
///
/// `Matcher`: matches(maps, limit) has partners no farther off than the limit, spacing() is that of
/// what they are among. `Kernel`: what a match counts, and the next tolerance; below 0 too
/// few are held.
template <typename Map, typename Matcher, typename Kernel>
Fitted<Map> fitted(std::vector<Map> maps, const Matcher& matcher, const Schedule& schedule,
                   const Kernel& kernel) {
  constexpr double reach = 0.06;
  const double spacing = matcher.spacing(), stale = 0.1 * spacing, converged = 0.02 * spacing;
  double tolerance = schedule.widest, moved = infinity;
  std::vector<Match> found;
  std::vector<Counted> counted;
  for (int step = 0; step < schedule.steps; ++step) {
    if (moved > stale) {
      found = matcher.matches(maps, std::min(reach, 4 * tolerance + spacing));
      moved = 0;
    }
    GaussNewton<Map> sum;
    counted.clear();
    for (const Match& match : found) {
      const Map& map = maps[match.map];
      const Vector3 off = map.reflect(match.point) - match.partner;
      const Counted one = kernel(map, match, off, tolerance);
      if (!(one.weight > 0)) continue;
      sum.add(map, match.point, off, one.metric, one.weight);
      counted.push_back(one);
    }
    const double narrowed = kernel.narrowed(tolerance, counted);
    if (!(narrowed >= 0)) return {std::move(maps), infinity};
    const auto [next, change] = sum.taken(maps.front());
    for (Map& map : maps) map.follow(next);
    moved += change;
    tolerance = std::clamp(narrowed, schedule.narrowest, tolerance);
    if (change < schedule.still) {
      if (moved < converged) break;
      moved = infinity;
    }
  }
  return {std::move(maps), tolerance};
}

/// A single map.
template <typename Map, typename Matcher, typename Kernel>
Map fitted(const Map& map, const Matcher& matcher, const Schedule& schedule, const Kernel& kernel) {
  return fitted(std::vector<Map>{map}, matcher, schedule, kernel).maps.front();
}

}  // namespace symsurf
