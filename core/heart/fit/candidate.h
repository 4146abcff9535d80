#pragma once

#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "base/math.h"
#include "base/random.h"
#include "cloud/point_tree.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "fit/fitted.h"

namespace symsurf {

// What the searches for mirrors of few numbers share. A `Shape` is such a mirror in the principal
// frame: distance(x), reflect(x) (NaN without an image), reflect_direction(x, n), the unit normal
// at the image of a surface through x with normal n, and what GaussNewton asks for.
// Compiled for the shapes of shapes.h.

/// A mirror, the share of the surfels that it explains and that of the points that it maps onto
/// partners of their own, beyond chance; both in [0, 1].
template <typename Shape>
struct Candidate {
  Shape shape;
  double support = 0;
  double partnered = 0;

  /// Many mirrors explain a plain surface, but only the true one partners its points.
  double merit() const { return support + partnered; }
};

template <typename Shape>
void sort_best_first(std::vector<Candidate<Shape>>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.merit() > b.merit(); });
}

/// Share of the surfels whose images agree with the cloud, less `contradiction` times those whose
/// images come beside it, out of those the mirror moves (at least `least_moved` of all, so that a
/// mirror the cloud lies along explains nothing). Surfels without an image count as moved; an image
/// in the void says nothing: that part may be missing. `map`: of the surfels, or of those of
/// another cloud that the shape maps these onto. `stride` k looks at every k-th surfel.
template <typename Shape>
double support_share(const Surfels& surfels, const SurfelMap& map, const Shape& shape,
                     double tolerance, Index stride = 1, double contradiction = 0,
                     double least_moved = 0.35) {
  double moved = 0, support = 0;
  Index looked = 0;
  for (Index i = 0; i < surfels.size(); i += stride, ++looked) {
    const Surfel& s = surfels[i];
    const double weight = displaced(shape.distance(s.position), tolerance);
    if (weight <= 0) continue;
    moved += weight;
    const Vector3 image = shape.reflect(s.position);
    const Index j = map.nearest(image);
    if (j < 0) continue;
    const Correspondence correspondence(
        image - map[j].position, shape.reflect_direction(s.position, s.normal), s.flatness, map[j]);
    const double agrees = correspondence.weight(tolerance);
    support += weight * (agrees - contradiction * (1 - agrees));
  }
  return support / std::max(moved, least_moved * static_cast<double>(looked));
}

/// Surfels as the cloud that images of surfels meet: the same, or another's.
class PatchMatcher {
 public:
  /// Looks at every `stride`-th surfel.
  PatchMatcher(const Surfels& surfels, const SurfelMap& map, Index stride)
      : surfels_(surfels), map_(map), stride_(stride) {}

  double spacing() const { return surfels_.spacing(); }
  SurfaceKernel kernel() const { return {spacing(), 0.08}; }

  template <typename Map>
  std::vector<Match> matches(const std::vector<Map>& maps, double /*limit*/) const {
    std::vector<Match> found;
    found.reserve(maps.size() * surfels_.size() / stride_ + 1);
    for (std::size_t k = 0; k < maps.size(); ++k)
      for (Index i = 0; i < surfels_.size(); i += stride_) {
        const Surfel& own = surfels_[i];
        const Index j = map_.nearest(maps[k].reflect(own.position));
        if (j >= 0) found.push_back({own.position, own, map_[j].position, map_[j], k});
      }
    return found;
  }

 private:
  const Surfels& surfels_;
  const SurfelMap& map_;
  Index stride_;
};

/// Moves a mirror onto the surfels' images, looking less far with each step.
template <typename Shape>
Candidate<Shape> refined_on_surfels(const Surfels& surfels, const SurfelMap& map,
                                    Candidate<Shape> candidate, double widest, double narrowest,
                                    int steps, Index stride, double contradiction = 0);

/// Drops mirrors that send the probes nearly where a better one does, within `distance` diagonals,
/// root mean square; best first.
template <typename Shape>
void suppress_non_maxima(const std::vector<Vector3>& probes,
                         std::vector<Candidate<Shape>>& candidates, double distance, Index count);

/// The same with positions of the cloud for probes.
template <typename Shape>
void suppress_non_maxima(const Surfels& surfels, std::vector<Candidate<Shape>>& candidates,
                         double distance, Index count);

/// The best `count` of many hypotheses that differ: each meets a glance at few surfels first.
template <typename Shape>
std::vector<Candidate<Shape>> best_of(const std::vector<Shape>& hypotheses, const Surfels& surfels,
                                      const SurfelMap& map, Index count, const Context& context);

/// The same of large, middling and small mirrors apart, by `radius(shape)`, in diagonals: of balls
/// and tubes any plane through the middle, and what is nearly one, explains more than small mirrors
/// beside the true one do.
template <typename Shape, typename Radius>
std::vector<Candidate<Shape>> best_of_each_size(std::vector<Shape> hypotheses, const Radius& radius,
                                                const Surfels& surfels, const SurfelMap& map,
                                                Index count, const Context& context) {
  constexpr std::array least_radii{0.7, 0.3, 0.0};
  std::vector<Candidate<Shape>> candidates;
  for (const double least : least_radii) {
    const auto rest =
        std::stable_partition(hypotheses.begin(), hypotheses.end(),
                              [&](const Shape& shape) { return radius(shape) < least; });
    const std::vector<Shape> chosen(rest, hypotheses.end());
    hypotheses.erase(rest, hypotheses.end());
    for (const Candidate<Shape>& candidate :
         best_of(chosen, surfels, map, count / static_cast<Index>(least_radii.size()), context))
      candidates.push_back(candidate);
  }
  return candidates;
}

/// Points of the cloud, in the principal frame, and the nearest of all to their images.
class PointMatcher {
 public:
  PointMatcher(const std::vector<Vector3>& positions, const NearestPoints& points,
               const PrincipalFrame& frame, double spacing)
      : positions_(positions), points_(points), frame_(frame), spacing_(spacing) {}

  double spacing() const { return spacing_; }

  template <typename Map>
  std::vector<Match> matches(const std::vector<Map>& maps, double limit) const {
    std::vector<Match> found;
    std::vector<Vector3> images;
    for (const Vector3& x : positions_) {
      const Vector3 image = maps.front().reflect(x);
      if (!image.allFinite()) continue;
      found.push_back({x, {Vector3::Zero(), 0}, x, {Vector3::Zero(), 0}});
      images.push_back(frame_.from_frame(image));
    }
    const std::vector<Vector3> partners = points_.nearest(images, limit * frame_.size);
    for (std::size_t i = 0; i < found.size(); ++i) found[i].partner = frame_.to_frame(partners[i]);
    std::erase_if(found, [](const Match& match) { return !match.partner.allFinite(); });
    return found;
  }

 private:
  const std::vector<Vector3>& positions_;
  const NearestPoints& points_;
  const PrincipalFrame& frame_;
  double spacing_;
};

/// Where the same points, or some of them, stand on both sides: converges on them to rounding. None
/// where there are no such points. The shape, the positions of the points that are looked at and
/// the spacing are in the principal frame.
template <typename Shape>
std::optional<Shape> fitted_to_exact_pairs(const Shape& shape,
                                           const std::vector<Vector3>& positions,
                                           const NearestPoints& points, const PrincipalFrame& frame,
                                           double spacing) {
  constexpr double exact = 0.03;  // of the spacing
  constexpr double rounding = PartnerKernel::rounding;
  const auto [shapes, tolerance] =
      fitted(std::vector<Shape>{shape}, PointMatcher(positions, points, frame, spacing),
             {spacing, rounding, 16, rounding}, PartnerKernel{spacing});
  if (tolerance >= exact * spacing) return std::nullopt;
  return shapes.front();
}

/// Mirrors that map one surfel of a pair onto the other, normals included. A pair fixes a point of
/// the mirror and its normal there: `through(middle, normal, most, add)` calls add(shape) for each
/// mirror to try there, none more curved than `most`, so that images stay clear of the centre. All
/// pairs where there are no more than `kept`; else draws until `tried` pairs, or `kept` with a
/// mirror.
template <typename Shape, typename Through>
std::vector<Shape> hypotheses_of_pairs(const Surfels& surfels, std::uint64_t seed, Index tried,
                                       Index kept, const Through& through, const Context& context) {
  constexpr double shortest_chord = 0.05;
  constexpr double longest_chord = 1.9;   // radii
  constexpr double facing_cosine = 0.88;  // 28 degrees
  constexpr std::size_t most = 100000;    // where no normals choose among them
  std::vector<Shape> shapes;
  const auto adds_mirror = [&](const Surfel& a, const Surfel& b) {
    context.check();
    const Vector3 chord = b.position - a.position;
    const double length = chord.norm();
    if (length < shortest_chord) return false;
    const std::size_t before = shapes.size();
    through(Vector3((a.position + b.position) / 2), Vector3(chord / length), longest_chord / length,
            [&](const Shape& shape) {
              const double cosine = shape.reflect_direction(a.position, a.normal).dot(b.normal);
              if (std::abs(cosine) < facing_cosine && a.flatness * b.flatness > 0.25) return;
              shapes.push_back(shape);
            });
    return shapes.size() > before;
  };
  const Index count = surfels.size();
  if (count * (count - 1) / 2 <= kept) {
    for (Index i = 0; i < count; ++i)
      for (Index j = i + 1; j < count; ++j) adds_mirror(surfels[i], surfels[j]);
    return shapes;
  }
  Random random(seed);
  Index found = 0;
  for (Index trial = 0; trial < tried && found < kept && shapes.size() < most; ++trial) {
    const Surfel& a = surfels[random.below(count)];
    const Surfel& b = surfels[random.below(count)];
    found += adds_mirror(a, b);
  }
  return shapes;
}

}  // namespace symsurf
