#pragma once

#include <symsurf/points.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace symsurf {

/// The vertices of a triangulated surface with the edges between them.
class SurfaceGraph {
 public:
  SurfaceGraph(Index vertices, TrianglesView faces) : begin_(vertices + 1, 0) {
    std::vector<std::array<std::int32_t, 4>> edges;  // from, to, the third vertex, left or right
    edges.reserve(6 * faces.size());
    for (Index f = 0; f < faces.size(); ++f)
      for (int c = 0; c < 3; ++c) {
        const auto a = static_cast<std::int32_t>(faces[f][c]);
        const auto b = static_cast<std::int32_t>(faces[f][(c + 1) % 3]);
        const auto third = static_cast<std::int32_t>(faces[f][(c + 2) % 3]);
        if (a == b) continue;
        edges.push_back({a, b, third, 0});
        edges.push_back({b, a, third, 1});
      }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (std::size_t k = 0, next = 0; k < edges.size(); k = next) {
      std::array<std::int32_t, 2> thirds{-1, -1}, count{};
      for (; next < edges.size() && edges[next][0] == edges[k][0] && edges[next][1] == edges[k][1];
           ++next) {
        thirds[edges[next][3]] = edges[next][2];
        ++count[edges[next][3]];
      }
      if (std::max(count[0], count[1]) > 1) thirds = {-1, -1};
      neighbour_.push_back(edges[k][1]);
      thirds_.push_back(thirds);
      ++begin_[edges[k][0] + 1];
    }
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  }

  Index vertices() const { return static_cast<Index>(begin_.size()) - 1; }

  /// Vertices joined to this one by an edge, in ascending order.
  std::span<const std::int32_t> neighbours(Index vertex) const {
    return {neighbour_.data() + begin_[vertex], neighbour_.data() + begin_[vertex + 1]};
  }

  bool are_neighbours(Index one, Index other) const { return edge(one, other) >= 0; }

  /// The third vertices of the faces at an edge: of the one wound from `one` to `other`, and of the
  /// one wound back; -1 where there is none, both where two are wound alike.
  std::array<std::int32_t, 2> thirds(Index one, Index other) const {
    const Index found = edge(one, other);
    return found < 0 ? std::array{-1, -1} : thirds_[found];
  }

 private:
  // Its place among the neighbours of all; -1: there is none.
  Index edge(Index one, Index other) const {
    const auto around = neighbours(one);
    const auto found =
        std::lower_bound(around.begin(), around.end(), static_cast<std::int32_t>(other));
    return found == around.end() || *found != other ? -1 : &*found - neighbour_.data();
  }

  std::vector<Index> begin_;
  std::vector<std::int32_t> neighbour_;
  std::vector<std::array<std::int32_t, 2>> thirds_;
};

using Corner = std::array<std::int32_t, 3>;  ///< a vertex and the two others of a face at it

/// Pairs of vertices of a triangulation, each the partner of the other: those of a map that takes
/// faces to faces, from one face on to the next.
class PartnerTable {
 public:
  explicit PartnerTable(const SurfaceGraph& graph) : graph_(graph), table_(graph.vertices(), -1) {}

  /// The partner of a vertex; -1: none yet.
  Index operator[](Index i) const { return table_[i]; }

  /// Pairs the vertices of all faces that edges join to a face, as its corners are taken to those
  /// of another face. False where faces, or numbers of neighbours, differ, or a vertex has another
  /// partner; some are paired then, too.
  bool grow(const Corner& from, const Corner& to) {
    std::vector<Corner> corners, found;
    for (int c = 0; c < 3; ++c) {
      if (!may_join(from[c], to[c])) return false;
      join(from[c], to[c]);
      corners.push_back({from[c], from[(c + 1) % 3], from[(c + 2) % 3]});
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Corner corner = corners[k];
      if (!mirrors_faces(corner, found)) return false;
      for (const auto& [i, image, beside] : found) {
        if (join(i, image))
          corners.push_back({i, corner[0], beside});
        else if (table_[i] != image)
          return false;
      }
    }
    return true;
  }

  /// Both vertices of each pair that was joined since the last undo() or keep().
  const std::vector<Index>& joined() const { return joined_; }

  /// Breaks these pairs.
  void undo() {
    for (const Index i : joined_) table_[i] = -1;
    joined_.clear();
  }

  void keep() { joined_.clear(); }

  /// Whether the two are a pair now and were none.
  bool join(Index i, Index j) {
    if (table_[i] >= 0 || table_[j] >= 0) return false;
    table_[i] = j;
    table_[j] = i;
    joined_.insert(joined_.end(), {i, j});
    return true;
  }

 protected:
  /// Whether the faces around a vertex are those around its image, from a face on that is mapped to
  /// one, with as many edges at their other vertices. `found`: these, their images, the ones
  /// before.
  bool mirrors_faces(const Corner& corner, std::vector<Corner>& found) const {
    const std::int32_t vertex = corner[0];
    const auto across = [&](Index a, Index b, Index third) {
      const auto thirds = graph_.thirds(a, b);
      return thirds[0] == third ? thirds[1] : thirds[0];
    };
    found.clear();
    for (int way = 1; way < 3 && corner[2] >= 0; ++way) {
      std::int32_t last = corner[way], at = corner[3 - way];
      Index last_image = table_[last], at_image = table_[at];
      for (std::int32_t next = 0; next != corner[way];) {
        next = across(vertex, at, last);
        const std::int32_t image = across(table_[vertex], at_image, last_image);
        if ((next < 0) != (image < 0)) return false;
        if (next < 0) break;
        if (!may_join(next, image) ||
            graph_.neighbours(next).size() != graph_.neighbours(image).size())
          return false;
        found.push_back({next, image, at});
        if (next == corner[way]) return true;
        last = std::exchange(at, next);
        last_image = std::exchange(at_image, image);
      }
    }
    return corner[2] >= 0;
  }

  const SurfaceGraph& graph_;
  std::vector<Index> table_;

 private:
  bool may_join(Index i, Index j) const {
    return table_[i] == j || (table_[i] < 0 && table_[j] < 0);
  }

  std::vector<Index> joined_;
};

}  // namespace symsurf
