#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/parallel.h"
#include "fixed_direction/fixed_direction.h"

namespace symsurf {

namespace {

constexpr int bins = 112;       // along a face's edge
constexpr float margin = 1.2f;  // faces overlap: a peak on a seam is whole on one of them
constexpr std::array<int, 4> half_widths{0, 2, 4, 7};  // of the boxes, in bins
constexpr double least_chord = 0.5;                    // spacings
constexpr Index chord_budget = 4'500'000;
constexpr Index sharpening_anchors = 500;

class CubeMap {
 public:
  CubeMap() : bins_(3 * bins * bins, 0) {}

  void add(const std::array<float, 3>& d, float weight) {
    const float x = std::abs(d[0]), y = std::abs(d[1]), z = std::abs(d[2]);
    const float largest = std::max({x, y, z});
    if (x * margin > largest) add(0, d[1] / d[0], d[2] / d[0], weight);
    if (y * margin > largest) add(1, d[2] / d[1], d[0] / d[1], weight);
    if (z * margin > largest) add(2, d[0] / d[2], d[1] / d[2], weight);
  }

  // Sums over all rectangles in constant time.
  void integrate() {
    sums_.assign(3 * (bins + 1) * (bins + 1), 0);
    for (int face = 0; face < 3; ++face)
      for (int r = 0; r < bins; ++r)
        for (int c = 0; c < bins; ++c)
          sums_[at(face, r + 1, c + 1)] = bins_[(face * bins + r) * bins + c] +
                                          sums_[at(face, r, c + 1)] + sums_[at(face, r + 1, c)] -
                                          sums_[at(face, r, c)];
  }

  // The share of a box's bins that lie on the face goes to `area`.
  double box(int face, int row, int column, int half, double& area) const {
    const int r0 = std::max(0, row - half), r1 = std::min(bins, row + half + 1);
    const int c0 = std::max(0, column - half), c1 = std::min(bins, column + half + 1);
    area = static_cast<double>(r1 - r0) * (c1 - c0);
    return sums_[at(face, r1, c1)] - sums_[at(face, r0, c1)] - sums_[at(face, r1, c0)] +
           sums_[at(face, r0, c0)];
  }

  static Vector3 direction(int face, int row, int column) {
    const auto coordinate = [](int bin) { return ((bin + 0.5) / bins * 2 - 1) * margin; };
    Vector3 d;
    d[face] = 1;
    d[(face + 1) % 3] = coordinate(row);
    d[(face + 2) % 3] = coordinate(column);
    return d.normalized();
  }

 private:
  static int at(int face, int r, int c) { return (face * (bins + 1) + r) * (bins + 1) + c; }

  void add(int face, float u, float v, float weight) {
    constexpr float scale = bins / (2 * margin);
    const int r = static_cast<int>((u + margin) * scale);
    const int c = static_cast<int>((v + margin) * scale);
    if (r < bins && c < bins) bins_[(face * bins + r) * bins + c] += weight;
  }

  std::vector<float> bins_;
  std::vector<double> sums_;
};

CubeMap histogram(const SurfacePoints& cloud, const Context& context) {
  CubeMap map;
  const Index n = cloud.size();
  const Index anchors = std::clamp<Index>(chord_budget / n, 1, n);
  const double shortest = least_chord * cloud.spacing;
  const float shortest_squared = static_cast<float>(shortest * shortest);
  using Columns = Eigen::Array<float, Eigen::Dynamic, 3>;
  const Columns x = cloud.points.cast<float>(), normal = cloud.normals.cast<float>();
  const auto add_chords_of = [&](Index a) {
    const Index i = a * n / anchors;
    const std::array<float, 3> p{x(i, 0), x(i, 1), x(i, 2)};
    const std::array<float, 3> m{normal(i, 0), normal(i, 1), normal(i, 2)};
    for (Index j = anchors == n ? i + 1 : 0; j < n; ++j) {
      const std::array<float, 3> d{x(j, 0) - p[0], x(j, 1) - p[1], x(j, 2) - p[2]};
      const float squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      if (squared < shortest_squared) continue;
      const float here = m[0] * d[0] + m[1] * d[1] + m[2] * d[2];
      const float there = normal(j, 0) * d[0] + normal(j, 1) * d[1] + normal(j, 2) * d[2];
      map.add(d, std::abs(here * there) / squared);
    }
  };
  constexpr Index stretch = 64;  // anchors, of some thousand chords each
  interruptible_for(context, anchors, add_chords_of, stretch);
  map.integrate();
  return map;
}

}  // namespace

std::vector<ChordPeak> chord_peaks(const SurfacePoints& cloud, Index count,
                                   const Context& context) {
  const CubeMap map = histogram(cloud, context);
  std::vector<ChordPeak> peaks;
  for (const int half : half_widths) {
    std::vector<ChordPeak> found;
    for (int face = 0; face < 3; ++face)
      for (int r = 0; r < bins; r += 1 + half / 2)
        for (int c = 0; c < bins; c += 1 + half / 2) {
          double area, ring_area;
          const double inner = map.box(face, r, c, half, area);
          const double outer = map.box(face, r, c, 2 * half + 3, ring_area);
          const double expected = (outer - inner) / (ring_area - area) * area;
          const double significance = (inner - expected) / std::sqrt(expected + 1);
          if (significance > 3) found.push_back({CubeMap::direction(face, r, c), significance});
        }
    std::stable_sort(found.begin(), found.end(), [](const ChordPeak& a, const ChordPeak& b) {
      return a.significance > b.significance;
    });
    const double apart = (2 * half + 2) * 2 * margin / bins;
    Index kept = 0;
    for (const ChordPeak& peak : found) {
      const bool seen = std::any_of(peaks.begin(), peaks.end(), [&](const ChordPeak& other) {
        return peak.direction.cross(other.direction).norm() < apart;
      });
      if (seen) continue;
      peaks.push_back(peak);
      if (++kept == count) break;
    }
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const ChordPeak& a, const ChordPeak& b) {
    return a.significance > b.significance;
  });
  return peaks;
}

SharpDirection sharpened(const SurfacePoints& cloud, const Vector3& start, double angle) {
  const Index n = cloud.size();
  const Index anchors = std::min(n, sharpening_anchors);
  const double cosine = std::cos(angle);
  const double shortest = least_chord * cloud.spacing;
  std::vector<Vector3> chords;  // unit, towards start
  for (Index a = 0; a < anchors; ++a) {
    const Vector3 p = cloud.point(a * n / anchors);
    for (Index j = 0; j < n; ++j) {
      const Vector3 d = cloud.point(j) - p;
      const double along = d.dot(start);
      const double squared = d.squaredNorm();
      // Of points so close that their spacing is 0, only copies have no chord.
      if (squared == 0 || squared < shortest * shortest) continue;
      if (along * along < cosine * cosine * squared) continue;
      chords.push_back(d / std::copysign(std::sqrt(squared), along));
    }
  }
  SharpDirection sharp{start, angle, static_cast<Index>(chords.size()), 0};
  sharp.expected = static_cast<double>(chords.size());
  const double per_area = sharp.expected / (angle * angle);
  // The densest half of the cone: of its own chords, the one with most others about it.
  while (sharp.angle > 1e-13) {
    const double half = sharp.angle / 2;
    Vector3 best = sharp.direction;
    Index most = 0;
    const Index tried = std::min<Index>(60, static_cast<Index>(chords.size()));
    for (Index t = 0; t < tried; ++t) {
      const Vector3& centre = chords[t * static_cast<Index>(chords.size()) / tried];
      const Index count = std::count_if(chords.begin(), chords.end(), [&](const Vector3& d) {
        return (d - centre).squaredNorm() < half * half;
      });
      if (count > most) {
        most = count;
        best = centre;
      }
    }
    const double share = static_cast<double>(chords.size()) / 4;
    if (most < 6 || static_cast<double>(most) < share + 4 * std::sqrt(share)) break;
    std::erase_if(chords,
                  [&](const Vector3& d) { return (d - best).squaredNorm() >= half * half; });
    Vector3 mean = Vector3::Zero();
    for (const Vector3& d : chords) mean += d;
    sharp = {mean.normalized(), half, static_cast<Index>(chords.size()), per_area * half * half};
  }
  return sharp;
}

namespace {

constexpr Index tried = 180;  // directions on the half sphere, 12 degrees apart
constexpr Index screened_size = 1000;
constexpr double apart = 0.12;  // radians between candidates
constexpr double first_step = 0.09, last_step = 0.04;
constexpr double pi = std::numbers::pi;

bool better(const DirectionCandidate& a, const DirectionCandidate& b) {
  return a.support > b.support;
}

std::vector<DirectionCandidate> distinct(std::vector<DirectionCandidate> candidates, Index count) {
  std::stable_sort(candidates.begin(), candidates.end(), better);
  std::vector<DirectionCandidate> kept;
  for (const DirectionCandidate& c : candidates) {
    const bool seen = std::any_of(kept.begin(), kept.end(), [&](const DirectionCandidate& other) {
      return c.direction.cross(other.direction).norm() < apart;
    });
    if (!seen) kept.push_back(c);
    if (static_cast<Index>(kept.size()) == count) break;
  }
  return kept;
}

void maximise_measure(MidSurface& surface, DirectionCandidate& candidate, const Context& context) {
  for (double step = first_step; step >= last_step; step /= 2) {
    const auto across = orthogonal_to(candidate.direction);
    const Vector3 centre = candidate.direction;
    for (int k = 0; k < 6; ++k) {
      context.check();
      const double angle = k * pi / 3;
      const Vector3 moved =
          centre + step * across * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const DirectionCandidate next{moved.normalized(), surface.support(moved.normalized())};
      if (better(next, candidate)) candidate = next;
    }
  }
}

// The i-th of `count` directions spread evenly over the half sphere: a Fibonacci spiral.
Vector3 spread_direction(Index i, Index count) {
  const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  const double angle = static_cast<double>(i) * pi * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

std::vector<DirectionCandidate> supported_directions(const SurfacePoints& cloud,
                                                     const std::vector<ChordPeak>& hints,
                                                     Index count, const Context& context) {
  const SurfacePoints coarse(cloud.points, screened_size, context.stage(0, 0));
  std::vector<DirectionCandidate> candidates;
  for (Index i = 0; i < tried; ++i) candidates.push_back({spread_direction(i, tried)});
  for (const ChordPeak& hint : hints) candidates.push_back({hint.direction});
  for (DirectionCandidate& c : candidates) {
    context.check();
    c.support = MidSurface::support_bound(coarse, c.direction);
  }
  std::stable_sort(candidates.begin(), candidates.end(), better);

  MidSurface screen(coarse, context);
  std::vector<double> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    context.report(0.8 * static_cast<double>(i) / static_cast<double>(candidates.size()));
    std::sort(best.begin(), best.end(), std::greater<>());
    if (static_cast<Index>(best.size()) > count && candidates[i].support < best[count]) {
      candidates.resize(i);
      break;
    }
    candidates[i].support = screen.support(candidates[i].direction);
    best.push_back(candidates[i].support);
  }
  candidates = distinct(std::move(candidates), count);
  MidSurface surface(cloud, context);
  for (DirectionCandidate& candidate : candidates) {
    candidate.support = surface.support(candidate.direction);
    maximise_measure(surface, candidate, context);
  }
  return distinct(std::move(candidates), count);
}

}  // namespace symsurf
