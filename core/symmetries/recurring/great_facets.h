#pragma once

#include <symsurf/context.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "recurring/facets.h"

namespace symsurf {

/// Great facets take pieces of lesser ones, or of none, that lie in their planes and go on from
/// theirs. What has lost much is taken apart. `facet`: of each piece the number of its facet, -1:
/// none. Pieces has
///   SurfaceMoments moments(Index piece) const,
///   bool is_in(const FacetPlane&, Index piece) const,
///   void for_each_next(Index piece, visit) const, which calls visit(next).
template <typename Pieces>
std::vector<Index> great_facets(const Pieces& pieces, std::vector<Index> facet,
                                const Context& context) {
  const std::vector<std::vector<Index>> members = members_of(facet);
  std::vector<double> area(members.size(), 0);
  for (std::size_t own = 0; own < members.size(); ++own)
    for (const Index piece : members[own]) area[own] += pieces.moments(piece).area;
  std::vector<Index> order(members.size()), rank(members.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return area[a] > area[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<Index>(k);
  for (const Index own : order) {
    std::vector<Index> open;
    SurfaceMoments held;
    for (const Index piece : members[own])
      if (facet[piece] == own) {
        open.push_back(piece);
        held += pieces.moments(piece);
      }
    if (held.area < least_left * area[own] || !(held.area > 0)) {
      for (const Index piece : open) facet[piece] = -1;
      continue;
    }
    FacetPlane plane = plane_of(held);
    double fitted = held.area;
    constexpr std::size_t stretch = 4096;  // pieces between questions whether to go on
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (k % stretch == 0) context.check();
      pieces.for_each_next(open[k], [&](Index next) {
        if (facet[next] == own || (facet[next] >= 0 && rank[facet[next]] < rank[own]) ||
            !pieces.is_in(plane, next))
          return;
        facet[next] = own;
        open.push_back(next);
        held += pieces.moments(next);
        if (held.area > refitted * fitted) {
          plane = plane_of(held);
          fitted = held.area;
        }
      });
    }
  }
  return facet;
}

}  // namespace symsurf
