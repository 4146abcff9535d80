#pragma once

#include <symsurf/context.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/math.h"
#include "base/random.h"
#include "cloud/nearest_points.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "pairing/correspondence.h"

namespace symsurf {

/// Where the same points, or some of them, stand on both sides, the gaps between images and the
/// points nearest to them all but vanish at the true mirror, while by chance a tenth of all images
/// comes within a fifth of the spacing at best: converges on them to rounding. None where there are
/// no such points. The shape, the positions of the points that are looked at and the spacing are in
/// the principal frame.
template <typename Shape>
std::optional<Shape> fitted_to_exact_pairs(Shape shape, const std::vector<Vector3>& positions,
                                           const NearestPoints& points, const PrincipalFrame& frame,
                                           double spacing) {
  constexpr int steps = 16;
  constexpr double worth_trying = 0.12, exact = 0.01;  // of the spacing
  struct Gap {
    Vector3 position, vector;
  };
  double typical = 0;
  for (int step = 0; step < steps; ++step) {
    std::vector<Vector3> moved_points, images;
    for (const Vector3& x : positions) {
      // What lies on the mirror has itself for a partner.
      const Vector3 image = shape.reflect(x);
      if (!image.allFinite() || displaced(shape.distance(x), spacing) < 1) continue;
      moved_points.push_back(x);
      images.push_back(frame.from_frame(image));
    }
    const std::vector<Vector3> partners = points.nearest(images, spacing * frame.size);
    std::vector<Gap> gaps;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < partners.size(); ++i) {
      if (!partners[i].allFinite()) continue;
      const Vector3& x = moved_points[i];
      gaps.push_back({x, shape.reflect(x) - frame.to_frame(partners[i])});
      lengths.push_back(gaps.back().vector.norm());
    }
    if (gaps.size() < 10) return std::nullopt;
    typical = quantile(std::move(lengths), 0.1);
    if (typical > worth_trying * spacing) return std::nullopt;
    typename Shape::Step sum(shape);
    for (const Gap& gap : gaps)
      if (gap.vector.norm() <= 3 * typical)
        sum.add(gap.position, gap.vector, Metric{1, 0, Vector3::Zero()}, 1);
    double moved;
    shape = sum.taken(&moved);
    if (moved < 1e-15) break;
  }
  if (typical >= exact * spacing) return std::nullopt;
  return shape;
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
  for (Index trial = 0; trial < tried && found < kept; ++trial) {
    const Surfel& a = surfels[random.below(count)];
    const Surfel& b = surfels[random.below(count)];
    found += adds_mirror(a, b);
  }
  return shapes;
}

}  // namespace symsurf
