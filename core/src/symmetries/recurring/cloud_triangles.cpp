#include "symmetries/recurring/cloud_triangles.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/cloud_laplacian.h"
#include "cloud/distinct_points.h"
#include "cloud/surface_points.h"
#include "mesh/rim_triangles.h"
#include "mesh/triangle_mesh.h"

namespace symsurf {

namespace {

using Corners = std::array<Index, 3>;

// Those that more stars have first, then those with shorter sides.
std::vector<Corners> by_votes(const Points& points, const Triangles& stars) {
  struct Star {
    Corners sorted, wound;
  };
  std::vector<Star> all;
  for (Index f = 0; f < stars.rows(); ++f) {
    Corners wound{stars(f, 0), stars(f, 1), stars(f, 2)}, sorted = wound;
    std::sort(sorted.begin(), sorted.end());
    all.push_back({sorted, wound});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Star& a, const Star& b) { return a.sorted < b.sorted; });
  std::vector<std::tuple<std::ptrdiff_t, double, Corners>> ranked;
  for (auto first = all.begin(); first != all.end();) {
    const auto last = std::find_if(
        first, all.end(), [&](const Star& other) { return other.sorted != first->sorted; });
    double sides = 0;
    for (int c = 0; c < 3; ++c)
      sides += (points.row(first->wound[c]) - points.row(first->wound[(c + 1) % 3])).squaredNorm();
    ranked.emplace_back(first - last, sides, first->wound);
    first = last;
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<Corners> found;
  for (const auto& [votes, sides, corners] : ranked) found.push_back(corners);
  return found;
}

}  // namespace

CloudTriangles cloud_triangles(PointsView points, const Context& context) {
  const std::vector<std::int32_t> first = distinct_points(points, context.stage(0, 0.1)).first;
  const Points own = chosen_rows(points, first);
  const CloudLaplacian stars = cloud_laplacian(own, context.stage(0.1, 0.6));
  std::vector<Corners> corners = by_votes(own, stars.triangles);
  const Triangles ranked = rows_of(corners);
  const TriangleMesh mesh(own, ranked, context.stage(0.6, 0.8));
  const Triangles kept = mesh.manifold_faces();
  corners.clear();
  for (Index f = 0; f < kept.rows(); ++f) corners.push_back({kept(f, 0), kept(f, 1), kept(f, 2)});
  constexpr std::size_t longest = 24;  // edges of a hole between stars that disagree
  for (const std::vector<Index>& loop : TriangleMesh(own, kept).boundary_loops()) {
    if (loop.size() > longest) continue;
    context.check();
    const Triangles filling = loop_triangulation(own, loop);
    for (Index f = 0; f < filling.rows(); ++f)
      corners.push_back({filling(f, 0), filling(f, 1), filling(f, 2)});
  }
  for (Corners& face : corners)
    for (Index& corner : face) corner = first[corner];
  return {rows_of(corners), surface_spacing(own, PointTree(own))};
}

}  // namespace symsurf
