#include "recurring/line_chains.h"

namespace symsurf {

std::vector<LineChain> line_chains(const std::vector<std::array<Index, 2>>& ends,
                                   const std::vector<std::vector<Index>>& at,
                                   const std::vector<Index>& corner) {
  std::vector<LineChain> chains;
  std::vector<char> used(ends.size(), 0);
  const auto follow = [&](Index start, Index edge) {
    LineChain chain{{start}, {}};
    for (;;) {
      used[edge] = 1;
      chain.edges.push_back(edge);
      const Index node = ends[edge][ends[edge][0] == chain.nodes.back() ? 1 : 0];
      chain.nodes.push_back(node);
      if (corner[node] >= 0 || node == start) break;
      edge = at[node][at[node][0] == edge ? 1 : 0];
    }
    chains.push_back(std::move(chain));
  };
  for (std::size_t node = 0; node < at.size(); ++node)
    if (corner[node] >= 0)
      for (const Index edge : at[node])
        if (!used[edge]) follow(static_cast<Index>(node), edge);
  for (std::size_t edge = 0; edge < ends.size(); ++edge)
    if (!used[edge] && ends[edge][0] >= 0) follow(ends[edge][0], static_cast<Index>(edge));
  return chains;
}

std::size_t sample_along(const std::vector<Vector3>& nodes, FeatureLine& line) {
  std::vector<double> reached{0};
  for (std::size_t k = 1; k < nodes.size(); ++k)
    reached.push_back(reached.back() + (nodes[k] - nodes[k - 1]).norm());
  line.length = reached.back();
  std::size_t k = 1, middle = 1;
  for (int step = 0; step < FeatureLine::steps; ++step) {
    const double at = line.length * step / FeatureLine::steps;
    while (k + 1 < nodes.size() && reached[k] < at) ++k;
    const double edge = reached[k] - reached[k - 1];
    const double share = edge > 0 ? (at - reached[k - 1]) / edge : 0;
    line.samples[step] = (1 - share) * nodes[k - 1] + share * nodes[k];
    if (step == FeatureLine::steps / 2) middle = k;
  }
  return middle;
}

void connect(FeatureLines& graph) {
  graph.at.assign(graph.corners.size(), {});
  for (std::size_t number = 0; number < graph.lines.size(); ++number) {
    const FeatureLine& line = graph.lines[number];
    if (!line.has_ends()) continue;
    graph.at[line.start].push_back(static_cast<Index>(number));
    if (line.end != line.start) graph.at[line.end].push_back(static_cast<Index>(number));
  }
}

}  // namespace symsurf
