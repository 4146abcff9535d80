#include "symmetries/intrinsic/connected_surface.h"

#include <symsurf/errors.h>

#include <algorithm>
#include <array>
#include <functional>
#include <queue>
#include <utility>

#include "base/math.h"
#include "cloud/cloud_laplacian.h"
#include "mesh/triangle_mesh.h"
#include "spatial/point_tree.h"
#include "spatial/triple_index.h"

namespace symsurf {

namespace {

struct Distinct {
  std::vector<Index> first;   // of each distinct point, the first in the input
  std::vector<Index> number;  // of each point of the input
};

Distinct distinct_points(PointsView points) {
  Distinct distinct;
  TripleIndex positions;
  for (Index i = 0; i < points.size(); ++i) {
    distinct.number.push_back(positions.add(ordered_bits(points[i])));
    if (distinct.number.back() == static_cast<Index>(distinct.first.size()))
      distinct.first.push_back(i);
  }
  return distinct;
}

Triangles renamed(TrianglesView faces, const std::vector<Index>& names) {
  Triangles triangles(faces.size(), 3);
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) triangles(f, c) = names[faces[f][c]];
  return triangles;
}

// Of each vertex the number of its part, in the order of their first vertices.
std::vector<Index> numbered_parts(const Eigen::SparseMatrix<double>& graph) {
  std::vector<Index> parts(graph.cols(), -1), open;
  Index count = 0;
  for (Index start = 0; start < graph.cols(); ++start) {
    if (parts[start] >= 0) continue;
    parts[start] = count;
    open.push_back(start);
    while (!open.empty()) {
      const Index vertex = open.back();
      open.pop_back();
      for (Eigen::SparseMatrix<double>::InnerIterator next(graph, vertex); next; ++next)
        if (parts[next.row()] < 0) {
          parts[next.row()] = count;
          open.push_back(next.row());
        }
    }
    ++count;
  }
  return parts;
}

double mean_edge(const Points& points, const Eigen::SparseMatrix<double>& graph, Index vertex) {
  double sum = 0;
  Index count = 0;
  for (Eigen::SparseMatrix<double>::InnerIterator next(graph, vertex); next; ++next) {
    if (next.row() == vertex) continue;
    sum += (points.row(next.row()) - points.row(vertex)).norm();
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

// Joins parts that all but touch, as wings modelled apart from their fuselage do: each vertex to
// the nearest one of another part, if that is no farther than its edges are long in the mean.
void join_touching_parts(const Points& points, Laplacian& surface, const Context& context) {
  constexpr double weight = 1;  // cotangents of even triangles give 0.58 to an edge
  const std::vector<Index> part_of = numbered_parts(surface.stiffness);
  const PointTree tree(points, context);
  std::vector<Eigen::Triplet<double>> links;
  for (Index v = 0; v < points.rows(); ++v) {
    Neighbour nearest;
    tree.within(points.row(v), mean_edge(points, surface.stiffness, v),
                [&](Index other, double squared) {
                  if (part_of[other] != part_of[v] && surface.areas[other] > 0)
                    nearest = std::min(nearest, Neighbour{other, squared});
                });
    const Index other = nearest.index;
    if (other < 0) continue;
    for (const auto& [one, two] : {std::pair(v, other), std::pair(other, v)}) {
      links.emplace_back(one, one, weight);
      links.emplace_back(one, two, -weight);
    }
  }
  Eigen::SparseMatrix<double> joints(points.rows(), points.rows());
  joints.setFromTriplets(links.begin(), links.end());
  surface.stiffness += joints;
}

}  // namespace

ConnectedSurface connected_surface(PointsView points, TrianglesView faces, const Context& context) {
  const Distinct distinct = distinct_points(points);
  const Points positions = points.matrix()(distinct.first, Eigen::indexing::all);
  CloudLaplacian whole;
  if (faces.empty()) {
    whole = cloud_laplacian(positions, context);
  } else {
    const Triangles corners = renamed(faces, distinct.number);
    static_cast<Laplacian&>(whole) = cotangent_laplacian(positions, corners);
    join_touching_parts(positions, whole, context);
    whole.triangles = TriangleMesh(positions, corners, context).manifold_faces();
  }

  const std::vector<Index> part_of = numbered_parts(whole.stiffness);
  ConnectedSurface surface;
  std::vector<double> areas;
  for (Index v = 0; v < positions.rows(); ++v) {
    areas.resize(std::max<std::size_t>(areas.size(), part_of[v] + 1), 0);
    areas[part_of[v]] += whole.areas[v];
  }
  const auto largest = std::max_element(areas.begin(), areas.end());
  if (!(*largest > 0)) throw InvalidInput("the surface has no area");
  surface.parts = std::count_if(areas.begin(), areas.end(), [](double area) { return area > 0; });
  surface.share = *largest / whole.areas.sum();

  std::vector<Index> kept, name(positions.rows(), -1);
  for (Index v = 0; v < positions.rows(); ++v)
    if (part_of[v] == largest - areas.begin() && whole.areas[v] > 0) {
      name[v] = static_cast<Index>(kept.size());
      kept.push_back(v);
      surface.point_of.push_back(distinct.first[v]);
    }
  for (const Index v : distinct.number) surface.vertex_of.push_back(name[v]);
  surface.points = positions(kept, Eigen::indexing::all);
  surface.laplacian.areas = whole.areas(kept) / *largest;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Index v : kept)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(whole.stiffness, v); entry; ++entry)
      if (name[entry.row()] >= 0) entries.emplace_back(name[entry.row()], name[v], entry.value());
  const auto size = static_cast<Index>(kept.size());
  surface.laplacian.stiffness.resize(size, size);
  surface.laplacian.stiffness.setFromTriplets(entries.begin(), entries.end());
  std::vector<std::array<Index, 3>> triangles;
  for (Index t = 0; t < whole.triangles.rows(); ++t)
    if (name[whole.triangles(t, 0)] >= 0)
      triangles.push_back(
          {name[whole.triangles(t, 0)], name[whole.triangles(t, 1)], name[whole.triangles(t, 2)]});
  surface.triangles = rows_of(triangles);
  return surface;
}

Eigen::VectorXd edge_distances(const ConnectedSurface& surface, Index from) {
  using Step = std::pair<double, Index>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(surface.points.rows(), infinity);
  distances[from] = 0;
  steps.push({0, from});
  while (!steps.empty()) {
    const auto [distance, vertex] = steps.top();
    steps.pop();
    if (distance > distances[vertex]) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator next(surface.laplacian.stiffness, vertex); next;
         ++next) {
      const double way =
          distance + (surface.points.row(next.row()) - surface.points.row(vertex)).norm();
      if (way >= distances[next.row()]) continue;
      distances[next.row()] = way;
      steps.push({way, next.row()});
    }
  }
  return distances;
}

}  // namespace symsurf
