#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "cloud/surfels.h"

namespace symsurf {

/// Mirrors that map one surfel of a pair drawn at random onto the other, normals included. A pair
/// fixes a point of the mirror and its normal there: `through(middle, normal, most, add)` calls
/// add(shape) for each mirror to try there, none more curved than `most`, so that images stay clear
/// of the centre. Draws until `tried` pairs, or `kept` with a mirror.
template <typename Shape, typename Through>
std::vector<Shape> hypotheses_of_pairs(const Surfels& surfels, std::uint64_t seed, Index tried,
                                       Index kept, const Through& through) {
  constexpr double shortest_chord = 0.05;
  constexpr double longest_chord = 1.9;   // radii
  constexpr double facing_cosine = 0.88;  // 28 degrees
  Random random(seed);
  std::vector<Shape> shapes;
  Index found = 0;
  for (Index trial = 0; trial < tried && found < kept; ++trial) {
    const Surfel& a = surfels[random.below(surfels.size())];
    const Surfel& b = surfels[random.below(surfels.size())];
    const Vector3 chord = b.position - a.position;
    const double length = chord.norm();
    if (length < shortest_chord) continue;
    const std::size_t before = shapes.size();
    through(Vector3((a.position + b.position) / 2), Vector3(chord / length), longest_chord / length,
            [&](const Shape& shape) {
              const double cosine = shape.reflect_direction(a.position, a.normal).dot(b.normal);
              if (std::abs(cosine) < facing_cosine && a.flatness * b.flatness > 0.25) return;
              shapes.push_back(shape);
            });
    found += shapes.size() > before;
  }
  return shapes;
}

}  // namespace symsurf
