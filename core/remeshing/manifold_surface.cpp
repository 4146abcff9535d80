#include "manifold_surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"

namespace symsurf {

namespace {

using Corners = std::array<Index, 3>;

// Each once, from its lowest corner on, in ascending order.
std::vector<Corners> distinct_faces(TrianglesView faces, const DistinctPoints& distinct) {
  std::map<Corners, Corners> kept;  // by sorted corners: the first of either winding
  for (Index f = 0; f < faces.size(); ++f) {
    Corners face;
    for (int k = 0; k < 3; ++k) face[k] = distinct.first[distinct.number[faces[f][k]]];
    if (is_degenerate(face.data())) continue;
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    Corners sorted = face;
    std::sort(sorted.begin(), sorted.end());
    const auto [found, is_new] = kept.try_emplace(sorted, face);
    if (!is_new) found->second = std::min(found->second, face);
  }
  std::vector<Corners> all;
  for (const auto& [sorted, face] : kept) all.push_back(face);
  return all;
}

}  // namespace

ManifoldSurface manifold_surface(PointsView points, TrianglesView faces, const Context& context) {
  const std::vector<Corners> kept = distinct_faces(faces, distinct_points(points, context));
  const auto count = static_cast<Index>(kept.size());
  // An edge of a face is 3 f + k: from its corner k to the next.
  const auto from = [&](Index edge) { return kept[edge / 3][edge % 3]; };
  const auto end = [](Index edge) { return edge / 3 * 3 + (edge % 3 + 1) % 3; };
  std::map<std::pair<Index, Index>, std::vector<Index>> edges;
  for (Index e = 0; e < 3 * count; ++e) edges[std::minmax(from(e), from(end(e)))].push_back(e);
  std::vector<Index> across(3 * count, -1);  // the same edge of the one other face that has it
  for (const auto& [ends, sides] : edges)
    if (sides.size() == 2) {
      across[sides[0]] = sides[1];
      across[sides[1]] = sides[0];
    }
  const auto run_apart = [&](Index e) { return from(e) != from(across[e]); };

  std::vector<int> winding(count, 0);  // 1: as given, -1: the other way
  for (Index start = 0; start < count; ++start) {
    if (winding[start] != 0) continue;
    std::vector<Index> part{start};
    winding[start] = 1;
    int balance = 0;
    for (std::size_t n = 0; n < part.size(); ++n) {
      if (n % 4096 == 0) context.check();
      balance += winding[part[n]];
      for (Index e = 3 * part[n]; e < 3 * part[n] + 3; ++e) {
        const Index other = across[e] / 3;
        if (across[e] < 0 || winding[other] != 0) continue;
        winding[other] = run_apart(e) ? winding[part[n]] : -winding[part[n]];
        part.push_back(other);
      }
    }
    for (const Index f : part) winding[f] = balance < 0 ? -winding[f] : winding[f];
  }

  // Corners on both sides of an edge are one vertex: those of a fan of faces.
  DisjointSets corners(3 * count);
  for (Index e = 0; e < 3 * count; ++e) {
    const Index other = across[e];
    if (other < 0 || run_apart(e) != (winding[e / 3] == winding[other / 3])) continue;
    corners.join(e, run_apart(e) ? end(other) : other);
    corners.join(end(e), run_apart(e) ? other : end(other));
  }
  const std::vector<Index> number = corners.numbered();
  const Index vertices = number.empty() ? 0 : 1 + *std::max_element(number.begin(), number.end());
  ManifoldSurface made{Points(vertices, 3), Triangles(count, 3)};
  for (Index e = 0; e < 3 * count; ++e) {
    made.points.row(number[e]) = points[from(e)].transpose();
    made.faces(e / 3, winding[e / 3] > 0 ? e % 3 : 2 - e % 3) = number[e];
  }
  return made;
}

}  // namespace symsurf
