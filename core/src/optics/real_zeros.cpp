#include "optics/real_zeros.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace symsurf {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Evaluated {
  double value, slope, rounding;
};

Evaluated evaluated(const std::vector<double>& coefficients, double t) {
  Evaluated e{0, 0, 0};
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) {
    e.slope = e.slope * t + e.value;
    e.value = e.value * t + *c;
    e.rounding = e.rounding * std::abs(t) + std::abs(*c);
  }
  e.rounding *= 4 * epsilon;
  return e;
}

// Newton's steps, or halves of the bracket where they leave it.
double root_between(const std::vector<double>& coefficients, double low, double high,
                    bool is_rising) {
  double t = low + (high - low) / 2;
  for (int k = 0; k < 200; ++k) {
    const Evaluated at = evaluated(coefficients, t);
    if (at.value == 0) break;
    ((at.value < 0) == is_rising ? low : high) = t;
    double next = t - at.value / at.slope;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (std::abs(next - t) <= epsilon * std::abs(t)) return next;
    t = next;
  }
  return t;
}

}  // namespace

std::vector<double> real_roots(const std::vector<double>& coefficients) {
  const std::size_t degree = coefficients.size() - 1;
  if (degree == 0) return {};
  if (degree == 1) return {-coefficients[0] / coefficients[1]};
  std::vector<double> derivative;
  double greatest = 0;
  for (std::size_t k = 0; k < degree; ++k) {
    derivative.push_back(static_cast<double>(k + 1) * coefficients[k + 1]);
    greatest = std::max(greatest, std::abs(coefficients[k] / coefficients[degree]));
  }
  const double bound = 1 + greatest;  // Cauchy's, of all roots
  std::vector<double> turns = real_roots(derivative), roots;
  turns.push_back(bound);
  double low = -bound;
  Evaluated before = evaluated(coefficients, low);
  for (const double high : turns) {
    if (!(high > low)) continue;
    const Evaluated after = evaluated(coefficients, high);
    if ((before.value < 0) != (after.value < 0))
      roots.push_back(root_between(coefficients, low, high, before.value < 0));
    else if (std::abs(after.value) <= after.rounding && high < bound)
      roots.push_back(high);  // a double root, to rounding
    low = high;
    before = after;
  }
  return roots;
}

double TurnPolynomial::operator()(double angle) const {
  return constant + c1 * std::cos(angle) + s1 * std::sin(angle) + c2 * std::cos(2 * angle) +
         s2 * std::sin(2 * angle);
}

std::vector<double> TurnPolynomial::zeros() const {
  // The tangent of half the angle is infinite opposite to where it is reckoned from: of five
  // angles, one more than there are zeros, that farthest from one.
  double farthest = 0, opposite = 0;
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5 + 0.1, value = std::abs((*this)(angle));
    if (!(value > farthest)) continue;
    farthest = value;
    opposite = angle;
  }
  const double size =
      std::abs(constant) + std::abs(c1) + std::abs(s1) + std::abs(c2) + std::abs(s2);
  if (!(farthest > 16 * epsilon * size)) return {};
  const double from = opposite + std::numbers::pi;
  const double cosine = std::cos(from), sine = std::sin(from);
  const double cosine2 = std::cos(2 * from), sine2 = std::sin(2 * from);
  const double p = c1 * cosine + s1 * sine, q = s1 * cosine - c1 * sine;
  const double p2 = c2 * cosine2 + s2 * sine2, q2 = s2 * cosine2 - c2 * sine2;
  // Times (1 + t^2)^2.
  const std::vector<double> quartic{constant + p2 + p, 4 * q2 + 2 * q, 2 * constant - 6 * p2,
                                    2 * q - 4 * q2, constant + p2 - p};
  std::vector<double> angles;
  for (const double t : real_roots(quartic)) angles.push_back(from + 2 * std::atan(t));
  return angles;
}

}  // namespace symsurf
