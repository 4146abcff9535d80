#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "base/random.h"
#include "cloud/point_tree.h"
#include "homologous_points.h"

namespace symsurf {

namespace {

// The vertices of a triangulated surface with the edges between them.
class SurfaceGraph {
 public:
  SurfaceGraph(Index vertices, TrianglesView faces);

  // Vertices joined to this one by an edge, in ascending order.
  std::span<const std::int32_t> neighbours(Index vertex) const {
    return {neighbour_.data() + begin_[vertex], neighbour_.data() + begin_[vertex + 1]};
  }

  bool are_neighbours(Index one, Index other) const { return edge(one, other) >= 0; }

  // The third vertices of the faces at an edge; -1 where there is none, both of more than two.
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

SurfaceGraph::SurfaceGraph(Index vertices, TrianglesView faces) : begin_(vertices + 1, 0) {
  std::vector<std::array<std::int32_t, 3>> edges;  // from, to, and the third vertex; both ways
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
    thirds_.push_back({next - k > 2 ? -1 : third, next - k == 2 ? edges[k + 1][2] : -1});
    ++begin_[a + 1];
  }
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
}

constexpr Index table_grain = 1024;
constexpr int most_starts = 40;  // a connected part: one in fifteen may be right
// Shares of the vertices of a part. An icosphere turned at random was taken to one of its own
// mirrors with 0.40 of it close; where a side moved by 0.04 diagonals 0.47 and more are.
constexpr double least_close = 0.45;
constexpr double least_sound = 0.5;     // resampled sides reach 0.1
constexpr double worth_of_edges = 10;   // against being close: a lattice that slid keeps 0.99
constexpr double most_turned = 0.5;     // of the edges at a vertex: quadrangles divided at random
constexpr double most_unlike = 0.0625;  // an edge and its image: squared, by the length of the edge

using Corner = std::array<std::int32_t, 3>;  // a vertex and the two others of a face at it

// A map of a triangulation onto itself that exchanges the vertices of each pair.
class MirrorMap {
 public:
  MirrorMap(PointsView points, PointsView images, const SurfaceGraph& graph,
            const Displacements& displacements, const Context& context)
      : images_(images),
        graph_(graph),
        targets_(points.matrix() + displacements.mean),
        slides_(2 * displacements.deviations),
        nearest_(points.size()),
        table_(points.size(), -1),
        best_(table_) {
    for (Index i = 0; i < points.size(); ++i) {
      for (const Index j : graph.neighbours(i))
        slides_[i] = std::max(slides_[i], (points[i] - points[j]).norm() / 2);
      slides_[i] = std::min(slides_[i], usual_slide);
    }
    const PointTree tree(images, context.stage(0, 0.3));
    parallel_for(context.stage(0.3, 1), points.size(), table_grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
        nearest_[i] = tree.nearest(targets_.row(i).transpose()).index;
    });
  }

  // Pairs the vertices of a connected part: of the maps from several faces on the best.
  void pair(const std::vector<std::int32_t>& part, const Context& context) {
    const auto count = static_cast<Index>(part.size());
    Random random(0);
    Worth best;
    for (Index draw = 0, starts = 0; draw < count && starts < most_starts && !best.is_nearest;
         ++draw) {
      const std::int32_t a = part[random.below(count)];
      const auto around = graph_.neighbours(a);
      const std::int32_t b = around[random.below(static_cast<Index>(around.size()))];
      const Corner start{a, b, graph_.thirds(a, b)[0]};
      // All faces of a map of the whole part lead to it.
      if ((best.is_whole && is_in(best_, start)) || !begin(start)) continue;
      context.check();
      ++starts;
      grow(start);
      if (const Worth worth = worth_of(part); worth.score > best.score) {
        best = worth;
        for (const std::int32_t i : part) best_[i] = table_[i];
      }
      undo();
    }
    for (const std::int32_t i : part)
      if (best_[i] >= 0) join(i, best_[i]);
    joined_.clear();
  }

  // The other vertex of each pair that keeps enough edges, else -1.
  std::vector<Index> sound_pairs() const {
    std::vector<Index> pairs(table_.size(), -1);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (is_sound(i)) pairs[i] = table_[i];
    return pairs;
  }

 private:
  // What a map of a part is worth.
  struct Worth {
    double score = 0;                           // 0: it is none
    bool is_whole = false, is_nearest = false;  // keeps all edges; and no other is as near
  };

  bool may_join(Index i, Index j) const {
    return table_[i] == j || (table_[i] < 0 && table_[j] < 0);
  }

  // Whether the two are a pair now and were none.
  bool join(Index i, Index j) {
    if (table_[i] >= 0 || table_[j] >= 0) return false;
    table_[i] = j;
    table_[j] = i;
    joined_.insert(joined_.end(), {i, j});
    return true;
  }

  // Breaks the pairs of the present map.
  void undo() {
    for (const Index i : joined_) table_[i] = -1;
    joined_.clear();
  }

  // Whether a map takes the corners of a face to the nearest.
  bool is_in(const std::vector<Index>& map, const Corner& face) const {
    return face[2] >= 0 &&
           std::all_of(face.begin(), face.end(), [&](Index i) { return map[i] == nearest_[i]; });
  }

  // Pairs the corners of a face with the nearest, if these have a face.
  bool begin(const Corner& face) {
    if (face[2] < 0) return false;
    const auto thirds = graph_.thirds(nearest_[face[0]], nearest_[face[1]]);
    if (std::find(thirds.begin(), thirds.end(), nearest_[face[2]]) == thirds.end()) return false;
    for (const std::int32_t i : face) join(i, nearest_[i]);
    if (is_in(table_, face)) return true;
    undo();
    return false;
  }

  // From a face on. As each edge has one face on either side, a face and its image tell the map of
  // the whole part. Past vertices whose faces have no image the edges lead that are most like
  // theirs.
  void grow(const Corner& start) {
    using Step = std::tuple<double, std::int32_t, std::int32_t, std::int32_t>;
    std::priority_queue<Step, std::vector<Step>, std::greater<>>
        steps;  // unlike, vertex, image, from
    std::vector<Corner> corners, found;
    for (int c = 0; c < 3; ++c)
      corners.push_back({start[c], start[(c + 1) % 3], start[(c + 2) % 3]});
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Corner corner = corners[k];
      if (mirrors_faces(corner, found)) {
        for (const auto& [i, image, beside] : found)
          if (join(i, image)) corners.push_back({i, corner[0], beside});
      } else {
        for (const std::int32_t i : graph_.neighbours(corner[0]))
          for (const std::int32_t image : graph_.neighbours(table_[corner[0]]))
            if (table_[i] < 0 && table_[image] < 0)
              if (const double unlike = difference(corner[0], i, image); unlike < most_unlike)
                steps.push({unlike, i, image, corner[0]});
      }
      while (k + 1 == corners.size() && !steps.empty()) {
        const auto [unlike, i, image, from] = steps.top();
        steps.pop();
        if (join(i, image)) corners.push_back(corner_at(i, from));
      }
    }
  }

  // Of an edge and an edge from the image of its first vertex on, squared, by its length.
  double difference(Index from, Index to, Index image) const {
    const Eigen::RowVector3d edge = targets_.row(to) - targets_.row(from);
    const Vector3 other = images_[image] - images_[table_[from]];
    return (other.transpose() - edge).squaredNorm() / edge.squaredNorm();
  }

  // Of a face at an edge that is mapped to a face; without one its third vertex is -1.
  Corner corner_at(std::int32_t i, std::int32_t j) const {
    const auto images = graph_.thirds(table_[i], table_[j]);
    for (const std::int32_t third : graph_.thirds(i, j))
      if (third >= 0 && table_[third] >= 0 &&
          std::find(images.begin(), images.end(), table_[third]) != images.end())
        return {i, j, third};
    return {i, j, -1};
  }

  // Whether the faces around a vertex are those around its image, from a face on that is mapped to
  // one, with as many edges at their other vertices. `found`: these, their images, the ones before.
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

  Index kept_edges(Index i) const {
    const auto around = graph_.neighbours(i);
    return std::count_if(around.begin(), around.end(), [&](Index j) {
      return table_[j] >= 0 && graph_.are_neighbours(table_[j], table_[i]);
    });
  }

  bool is_sound(Index i) const {
    const auto edges = static_cast<double>(graph_.neighbours(i).size());
    return table_[i] >= 0 && static_cast<double>(kept_edges(i)) >= (1 - most_turned) * edges;
  }

  Worth worth_of(const std::vector<std::int32_t>& part) const {
    double edges = 0, kept = 0, sound = 0, close = 0, nearest = 0;
    for (const std::int32_t i : part) {
      edges += static_cast<double>(graph_.neighbours(i).size());
      if (!is_sound(i)) continue;
      kept += static_cast<double>(kept_edges(i));
      const double off = (images_[table_[i]].transpose() - targets_.row(i)).norm() / slides_[i];
      ++sound;
      close += 1 / (1 + off * off);
      nearest += table_[i] == nearest_[i];
    }
    const auto count = static_cast<double>(part.size());
    if (sound < least_sound * count || close < least_close * count) return {};
    return {worth_of_edges * kept / edges + close / count, kept == edges,
            kept == edges && 2 * nearest > count};
  }

  PointsView images_;
  const SurfaceGraph& graph_;
  Points targets_;
  Eigen::VectorXd slides_;  // that are as likely as not, diagonals
  std::vector<Index> nearest_, table_, best_, joined_;
};

}  // namespace

std::vector<Index> vertex_table(PointsView points, PointsView images, TrianglesView faces,
                                const Displacements& displacements, const Context& context) {
  const SurfaceGraph graph(points.size(), faces);
  MirrorMap map(points, images, graph, displacements, context);
  std::vector<bool> is_known(points.size(), false);
  for (std::int32_t first = 0; first < points.size(); ++first) {
    if (is_known[first] || graph.neighbours(first).empty()) continue;
    is_known[first] = true;
    std::vector<std::int32_t> part{first};
    for (std::size_t k = 0; k < part.size(); ++k)
      for (const std::int32_t i : graph.neighbours(part[k])) {
        if (!is_known[i]) part.push_back(i);
        is_known[i] = true;
      }
    map.pair(part, context);
  }
  return map.sound_pairs();
}

}  // namespace symsurf
