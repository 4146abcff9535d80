#include "homologous_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/laplacian.h"

namespace symsurf {

namespace {

// The diagonal of a body's box, over the root mean square distance from its centroid, is about
// this; and that distance is the same in any pose.
constexpr double box_of_radii = 3.2;

// Each triangle once, between distinct points that have images.
Triangles usable(const Triangles& triangles, const Points& images) {
  std::vector<std::array<Index, 4>> known;  // sorted corners, number
  for (Index t = 0; t < triangles.rows(); ++t) {
    std::array<Index, 3> corner{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    if (!std::all_of(corner.begin(), corner.end(),
                     [&](Index i) { return images.row(i).allFinite(); }))
      continue;
    std::sort(corner.begin(), corner.end());
    known.push_back({corner[0], corner[1], corner[2], t});
  }
  std::sort(known.begin(), known.end());
  std::vector<Index> kept;
  for (std::size_t k = 0; k < known.size(); ++k)
    if (k == 0 || !std::equal(known[k].begin(), known[k].begin() + 3, known[k - 1].begin()))
      kept.push_back(known[k][3]);
  std::sort(kept.begin(), kept.end());
  return triangles(kept, Eigen::indexing::all);
}

HomologousPoints pairs_of(PointsView points, TrianglesView faces, PointsView images,
                          bool is_registered, const Context& context) {
  const DistinctPoints distinct = distinct_points(points, context.stage(0, 0.05));
  const Eigen::RowVector3d origin = points.matrix().colwise().mean();
  const double unit = box_of_radii * std::sqrt((points.matrix().rowwise() - origin).squaredNorm() /
                                               static_cast<double>(points.size()));
  const auto normalised = [&](PointsView all) -> Points {
    return (all.matrix()(distinct.first, Eigen::indexing::all).rowwise() - origin) / unit;
  };
  HomologousPoints found{Points::Zero(points.size(), 3), std::vector<Index>(points.size(), -1)};
  if (!(unit > 0)) return found;
  const Points positions = normalised(points), mirrored = normalised(images);
  Triangles triangles(faces.size(), 3);
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) triangles(f, c) = distinct.number[faces[f][c]];
  if (faces.empty() && is_registered)
    triangles = cloud_laplacian(positions, context.stage(0.05, 0.2)).triangles;
  triangles = usable(triangles, mirrored);
  if (triangles.rows() == 0) return found;
  const SurfaceGraph graph(positions, triangles);
  const Points moved = is_registered ? registered_displacements(positions, mirrored, triangles,
                                                                graph, context.stage(0.2, 0.9))
                                     : Points::Zero(positions.rows(), 3);
  std::vector<Index> table;
  if (!faces.empty())
    table = vertex_table(positions, mirrored, graph, moved, context.stage(0.9, 1));
  found.displacements = unit * moved(distinct.number, Eigen::indexing::all);
  for (Index i = 0; i < points.size() && !table.empty(); ++i)
    if (const Index partner = table[distinct.number[i]]; partner >= 0)
      found.partners[i] = distinct.first[partner];
  return found;
}

}  // namespace

HomologousPoints homologous_points(PointsView points, TrianglesView faces, PointsView images,
                                   const Context& context) {
  return pairs_of(points, faces, images, true, context);
}

HomologousPoints vertex_pairs(PointsView points, TrianglesView faces, PointsView images,
                              const Context& context) {
  return pairs_of(points, faces, images, false, context);
}

}  // namespace symsurf
