#pragma once

#include <vector>

namespace symsurf {

/// The real roots of a polynomial, ascending; `coefficients` from the constant one up, the last not
/// zero. Between two neighbouring roots of its derivative there is at most one.
std::vector<double> real_roots(const std::vector<double>& coefficients);

/// A function of an angle: constant + c1 cos + s1 sin + c2 cos 2 + s2 sin 2.
struct TurnPolynomial {
  double constant, c1, s1, c2, s2;

  double operator()(double angle) const;

  /// Its zeros within one turn, in radians: at most four, the roots of a quartic in the tangent of
  /// half the angle. None where it is zero everywhere.
  std::vector<double> zeros() const;
};

}  // namespace symsurf
