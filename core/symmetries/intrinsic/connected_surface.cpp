#include <symsurf/context.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/laplacian.h"
#include "cloud/point_tree.h"
#include "intrinsic/intrinsic_symmetry.h"

namespace symsurf {

namespace {

Triangles renamed(TrianglesView faces, const std::vector<std::int32_t>& names) {
  Triangles triangles(faces.size(), 3);
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) triangles(f, c) = names[faces[f][c]];
  return triangles;
}

// Of each vertex the number of its part, in the order of their first vertices; -1 of those with no
// area, which nothing goes through.
std::vector<Index> numbered_parts(const Laplacian& surface) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  const double least_area = rounding * surface.areas.sum();
  const Eigen::SparseMatrix<double>& graph = surface.stiffness;
  std::vector<Index> parts(graph.cols(), -1), open;
  Index count = 0;
  for (Index start = 0; start < graph.cols(); ++start) {
    if (parts[start] >= 0 || !(surface.areas[start] > least_area)) continue;
    parts[start] = count;
    open.push_back(start);
    while (!open.empty()) {
      const Index vertex = open.back();
      open.pop_back();
      for (Eigen::SparseMatrix<double>::InnerIterator next(graph, vertex); next; ++next)
        if (parts[next.row()] < 0 && surface.areas[next.row()] > least_area) {
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

// Joins parts that all but touch, as wings modelled apart from their fuselage do, and what gaps
// of a cloud part: each vertex to the nearest one of another part within so many of the mean
// lengths of its edges.
void join_touching_parts(const Points& points, double reach, Laplacian& surface,
                         const Context& context) {
  constexpr double weight = 1;  // cotangents of even triangles give 0.58 to an edge
  const std::vector<Index> part_of = numbered_parts(surface);
  const PointTree tree(points, context);
  std::vector<Eigen::Triplet<double>> links;
  for (Index v = 0; v < points.rows(); ++v) {
    Neighbour nearest;
    tree.within(points.row(v), reach * mean_edge(points, surface.stiffness, v),
                [&](Index other, double squared) {
                  if (part_of[other] >= 0 && part_of[other] != part_of[v])
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
  const DistinctPoints distinct = distinct_points(points, context);
  const Points positions = points.matrix()(distinct.first, Eigen::indexing::all);
  constexpr double of_mesh = 1, of_cloud = 4;  // edges
  Laplacian whole = faces.empty() ? cloud_laplacian(positions, context)
                                  : cotangent_laplacian(positions, renamed(faces, distinct.number));
  join_touching_parts(positions, faces.empty() ? of_cloud : of_mesh, whole, context);

  const std::vector<Index> part_of = numbered_parts(whole);
  ConnectedSurface surface;
  std::vector<double> areas;
  for (Index v = 0; v < positions.rows(); ++v) {
    if (part_of[v] < 0) continue;
    areas.resize(std::max<std::size_t>(areas.size(), part_of[v] + 1), 0);
    areas[part_of[v]] += whole.areas[v];
  }
  if (areas.empty()) throw InvalidInput("the surface has no area");
  const auto largest = std::max_element(areas.begin(), areas.end());
  surface.parts = static_cast<Index>(areas.size());
  surface.share = *largest / whole.areas.sum();

  std::vector<Index> kept, name(positions.rows(), -1);
  for (Index v = 0; v < positions.rows(); ++v)
    if (part_of[v] == largest - areas.begin()) {
      name[v] = static_cast<Index>(kept.size());
      kept.push_back(v);
    }
  surface.points = positions(kept, Eigen::indexing::all);
  surface.laplacian.areas = whole.areas(kept) / *largest;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Index v : kept)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(whole.stiffness, v); entry; ++entry)
      if (name[entry.row()] >= 0) entries.emplace_back(name[entry.row()], name[v], entry.value());
  const auto size = static_cast<Index>(kept.size());
  surface.laplacian.stiffness.resize(size, size);
  surface.laplacian.stiffness.setFromTriplets(entries.begin(), entries.end());
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

SurfaceBasis surface_basis(const ConnectedSurface& surface, Index count, const Context& context) {
  constexpr double shift = -1e-2;  // a body ten times as long as wide has a first value of 1
  const auto& [stiffness, areas] = surface.laplacian;
  const auto [values, vectors] =
      least_eigenpairs(stiffness, areas, std::min(count + 1, stiffness.rows()), shift, context);
  const Index found = std::max<Index>(values.size() - 1, 0);
  return {values.tail(found), vectors.rightCols(found)};
}

void part_contacts(const SurfaceBasis& basis, ConnectedSurface& surface) {
  // Weighed as the global point signature does (Rustamov 2007), functions of a surface rise about
  // as steeply anywhere.
  constexpr double steep = 2.5;  // medians
  struct Link {
    double rise;
    Index from, to;
    auto operator<=>(const Link&) const = default;
  };
  const Eigen::MatrixXd signature =
      basis.functions * basis.values.cwiseSqrt().cwiseInverse().asDiagonal();
  const auto rise = [&](Index i, Index j) {
    return (signature.row(i) - signature.row(j)).norm() /
           (surface.points.row(i) - surface.points.row(j)).norm();
  };
  Eigen::SparseMatrix<double>& graph = surface.laplacian.stiffness;
  std::vector<Link> links;
  for (Index v = 0; v < graph.cols(); ++v)
    for (Eigen::SparseMatrix<double>::InnerIterator next(graph, v); next; ++next)
      if (next.row() < v) links.push_back({rise(next.row(), v), next.row(), v});
  if (links.empty()) return;
  std::sort(links.begin(), links.end());
  const double most = steep * links[links.size() / 2].rise;
  DisjointSets sets(graph.cols());
  std::set<std::pair<Index, Index>> removed;
  for (const Link& link : links) {
    if (sets.root(link.from) != sets.root(link.to))
      sets.join(link.from, link.to);
    else if (link.rise > most)
      removed.emplace(link.from, link.to);
  }
  graph.prune([&](Index i, Index j, double) {
    return !removed.contains({std::min(i, j), std::max(i, j)});
  });
}

SampledPoints surface_samples(const ConnectedSurface& surface, Index count,
                              const Context& context) {
  SampledPoints samples;
  const Index size = surface.points.rows();
  count = std::min(count, size);
  samples.to_all.resize(size, count);
  Eigen::VectorXd nearest = edge_distances(surface, 0);
  for (Index k = 0; k < count; ++k) {
    context.report(static_cast<double>(k) / static_cast<double>(count));
    Index farthest;
    nearest.maxCoeff(&farthest);
    samples.to_all.col(k) = edge_distances(surface, farthest);
    nearest = k == 0 ? samples.to_all.col(k).eval()
                     : Eigen::VectorXd(nearest.cwiseMin(samples.to_all.col(k)));
    samples.vertices.push_back(farthest);
  }
  samples.longest = samples.to_all(samples.vertices, Eigen::indexing::all).maxCoeff();
  samples.to_all /= samples.longest;
  samples.distances = samples.to_all(samples.vertices, Eigen::indexing::all);
  samples.weights = Eigen::VectorXd::Zero(count);
  samples.nearest.resize(size);
  for (Index v = 0; v < size; ++v) {
    samples.to_all.row(v).minCoeff(&samples.nearest[v]);
    samples.weights[samples.nearest[v]] += surface.laplacian.areas[v];
  }
  return samples;
}

}  // namespace symsurf
