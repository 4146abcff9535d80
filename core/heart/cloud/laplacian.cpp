#include "cloud/laplacian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace symsurf {

namespace {

// The lengths of the edges opposite the corners.
std::array<double, 3> lengths_of(PointsView points, const Index* face) {
  std::array<double, 3> lengths;
  for (int c = 0; c < 3; ++c)
    lengths[c] = (points[face[(c + 1) % 3]] - points[face[(c + 2) % 3]]).norm();
  return lengths;
}

bool names_three_points(const Index* face) {
  return face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
}

// By how much all edges are to be longer.
double mollification(PointsView points, TrianglesView faces) {
  constexpr double least = 1e-5;  // by which two edges are longer than the third, in mean edges
  double sum = 0, worst = -INFINITY;
  Index edges = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    if (!names_three_points(faces[f])) continue;
    const auto lengths = lengths_of(points, faces[f]);
    for (int c = 0; c < 3; ++c) {
      sum += lengths[c];
      worst = std::max(worst, lengths[c] - lengths[(c + 1) % 3] - lengths[(c + 2) % 3]);
    }
    edges += 3;
  }
  return edges == 0 ? 0 : std::max(0.0, worst + least * sum / static_cast<double>(edges));
}

}  // namespace

Laplacian cotangent_laplacian(PointsView points, TrianglesView faces) {
  const double longer = mollification(points, faces);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * faces.size());
  Laplacian laplacian{{points.size(), points.size()}, Eigen::VectorXd::Zero(points.size())};
  for (Index f = 0; f < faces.size(); ++f) {
    if (!names_three_points(faces[f])) continue;
    auto [a, b, c] = lengths_of(points, faces[f]);
    const std::array<double, 3> length{a + longer, b + longer, c + longer};
    const double half = (length[0] + length[1] + length[2]) / 2;
    const double area = std::sqrt(half * (half - length[0]) * (half - length[1]) *
                                  (half - length[2]));  // Heron's formula
    if (!(area > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      const Index i = faces[f][(k + 1) % 3], j = faces[f][(k + 2) % 3];
      const double opposite = length[k], left = length[(k + 1) % 3], right = length[(k + 2) % 3];
      // Half the cotangent of the angle at corner k, by the law of cosines.
      const double weight = (left * left + right * right - opposite * opposite) / (8 * area);
      entries.emplace_back(i, j, -weight);
      entries.emplace_back(j, i, -weight);
      entries.emplace_back(i, i, weight);
      entries.emplace_back(j, j, weight);
      laplacian.areas[faces[f][k]] += area / 3;
    }
  }
  laplacian.stiffness.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

}  // namespace symsurf
