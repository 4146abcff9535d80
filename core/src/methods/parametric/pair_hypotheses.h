#pragma once

#include <symsurf/context.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "cloud/surfels.h"

namespace symsurf {

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
