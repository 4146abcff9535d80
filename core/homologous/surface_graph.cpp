#include "surface_graph.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>

namespace symsurf {

namespace {

using Corner = std::array<std::int32_t, 3>;  // from, to, and the third vertex of a face

}  // namespace

SurfaceGraph::SurfaceGraph(PointsView points, TrianglesView faces)
    : begin_(points.size() + 1, 0), is_boundary_(points.size(), false) {
  std::vector<Corner> edges;  // both ways
  edges.reserve(6 * faces.size());
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::int32_t>(faces[f][c]);
      const auto b = static_cast<std::int32_t>(faces[f][(c + 1) % 3]);
      const auto third = static_cast<std::int32_t>(faces[f][(c + 2) % 3]);
      if (a == b) continue;
      edges.push_back({a, b, third});
      edges.push_back({b, a, third});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0, next = 0; k < edges.size(); k = next) {
    const auto [a, b, third] = edges[k];
    while (next < edges.size() && edges[next][0] == a && edges[next][1] == b) ++next;
    neighbour_.push_back(b);
    length_.push_back((points[a] - points[b]).norm());
    thirds_.push_back({next - k > 2 ? -1 : third, next - k == 2 ? edges[k + 1][2] : -1});
    ++begin_[a + 1];
    if (next - k == 1) is_boundary_[a] = is_boundary_[b] = true;
  }
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
}

std::array<std::int32_t, 2> SurfaceGraph::thirds(Index one, Index other) const {
  const auto begin = neighbour_.begin() + begin_[one], end = neighbour_.begin() + begin_[one + 1];
  const auto found = std::lower_bound(begin, end, static_cast<std::int32_t>(other));
  if (found == end || *found != other) return {-1, -1};
  return thirds_[found - neighbour_.begin()];
}

bool SurfaceGraph::are_neighbours(Index one, Index other) const {
  const auto around = neighbours(one);
  return std::binary_search(around.begin(), around.end(), static_cast<std::int32_t>(other));
}

std::vector<NearSource> nearest_sources(const SurfaceGraph& graph,
                                        const std::vector<Index>& sources, int k,
                                        const Context& context) {
  using Step = std::tuple<double, std::int32_t, std::int32_t>;  // distance, vertex, source
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  for (std::size_t s = 0; s < sources.size(); ++s)
    steps.push({0, static_cast<std::int32_t>(sources[s]), static_cast<std::int32_t>(s)});
  std::vector<NearSource> found(graph.vertices() * k);
  std::vector<int> count(graph.vertices(), 0);
  const auto has = [&](Index vertex, std::int32_t source) {
    const auto begin = found.begin() + vertex * k;
    return std::any_of(begin, begin + count[vertex],
                       [&](const NearSource& near) { return near.source == source; });
  };
  for (Index taken = 0; !steps.empty(); ++taken) {
    if (taken % 4096 == 0) context.check();
    const auto [distance, vertex, source] = steps.top();
    steps.pop();
    if (count[vertex] == k || has(vertex, source)) continue;
    found[vertex * k + count[vertex]++] = {source, distance};
    const auto around = graph.neighbours(vertex);
    for (std::size_t e = 0; e < around.size(); ++e)
      if (count[around[e]] < k && !has(around[e], source))
        steps.push({distance + graph.lengths(vertex)[e], around[e], source});
  }
  return found;
}

}  // namespace symsurf
