#include "cloud/least_variance.h"

#include <cmath>
#include <limits>

#include "base/vectorised.h"

namespace symsurf {

namespace {

using Lanes = Neighbourhoods::Lanes;

inline __attribute__((always_inline)) Doubles root_of(Doubles x) {
  for (int i = 0; i < doubles_wide; ++i) x[i] = std::sqrt(x[i]);
  return x;
}

inline __attribute__((always_inline)) Doubles absolute(const Doubles& x) {
  return x < Doubles{} ? -x : x;
}

// Symmetric matrices, one a lane.
struct Matrices {
  Doubles xx, yy, zz, yz, xz, xy;
};

inline __attribute__((always_inline)) Matrices scatter_of(const Lanes* offsets, Index points,
                                                          int first) {
  const auto at = [&](Index i, int axis) -> const Doubles& {
    return *reinterpret_cast<const Doubles*>(&offsets[3 * i + axis][first]);
  };
  const double share = 1.0 / static_cast<double>(points);
  Doubles reach{}, mean[3]{};
  for (Index i = 0; i < points; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const Doubles size = absolute(at(i, axis));
      reach = size > reach ? size : reach;
      mean[axis] += share * at(i, axis);
    }
  // In units of their reach, so that squares neither overflow nor vanish.
  const Doubles most = Doubles{} + std::numeric_limits<double>::max(), inverse = 1 / reach;
  const Doubles scale = inverse < most ? inverse : most;
  Matrices scatter{};
  for (Index i = 0; i < points; ++i) {
    const Doubles x = (at(i, 0) - mean[0]) * scale, y = (at(i, 1) - mean[1]) * scale,
                  z = (at(i, 2) - mean[2]) * scale;
    scatter.xx += x * x;
    scatter.yy += y * y;
    scatter.zz += z * z;
    scatter.yz += y * z;
    scatter.xz += x * z;
    scatter.xy += x * y;
  }
  return scatter;
}

struct Axis {
  Doubles x, y, z;
};

inline __attribute__((always_inline)) void turn(const Doubles& cosine, const Doubles& sine,
                                                Doubles& p, Doubles& q) {
  const Doubles turned = cosine * p - sine * q;
  q = sine * p + cosine * q;
  p = turned;
}

using Mask = decltype(Doubles{} < Doubles{});

// Turns the axes p and q of some lanes within their plane so that pq vanishes.
inline __attribute__((always_inline)) void rotate(const Mask& some, Doubles& pp, Doubles& qq,
                                                  Doubles& pq, Doubles& pr, Doubles& qr, Axis& p,
                                                  Axis& q) {
  const Doubles half = 0.5 * (qq - pp);
  const Doubles sum = absolute(half) + root_of(half * half + pq * pq);
  const Doubles adjacent = some & (sum > Doubles{}) ? sum : Doubles{} + 1,
                opposite = some ? (half < Doubles{} ? -pq : pq) : Doubles{};
  const Doubles tangent = opposite / adjacent,
                scale = 1 / root_of(adjacent * adjacent + opposite * opposite);
  const Doubles cosine = adjacent * scale, sine = opposite * scale;
  pp -= tangent * pq;
  qq += tangent * pq;
  pq = Doubles{};
  turn(cosine, sine, pr, qr);
  turn(cosine, sine, p.x, q.x);
  turn(cosine, sine, p.y, q.y);
  turn(cosine, sine, p.z, q.z);
}

inline __attribute__((always_inline)) Mask not_diagonal(const Matrices& m) {
  constexpr double rounding = 1e-18;
  return absolute(m.yz) + absolute(m.xz) + absolute(m.xy) > rounding * (m.xx + m.yy + m.zz);
}

inline bool any(const Mask& mask) {
  for (int i = 0; i < doubles_wide; ++i)
    if (mask[i]) return true;
  return false;
}

SYMSURF_VECTORISED void find_axes(const Lanes* offsets, Index points, double* axes) {
  // Converges quadratically: five or six sweeps do.
  constexpr int sweeps = 20;
  for (int first = 0; first < Neighbourhoods::lanes; first += doubles_wide) {
    Matrices m = scatter_of(offsets, points, first);
    const Doubles zero{}, one = zero + 1;
    Axis x{one, zero, zero}, y{zero, one, zero}, z{zero, zero, one};
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      // The others stay as they are, so that no lane depends on what is beside it.
      const Mask some = not_diagonal(m);
      if (!any(some)) break;
      rotate(some, m.xx, m.yy, m.xy, m.xz, m.yz, x, y);
      rotate(some, m.xx, m.zz, m.xz, m.xy, m.yz, x, z);
      rotate(some, m.yy, m.zz, m.yz, m.xy, m.xz, y, z);
    }
    const auto second = m.yy < m.xx;
    const Doubles lesser = second ? m.yy : m.xx;
    const auto third = m.zz < lesser;
    const auto least = [&](const Doubles& a, const Doubles& b, const Doubles& c) {
      return third ? c : second ? b : a;
    };
    const Axis axis{least(x.x, y.x, z.x), least(x.y, y.y, z.y), least(x.z, y.z, z.z)};
    const Doubles length = root_of(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    for (int i = 0; i < doubles_wide; ++i) {
      axes[3 * (first + i)] = axis.x[i] / length[i];
      axes[3 * (first + i) + 1] = axis.y[i] / length[i];
      axes[3 * (first + i) + 2] = axis.z[i] / length[i];
    }
  }
}

}  // namespace

Points Neighbourhoods::offsets(int lane) const {
  Points offsets(static_cast<Index>(offsets_.size()) / 3, 3);
  for (std::size_t k = 0; k < offsets_.size(); ++k) offsets.data()[k] = offsets_[k][lane];
  return offsets;
}

Eigen::Matrix<double, 3, Neighbourhoods::lanes> Neighbourhoods::least_variance() const {
  Eigen::Matrix<double, 3, lanes> axes;
  find_axes(offsets_.data(), static_cast<Index>(offsets_.size()) / 3, axes.data());
  return axes;
}

}  // namespace symsurf
