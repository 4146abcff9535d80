#pragma once

#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <random>

#include "seeds.h"

namespace symsurf {

/// Draws stand in statements of their own: compilers differ in which argument they evaluate first,
/// and the clouds are to be the same with all of them.
class RandomCloud {
 public:
  explicit RandomCloud(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Index below(Index n) { return std::uniform_int_distribution<Index>(0, n - 1)(random_); }
  Vector3 in_box() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  Vector3 direction() {
    std::normal_distribution<double> normal;
    const double z = normal(random_), y = normal(random_), x = normal(random_);
    return Vector3(x, y, z).normalized();
  }
  Matrix3 rotation() {
    const Vector3 axis = direction();
    return Eigen::AngleAxisd(uniform(0, 3), axis).toRotationMatrix();
  }

  Points box(Index n) {
    return rows(n, [&] { return in_box(); });
  }
  Points sphere(Index n) {
    return rows(n, [&] { return direction(); });
  }
  /// Corners of unit cells, each several times: distances tie, and are exact.
  Points lattice(Index n, int side) {
    std::uniform_int_distribution<int> at(0, side - 1);
    return rows(n, [&] {
      const int z = at(random_), y = at(random_), x = at(random_);
      return Vector3(x, y, z);
    });
  }

 private:
  template <typename Draw>
  static Points rows(Index n, const Draw& draw) {
    Points points(n, 3);
    for (Index i = 0; i < n; ++i) points.row(i) = draw().transpose();
    return points;
  }

  std::mt19937_64 random_;
};

}  // namespace symsurf
