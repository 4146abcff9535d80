#pragma once

#include <cmath>

namespace symsurf {

/// How closely an image meets the cloud's surface, 0..1, from its distance to it as a share of the
/// cloud's size and from how well the normals mirror each other, 0..1.
inline double closeness(double residual, double facing) {
  constexpr double close = 0.002;
  const double near = residual / close;
  return facing / (1 + near * near);
}

/// What an image says for or against a mirror: 1 where it meets the surface, about -0.7 where it
/// just misses it, 0 far from it. A true mirror of a shape with a piece missing sends images into
/// the void, a wrong one sends them past the surface everywhere. It ranks mirrors.
inline double testimony(double residual, double facing) {
  constexpr double meets = 0.0015, misses = 0.016, objection = 0.7;
  const double near = residual / meets, past = residual / misses;
  return facing / (1 + near * near) - objection * past * past * std::exp(1 - past * past);
}

}  // namespace symsurf
