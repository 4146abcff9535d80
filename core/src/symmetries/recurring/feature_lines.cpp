#include "symmetries/recurring/feature_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"
#include "spatial/voxel_grid.h"

namespace symsurf {

namespace {

// A sharp edge with the unit vectors across it into its faces.
struct SharpEdge {
  Index from, to;
  std::vector<Vector3> wings;
};

class LineExtraction {
 public:
  LineExtraction(PointsView points, TrianglesView faces, double angle, const Context& context)
      : points_(points), cosine_(std::cos(angle)) {
    TripleIndex positions;
    std::vector<Index> place(points.size());
    for (Index i = 0; i < points.size(); ++i) {
      place[i] = positions.add(ordered_bits(points[i]));
      if (place[i] == static_cast<Index>(point_at_.size())) point_at_.push_back(i);
    }
    find_edges(faces, place, context);
    edges_at_.resize(point_at_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      edges_at_[edges_[e].from].push_back(static_cast<Index>(e));
      edges_at_[edges_[e].to].push_back(static_cast<Index>(e));
    }
    for (Index i = 0; i < points.size(); ++i)
      if (!edges_at_[place[i]].empty()) twins_[place[i]].push_back(i);
  }

  FeatureLines run(const Context& context) {
    FeatureLines found;
    std::vector<Index> corner(point_at_.size(), -1);
    for (Index place = 0; place < static_cast<Index>(point_at_.size()); ++place)
      if (is_corner(place)) {
        corner[place] = static_cast<Index>(found.corners.size());
        found.corners.push_back(position(place));
      }
    found.at.resize(found.corners.size());
    std::vector<char> used(edges_.size(), 0);
    const auto add = [&](Index place, Index edge) {
      context.check();
      FeatureLine line = followed(place, edge, corner, used);
      const auto number = static_cast<Index>(found.lines.size());
      if (line.has_ends()) {
        found.at[line.start].push_back(number);
        if (line.end != line.start) found.at[line.end].push_back(number);
      }
      found.lines.push_back(std::move(line));
    };
    for (Index place = 0; place < static_cast<Index>(point_at_.size()); ++place)
      if (corner[place] >= 0)
        for (const Index edge : edges_at_[place])
          if (!used[edge]) add(place, edge);
    for (std::size_t edge = 0; edge < edges_.size(); ++edge)
      if (!used[edge]) add(edges_[edge].from, static_cast<Index>(edge));
    return found;
  }

 private:
  Vector3 position(Index place) const { return points_[point_at_[place]]; }
  Index other_end(Index edge, Index place) const {
    return edges_[edge].from == place ? edges_[edge].to : edges_[edge].from;
  }

  void find_edges(TrianglesView faces, const std::vector<Index>& place, const Context& context) {
    TripleIndex edges, known;
    std::vector<std::vector<Vector3>> wings;
    std::vector<char> is_vague;  // beside a face without an area
    interruptible_for(context, faces.size(), [&](Index f) {
      Triple corners{place[faces[f][0]], place[faces[f][1]], place[faces[f][2]]};
      Triple sorted = corners;
      std::sort(sorted.begin(), sorted.end());
      if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) return;
      const Index before = known.size();
      if (known.add(sorted) < before) return;  // the same face again
      for (int c = 0; c < 3; ++c) {
        const Index from = std::min(corners[c], corners[(c + 1) % 3]),
                    to = std::max(corners[c], corners[(c + 1) % 3]);
        const Index edge = edges.add({from, to, 0});
        if (edge == static_cast<Index>(wings.size())) {
          wings.emplace_back();
          is_vague.push_back(0);
        }
        const Vector3 along = (position(to) - position(from)).normalized();
        const Vector3 into = position(corners[(c + 2) % 3]) - position(from);
        const Vector3 across = into - into.dot(along) * along;
        constexpr double rounding = 1e-9;
        if (across.norm() > rounding * into.norm())
          wings[edge].push_back(across.normalized());
        else
          is_vague[edge] = 1;
      }
    });
    for (Index e = 0; e < edges.size(); ++e)
      if (!is_vague[e] && is_sharp(wings[e]))
        edges_.push_back({edges[e][0], edges[e][1], std::move(wings[e])});
  }

  // Of two faces in a plane the vectors across their edge are opposite.
  bool is_sharp(const std::vector<Vector3>& wings) const {
    return wings.size() != 2 || -wings[0].dot(wings[1]) < cosine_;
  }

  bool is_corner(Index place) const {
    const std::vector<Index>& edges = edges_at_[place];
    if (edges.empty()) return false;
    if (edges.size() != 2 || edges_[edges[0]].wings.size() != edges_[edges[1]].wings.size())
      return true;
    const Vector3 one = position(other_end(edges[0], place)) - position(place),
                  other = position(other_end(edges[1], place)) - position(place);
    return -one.normalized().dot(other.normalized()) < cosine_;
  }

  // From a place along one of its edges up to a corner, or back to the place.
  FeatureLine followed(Index start, Index edge, const std::vector<Index>& corner,
                       std::vector<char>& used) {
    std::vector<Index> places{start}, edges;
    for (;;) {
      used[edge] = 1;
      edges.push_back(edge);
      const Index place = other_end(edge, places.back());
      places.push_back(place);
      if (corner[place] >= 0 || place == start) break;
      edge = edges_at_[place][edges_at_[place][0] == edge ? 1 : 0];
    }
    FeatureLine line;
    line.start = corner[places.front()];
    line.end = corner[places.back()];
    std::vector<double> reached{0};
    for (std::size_t k = 1; k < places.size(); ++k)
      reached.push_back(reached.back() + (position(places[k]) - position(places[k - 1])).norm());
    line.length = reached.back();
    std::size_t k = 1;
    for (int step = 0; step < FeatureLine::steps; ++step) {
      const double at = line.length * step / FeatureLine::steps;
      while (k + 1 < places.size() && reached[k] < at) ++k;
      const double edge = reached[k] - reached[k - 1];
      const double share = edge > 0 ? (at - reached[k - 1]) / edge : 0;
      line.samples[step] = (1 - share) * position(places[k - 1]) + share * position(places[k]);
      if (step == FeatureLine::steps / 2) line.wings = edges_[edges[k - 1]].wings;
    }
    for (const Index place : places)
      line.points.insert(line.points.end(), twins_[place].begin(), twins_[place].end());
    std::sort(line.points.begin(), line.points.end());
    line.points.erase(std::unique(line.points.begin(), line.points.end()), line.points.end());
    return line;
  }

  PointsView points_;
  double cosine_;
  std::vector<Index> point_at_;  // of each place the first
  std::vector<std::vector<Index>> edges_at_;
  std::unordered_map<Index, std::vector<Index>> twins_;  // all points at the places of edges
  std::vector<SharpEdge> edges_;
};

}  // namespace

FeatureLines feature_lines(PointsView points, TrianglesView faces, double angle,
                           const Context& context) {
  return LineExtraction(points, faces, angle, context.stage(0, 0.9)).run(context.stage(0.9, 1));
}

}  // namespace symsurf
