#pragma once

#include <symsurf/mirrors.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "random_cloud.h"

namespace symsurf {

inline constexpr int meridians = 48, parallels = 31;

struct Ball {
  Points points;
  Triangles faces;
  std::vector<Index> partner;  // of each vertex, over x = 0
};

// A closed bumpy ball whose vertices mirror each other over x = 0 to the last bit; which diagonals
// divide its quadrangles is drawn, on both sides apart.
inline Ball ball(std::uint64_t seed) {
  RandomCloud random(seed);
  Ball b{Points(meridians * parallels + 2, 3), {}, std::vector<Index>(meridians * parallels + 2)};
  const auto at = [](int ring, int k) { return Index{ring} * meridians + k % meridians; };
  for (int ring = 0; ring < parallels; ++ring)
    for (int k = 0; k < meridians; ++k) {
      const int other = (meridians / 2 - 1 - k + meridians) % meridians;
      b.partner[at(ring, k)] = at(ring, other);
      if (at(ring, other) < at(ring, k)) {
        b.points.row(at(ring, k)) = b.points.row(at(ring, other)) * Vector3(-1, 1, 1).asDiagonal();
        continue;
      }
      const double angle = 2 * std::numbers::pi * (k + 0.5) / meridians;
      const double height = std::numbers::pi * (ring + 1) / (parallels + 1);
      const Vector3 u(std::sin(height) * std::cos(angle), std::sin(height) * std::sin(angle),
                      std::cos(height));
      b.points.row(at(ring, k)) =
          ((1 + 0.1 * std::sin(3 * u.y() + 1) + 0.1 * u.z() * u.x() * u.x()) * u).transpose();
    }
  const Index north = meridians * parallels, south = north + 1;
  b.points.row(north) << 0, 0, 1;
  b.points.row(south) << 0, 0, -1;
  b.partner[north] = north;
  b.partner[south] = south;
  std::vector<std::array<Index, 3>> faces;
  for (int k = 0; k < meridians; ++k) {
    faces.push_back({north, at(0, k), at(0, k + 1)});
    faces.push_back({south, at(parallels - 1, k + 1), at(parallels - 1, k)});
    for (int ring = 0; ring + 1 < parallels; ++ring) {
      const Index a = at(ring, k), c = at(ring + 1, k), d = at(ring + 1, k + 1),
                  e = at(ring, k + 1);
      if (random.below(2)) {
        faces.push_back({a, c, d});
        faces.push_back({a, d, e});
      } else {
        faces.push_back({a, c, e});
        faces.push_back({c, d, e});
      }
    }
  }
  b.faces.resize(static_cast<Index>(faces.size()), 3);
  for (Index f = 0; f < b.faces.rows(); ++f)
    b.faces.row(f) << faces[f][0], faces[f][1], faces[f][2];
  return b;
}

inline const Plane middle(Vector3::UnitX(), 0);
inline const Cylinder round_mirror(Vector3(-3, 0, 0), Vector3::UnitY(), 3);

// Wraps x = 0 around round_mirror, as straighten unwraps it.
inline Points wrapped(const Points& points) {
  Points bent = points;
  for (Index i = 0; i < points.rows(); ++i) {
    const double r = 3 + points(i, 0), angle = points(i, 2) / 3;
    bent.row(i) << r * std::cos(angle) - 3, points(i, 1), r * std::sin(angle);
  }
  return bent;
}

// A bump on the positive side, as high as `height` where it is highest.
inline Points bumped(const Points& points, double height, Eigen::VectorXd& raised) {
  const Vector3 top = Vector3(1, 0.5, 0.3).normalized();
  Points out = points;
  raised = Eigen::VectorXd::Zero(points.rows());
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 x = points.row(i).transpose(), u = x.normalized();
    const double off = (u - top).squaredNorm() / 0.3;
    if (off >= 1) continue;
    raised[i] = height * (1 - off) * (1 - off);
    out.row(i) += raised[i] * u.transpose();
  }
  return out;
}

// The half at x > 0 of a bumpy ball with open rims, and its image behind it, whose faces keep their
// winding.
inline Ball mirrored_without_turning(std::uint64_t seed) {
  const Ball whole = ball(seed);
  std::vector<Index> number(whole.points.rows(), -1), used;
  std::vector<std::array<Index, 3>> half;
  for (const auto& face : whole.faces.rowwise()) {
    bool is_ahead = true;
    for (const Index i : face) is_ahead = is_ahead && whole.points(i, 0) > 0;
    if (!is_ahead) continue;
    std::array<Index, 3>& corners = half.emplace_back();
    for (int c = 0; c < 3; ++c) {
      if (number[face[c]] < 0) {
        number[face[c]] = static_cast<Index>(used.size());
        used.push_back(face[c]);
      }
      corners[c] = number[face[c]];
    }
  }
  const auto count = static_cast<Index>(used.size()), faces = static_cast<Index>(half.size());
  Ball both{Points(2 * count, 3), Triangles(2 * faces, 3), {}};
  both.points << whole.points(used, Eigen::indexing::all),
      whole.points(used, Eigen::indexing::all) * Vector3(-1, 1, 1).asDiagonal();
  for (Index f = 0; f < faces; ++f) {
    both.faces.row(f) << half[f][0], half[f][1], half[f][2];
    both.faces.row(faces + f) = both.faces.row(f).array() + count;
  }
  for (Index i = 0; i < 2 * count; ++i) both.partner.push_back((i + count) % (2 * count));
  return both;
}

}  // namespace symsurf
