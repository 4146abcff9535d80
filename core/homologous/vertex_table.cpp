#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <queue>
#include <tuple>

#include "base/parallel.h"
#include "base/random.h"
#include "cloud/point_tree.h"
#include "homologous_points.h"
#include "surface_graph.h"

namespace symsurf {

namespace {

constexpr Index table_grain = 1024;
constexpr int most_starts = 40;  // a connected part: one in fifteen may be right
// Shares of the vertices of a part. An icosphere turned at random was taken to one of its own
// mirrors with 0.40 of it close; where a side moved by 0.04 diagonals 0.47 and more are.
constexpr double least_close = 0.45;
constexpr double least_sound = 0.5;     // resampled sides reach 0.1
constexpr double worth_of_edges = 10;   // against being close: a lattice that slid keeps 0.99
constexpr double most_turned = 0.5;     // of the edges at a vertex: quadrangles divided at random
constexpr double most_unlike = 0.0625;  // an edge and its image: squared, by the length of the edge

// A map of a triangulation onto itself that is near to displacements.
class MirrorMap : public PartnerTable {
 public:
  MirrorMap(PointsView points, PointsView images, const SurfaceGraph& graph,
            const Displacements& displacements, const Context& context)
      : PartnerTable(graph),
        images_(images),
        targets_(points.matrix() + displacements.mean),
        slides_(2 * displacements.deviations),
        nearest_(points.size()),
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
      const auto thirds = graph_.thirds(a, b);
      const Corner start{a, b, thirds[thirds[0] < 0]};
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
    keep();
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
  Points targets_;
  Eigen::VectorXd slides_;  // that are as likely as not, diagonals
  std::vector<Index> nearest_, best_;
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
