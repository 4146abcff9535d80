#include "cloud/laplacian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"

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

namespace {

using Vector2 = Eigen::Vector2d;

constexpr Index star_neighbours = 24;  // a Delaunay star has 6 on average, hardly ever over 12
constexpr Index neighbours_of_normal = 12;
constexpr Index reach_neighbour = 8;  // whose distance bounds a cell at a rim
constexpr int sides = 16;             // of the polygon that bounds it
constexpr Index chunk = 1024;         // points a task

// A side of a cell begins at a corner and is shared with the cell of a neighbour; -1: the bound.
struct Side {
  Vector2 corner;
  Index neighbour = -1;
};

// Keeps the part of a convex cell with x . normal <= offset; the cut belongs to a neighbour.
void cut(std::vector<Side>& cell, const Vector2& normal, double offset, Index neighbour) {
  std::vector<Side> kept;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const Side& side = cell[k];
    const Vector2& end = cell[(k + 1) % cell.size()].corner;
    const double from = side.corner.dot(normal) - offset, to = end.dot(normal) - offset;
    if (from <= 0) kept.push_back(side);
    if ((from <= 0) == (to <= 0)) continue;
    const Vector2 crossing = side.corner + from / (from - to) * (end - side.corner);
    kept.push_back({crossing, from <= 0 ? neighbour : side.neighbour});
  }
  cell = std::move(kept);
}

// What the cells of some points give, in the order of the points.
struct Cells {
  std::vector<std::tuple<Index, Index, double>> weights;
  std::vector<double> areas;
  std::vector<std::array<Index, 3>> triangles;  // counter-clockwise about the first one's normal
};

void add_cell(PointsView points, Index i, const Vector3& normal,
              const std::vector<Neighbour>& around, Cells& cells) {
  const Eigen::Matrix<double, 3, 2> tangents = orthogonal_to(normal);
  const auto reached = static_cast<std::size_t>(reach_neighbour);
  const double reach = std::sqrt(around[std::min(reached, around.size() - 1)].squared_distance);
  std::vector<Side> cell;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    cell.push_back({reach * Vector2(std::cos(angle), std::sin(angle))});
  }
  for (const Neighbour& neighbour : around) {
    if (neighbour.index == i) continue;
    const Vector3 way = points[neighbour.index] - points[i];
    const Vector2 across = tangents.transpose() * way;
    // Steeper than 45 degrees: another layer of the surface.
    if (2 * across.squaredNorm() < way.squaredNorm()) continue;
    // As far along the tangent plane as the neighbour is from the point.
    const Vector2 unrolled = across.normalized() * way.norm();
    cut(cell, unrolled, unrolled.squaredNorm() / 2, neighbour.index);
  }
  double area = 0;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const Side &side = cell[k], &next = cell[(k + 1) % cell.size()];
    area += (side.corner.x() * next.corner.y() - side.corner.y() * next.corner.x()) / 2;
    const Index j = side.neighbour;
    if (j < 0) continue;
    cells.weights.emplace_back(i, j,
                               (next.corner - side.corner).norm() / (points[j] - points[i]).norm());
    if (next.neighbour >= 0) cells.triangles.push_back({i, j, next.neighbour});
  }
  cells.areas.push_back(area);
}

// 1 or -1 a point: the normals of neighbours then agree, carried along the flattest ways first
// (Hoppe et al. 1992).
std::vector<int> carried_signs(const Points& normals, const Eigen::SparseMatrix<double>& graph) {
  struct Step {
    double bend;
    Index to;
    int sign;
    bool operator<(const Step& other) const {
      return std::tie(other.bend, other.to) < std::tie(bend, to);
    }
  };
  std::vector<int> signs(normals.rows(), 0);
  for (Index start = 0; start < normals.rows(); ++start) {
    if (signs[start] != 0) continue;
    std::priority_queue<Step> steps;
    steps.push({0, start, 1});
    while (!steps.empty()) {
      const Step step = steps.top();
      steps.pop();
      if (signs[step.to] != 0) continue;
      signs[step.to] = step.sign;
      for (Eigen::SparseMatrix<double>::InnerIterator next(graph, step.to); next; ++next) {
        if (signs[next.row()] != 0) continue;
        const double cosine = normals.row(step.to).dot(normals.row(next.row()));
        steps.push({1 - std::abs(cosine), next.row(), cosine < 0 ? -step.sign : step.sign});
      }
    }
  }
  return signs;
}

}  // namespace

CloudLaplacian cloud_laplacian(PointsView points, const Context& context) {
  const Index count = points.size();
  const PointTree tree(points, context.stage(0, 0.2));
  const Points normals = estimate_normals(points, tree, std::min(count, neighbours_of_normal),
                                          "pca", context.stage(0.2, 0.4));
  std::vector<Cells> chunks((count + chunk - 1) / chunk);
  parallel_for(context.stage(0.4, 0.9), count, chunk, [&](Index begin, Index end) {
    std::vector<Neighbour> around;
    for (Index i = begin; i < end; ++i) {
      tree.nearest(points[i], std::min(count, star_neighbours + 1), around);
      add_cell(points, i, normals.row(i).transpose(), around, chunks[begin / chunk]);
    }
  });
  CloudLaplacian laplacian;
  laplacian.areas.resize(count);
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::array<Index, 3>> triangles;
  Index row = 0;
  for (const Cells& cells : chunks) {
    for (const double area : cells.areas) laplacian.areas[row++] = area;
    for (const auto& [i, j, weight] : cells.weights) {
      entries.emplace_back(i, j, -weight / 2);
      entries.emplace_back(j, i, -weight / 2);
      entries.emplace_back(i, i, weight / 2);
      entries.emplace_back(j, j, weight / 2);
    }
    triangles.insert(triangles.end(), cells.triangles.begin(), cells.triangles.end());
  }
  laplacian.stiffness.resize(count, count);
  laplacian.stiffness.setFromTriplets(entries.begin(), entries.end());
  const std::vector<int> signs = carried_signs(normals, laplacian.stiffness);
  for (auto& triangle : triangles)
    if (signs[triangle[0]] < 0) std::swap(triangle[1], triangle[2]);
  laplacian.triangles = rows_of(triangles);
  return laplacian;
}

}  // namespace symsurf
