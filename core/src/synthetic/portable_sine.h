#pragma once

#include <cmath>

namespace symsurf {

/// sin(2 pi turns) by Taylor's series: sums and products, which IEEE 754 rounds alike, as it does
/// not ask of a library's sine. To a few units of the last digit.
inline double sine_of_turns(double turns) {
  constexpr double tau = 6.283185307179586476925;
  double t = turns - std::floor(turns + 0.5);  // -1/2 .. 1/2
  if (t > 0.25) t = 0.5 - t;
  if (t < -0.25) t = -0.5 - t;
  const double x = tau * t, squared = x * x;
  double sum = 1;
  for (int k = 20; k >= 2; k -= 2) sum = 1 - squared / (k * (k + 1)) * sum;
  return x * sum;
}

inline double cosine_of_turns(double turns) { return sine_of_turns(turns + 0.25); }

}  // namespace symsurf
