#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace symsurf {

/// The maximum that the simplex method of Nelder and Mead (1965) reaches from `start`, its first
/// simplex `step` wide; until the simplex is smaller than `precision` or after `evaluations`.
/// `evaluations` returns how many it took.
template <int N, typename Function>
Eigen::Matrix<double, N, 1> nelder_mead(const Function& function,
                                        const Eigen::Matrix<double, N, 1>& start, double step,
                                        double precision, int& evaluations) {
  using Vector = Eigen::Matrix<double, N, 1>;
  struct Vertex {
    Vector x;
    double value;
  };
  const int most = evaluations;
  evaluations = 0;
  const auto at = [&](const Vector& x) -> Vertex {
    ++evaluations;
    return {x, function(x)};
  };
  const auto better = [](const Vertex& a, const Vertex& b) { return a.value > b.value; };

  std::array<Vertex, N + 1> simplex;
  simplex[0] = at(start);
  for (int i = 0; i < N; ++i) simplex[i + 1] = at(start + step * Vector::Unit(i));
  for (;;) {
    std::stable_sort(simplex.begin(), simplex.end(), better);
    double size = 0;
    for (const Vertex& v : simplex) size = std::max(size, (v.x - simplex[0].x).norm());
    if (size < precision || evaluations >= most) return simplex[0].x;

    Vector middle = Vector::Zero();
    for (int i = 0; i < N; ++i) middle += simplex[i].x / N;
    Vertex& worst = simplex[N];
    const Vertex reflected = at(2 * middle - worst.x);
    if (better(reflected, simplex[0])) {
      const Vertex expanded = at(3 * middle - 2 * worst.x);
      worst = better(expanded, reflected) ? expanded : reflected;
    } else if (better(reflected, simplex[N - 1])) {
      worst = reflected;
    } else {
      const bool outside = better(reflected, worst);
      const Vertex contracted =
          at(outside ? Vector((3 * middle - worst.x) / 2) : Vector((middle + worst.x) / 2));
      if (better(contracted, outside ? reflected : worst)) {
        worst = contracted;
      } else {
        for (int i = 1; i <= N; ++i) simplex[i] = at((simplex[0].x + simplex[i].x) / 2);
      }
    }
  }
}

}  // namespace symsurf
