#include "search/plane_candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/math.h"

namespace symsurf {

namespace {

constexpr double shortest_chord = 0.04;
constexpr double facing_cosine = 0.88;                           // 28 degrees
constexpr Index glance = 8, first_look = 24, second_look = 100;  // surfels a candidate is tried on
constexpr double search_tolerance = 0.015;
constexpr double least_explained = 0.1;
constexpr double many = 1000;  // surfels; see Search
constexpr double blind = 0.6;  // of a pair with normals: more are tried where there are none

// The mean of similar planes, each weighted by what it explains: Hruda et al. add the vectors
// (a, b, c, d) of two planes, or subtract them where their normals point apart.
struct Average {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double weight = 0;

  void add(const UnitPlane& plane, double support) {
    const double sign = plane.normal.dot(sum.head<3>()) < 0 ? -1 : 1;
    sum.head<3>() += sign * support * plane.normal;
    sum[3] += sign * support * plane.offset;
    weight += support;
  }
  UnitPlane plane() const {
    const double length = sum.head<3>().norm();
    return {sum.head<3>() / length, sum[3] / length};
  }
};

// Planes with normals within about 10 degrees and offsets within a 25th of the size share a bin.
std::int32_t bin(const UnitPlane& plane) {
  constexpr double normal_bins = 6, offset_bins = 25;
  int axis;
  plane.normal.cwiseAbs().maxCoeff(&axis);
  const double major = plane.normal[axis];
  const auto cell = [](double value, double scale) {
    return static_cast<std::int32_t>(std::lround(value * scale));
  };
  const std::int32_t u = cell(plane.normal[(axis + 1) % 3] / major, normal_bins) + 8;
  const std::int32_t v = cell(plane.normal[(axis + 2) % 3] / major, normal_bins) + 8;
  const std::int32_t w = cell(plane.offset / major * std::abs(major), offset_bins) + 64;
  return ((axis * 16 + u) * 16 + v) * 128 + w;
}

// Thins pairs evenly and each by itself, so that one pair more or less changes no other's lot.
std::uint32_t ticket(Index i, Index j) {
  const std::uint32_t mixed =
      static_cast<std::uint32_t>(i) * 2654435761u ^ static_cast<std::uint32_t>(j) * 2246822519u;
  return mixed ^ mixed >> 15;
}

UnitPlane plane_between(const Vector3& a, const Vector3& b) {
  const Vector3 normal = (b - a).normalized();
  return {normal, -normal.dot(a + b) / 2};
}

void keep_best(std::vector<PlaneCandidate>& candidates, double count) {
  if (static_cast<double>(candidates.size()) <= count) return;
  sort_best_first(candidates);
  candidates.resize(static_cast<std::size_t>(count));
}

}  // namespace

std::vector<PlaneCandidate> candidate_planes(const Surfels& surfels, const SurfelMap& map,
                                             const Search& search, Index count) {
  const Index step = std::max<Index>(1, surfels.size() / search.seeds);
  const Index glancing = std::max<Index>(1, surfels.size() / glance);
  const Index coarse = std::max<Index>(1, surfels.size() / first_look);
  struct Pair {
    std::uint32_t ticket;
    std::int32_t i, j;
  };
  std::vector<Pair> pairs;
  double informative = 0;
  for (Index i = 0; i < surfels.size(); i += step)
    for (Index j = i + step; j < surfels.size(); j += step) {
      const Surfel &a = surfels[i], &b = surfels[j];
      const Vector3 chord = b.position - a.position;
      const double squared = chord.squaredNorm();
      if (squared < shortest_chord * shortest_chord) continue;
      const bool surfaces = a.flatness * b.flatness > 0.25;
      const double cosine =
          a.normal.dot(b.normal) - 2 * chord.dot(a.normal) * chord.dot(b.normal) / squared;
      if (surfaces && std::abs(cosine) < facing_cosine) continue;
      informative += surfaces ? 1 : blind;
      pairs.push_back({ticket(i, j), static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
    }

  std::vector<PlaneCandidate> found;
  const double sparser = std::max(1.0, many / static_cast<double>(surfels.size()));
  const double last_ticket =
      sparser * search.pairs / informative * std::numeric_limits<std::uint32_t>::max();
  for (const auto& [ticket, i, j] : pairs) {
    if (ticket > last_ticket) continue;
    const UnitPlane plane = plane_between(surfels[i].position, surfels[j].position);
    const double support =
        support_share(surfels, map, plane, search_tolerance, glancing, contradiction);
    if (support > least_explained) found.push_back({plane, support});
  }
  keep_best(found, sparser * search.promising);

  std::map<std::int32_t, Average> bins;
  for (const auto& [plane, glanced, partnered] : found) {
    const double support =
        support_share(surfels, map, plane, search_tolerance, coarse, contradiction);
    if (support > least_explained) bins[bin(plane)].add(plane, support);
  }
  found.clear();
  for (const auto& [key, average] : bins) found.push_back({average.plane(), average.weight});
  keep_best(found, sparser * search.averages);
  const Index fine = std::max<Index>(1, surfels.size() / second_look);
  for (PlaneCandidate& candidate : found)
    candidate.support =
        support_share(surfels, map, candidate.shape, search_tolerance, fine, contradiction);
  suppress_non_maxima(found, 0.08, count);
  return found;
}

void suppress_non_maxima(std::vector<PlaneCandidate>& candidates, double distance, Index count) {
  // The corners of a tetrahedron as wide as the cloud.
  static const std::vector<Vector3> probes{Vector3(0.2, 0.2, 0.2), Vector3(0.2, -0.2, -0.2),
                                           Vector3(-0.2, 0.2, -0.2), Vector3(-0.2, -0.2, 0.2)};
  suppress_non_maxima(probes, candidates, distance, count);
}

}  // namespace symsurf
