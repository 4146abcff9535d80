#pragma once

#include <symsurf/points.h>

#include <cmath>
#include <cstdint>

namespace symsurf {

/// Random numbers that are the same on every machine and with every standard library, which
/// std::uniform_real_distribution and its like do not promise. SplitMix64 (Steele, Lea and Flood
/// 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// 0 .. count - 1.
  Index below(Index count) {
    return static_cast<Index>(bits() % static_cast<std::uint64_t>(count));
  }

  /// Uniform on the unit sphere: square roots are exact everywhere, sines are not.
  Vector3 direction() {
    for (;;) {
      Vector3 v;
      for (int axis = 0; axis < 3; ++axis) v[axis] = uniform(-1, 1);
      const double squared = v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
      if (squared > 1e-6 && squared <= 1) return v / std::sqrt(squared);
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace symsurf
