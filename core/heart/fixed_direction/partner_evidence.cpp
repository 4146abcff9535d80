#include "fixed_direction/partner_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/vectorised.h"

namespace symsurf {

namespace {

constexpr std::array<double, 4> scatters{0.6, 0.4, 0.25, 0.12};  // spacings
constexpr int shifts = 4;                                        // at each
constexpr int sectors = 4;
constexpr double inner = 1.5, ring_inner = 1.8, ring_outer = 2.7;

struct Count {
  double inside = 0, inside_squares = 0;
  std::array<double, sectors> ring{};

  // Against the fullest direction of the ring: surfaces seen edge-on crowd along a line.
  double chance() const {
    constexpr double share =
        inner * inner / (ring_outer * ring_outer - ring_inner * ring_inner) * sectors;
    return *std::max_element(ring.begin(), ring.end()) * share;
  }
  double significance() const {
    return (inside - chance()) / std::sqrt(std::max(inside_squares, 1.0) + chance() * sectors / 4);
  }
};

SYMSURF_VECTORISED void shifted_squares(const double* u, const double* v, const double* length,
                                        std::size_t count, double at_u, double at_v, double scale,
                                        double* squares) {
  for (std::size_t k = 0; k < count; ++k) {
    const double du = u[k] - length[k] * at_u, dv = v[k] - length[k] * at_v;
    squares[k] = (du * du + dv * dv) * scale;
  }
}

// The chords' offsets side by side: most are passed over, at every shift.
class Offsets {
 public:
  explicit Offsets(const std::vector<MidSurface::Chord>& chords) : squares_(chords.size()) {
    for (const MidSurface::Chord& c : chords) {
      u_.push_back(c.offset.x());
      v_.push_back(c.offset.y());
      length_.push_back(c.length);
    }
  }

  // Of the offsets that are left when the direction moves to `at`.
  const double* squares(const Eigen::Vector2d& at, double scale) {
    shifted_squares(u_.data(), v_.data(), length_.data(), u_.size(), at.x(), at.y(), scale,
                    squares_.data());
    return squares_.data();
  }

 private:
  std::vector<double> u_, v_, length_, squares_;
};

}  // namespace

PartnerEvidence partner_evidence(const MidSurface& surface, const SurfacePoints& cloud,
                                 const Vector3& direction, const Context& context) {
  const std::vector<MidSurface::Chord> chords = surface.chords();
  PartnerEvidence best{direction, 0, 0};
  if (chords.size() < 10) return best;

  Offsets offsets(chords);
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (const double spacings : scatters) {
    const double scatter = spacings * cloud.spacing;
    const double narrow = 1 / (scatter * scatter);
    for (int shift = 0; shift <= shifts; ++shift) {
      context.check();
      Count count;
      double lever = 0, own = 0;
      Eigen::Vector2d pull = Eigen::Vector2d::Zero();
      const double* const squares = offsets.squares(at, narrow);
      for (std::size_t k = 0; k < chords.size(); ++k) {
        const double squared = squares[k];
        if (squared > ring_outer * ring_outer) continue;
        const MidSurface::Chord& c = chords[k];
        const Eigen::Vector2d o = c.offset - c.length * at;
        if (squared < inner * inner) {
          count.inside += c.weight;
          count.inside_squares += c.weight * c.weight;
        } else if (squared > ring_inner * ring_inner) {
          const bool steep = std::abs(o.y()) > std::abs(o.x());
          count.ring[(steep ? 2 : 0) + (o.x() * o.y() > 0 ? 1 : 0)] += c.weight;
        }
        const double kernel = 1 - squared / (ring_outer * ring_outer);
        const double weight = kernel * kernel * c.weight;
        pull += weight * c.length * o;
        lever += weight * c.length * c.length;
      }
      if (shift == shifts) {
        const double significance = count.significance();
        if (significance > best.significance)
          best = {(direction + surface.across() * at).normalized(), significance, scatter};
        break;
      }
      if (!(lever > 0)) break;
      own = std::clamp(1 - count.chance() / std::max(count.inside, 1e-9), 0.2, 1.0);
      Eigen::Vector2d step = pull / lever / own;
      const double longest = 2 * scatter;
      if (step.norm() > longest) step *= longest / step.norm();
      at += step;
    }
  }
  return best;
}

}  // namespace symsurf
