#pragma once

#include <array>
#include <vector>

#include "recurring/feature_lines.h"

namespace symsurf {

/// Edges from one corner to the next, or around to their beginning, with the nodes between them.
struct LineChain {
  std::vector<Index> nodes, edges;
};

/// All edges in chains. `ends`: the nodes of each edge, -1 both where it is none. `at`: the edges
/// at each node, two where it is no corner. `corner`: of each node its number, -1: none.
std::vector<LineChain> line_chains(const std::vector<std::array<Index, 2>>& ends,
                                   const std::vector<std::vector<Index>>& at,
                                   const std::vector<Index>& corner);

/// Sets a line's length, and its samples along the nodes. Returns the number of the node at the end
/// of the edge with the line's middle.
std::size_t sample_along(const std::vector<Vector3>& nodes, FeatureLine& line);

/// Of each corner the lines at it.
void connect(FeatureLines& graph);

}  // namespace symsurf
