#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/math.h"
#include "cloud/point_tree.h"
#include "cloud/triangulation.h"
#include "operations/meshes.h"

namespace symsurf {

namespace {

// Of a part of a rim to be joined, the longest of the two is at most so many times as long as the
// other: chains that run side by side are about as long, jagged ones up to twice.
constexpr double longest_ratio = 3;

// Cosine between the way out of the added part and that to the rim: rims that run on beside each
// other have 0, those that face each other 1.
constexpr double facing = 0.1;

using Loop = std::vector<Index>;

// A stretch of the added part's rim, in its winding; closed: all of a loop.
struct Chain {
  Loop points;
  bool is_closed = false;
  Index rim = -1;                // that it faces
  std::vector<Index> positions;  // on that rim, of the closest points
  Index turns = 0;               // of a closed chain: how often it goes round, against the rim
  double distance = 0;           // mean, to these
};

class RimFinder {
 public:
  RimFinder(PointsView points, std::vector<Loop> rims) : points_(points), rims_(std::move(rims)) {
    std::vector<Vector3> all;
    for (Index rim = 0; rim < static_cast<Index>(rims_.size()); ++rim) {
      used_.emplace_back(rims_[rim].size(), false);
      for (const Index i : rims_[rim]) {
        all.push_back(points[i]);
        rim_of_.push_back(rim);
      }
    }
    all_ = rows_of(all);
    tree_.emplace(all_);
  }

  Vector3 nearest(const Vector3& x) const { return all_.row(tree_->nearest(x).index).transpose(); }

  Index size() const { return static_cast<Index>(rims_.size()); }
  const Loop& rim(Index r) const { return rims_[r]; }
  std::vector<bool>& used(Index r) { return used_[r]; }

  /// The rim that most of the chain's points are closest to, and where.
  void place(Chain& chain) {
    std::map<Index, Index> votes;
    for (const Index i : chain.points) ++votes[rim_of_[tree_->nearest(points_[i]).index]];
    chain.rim = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                  return a.second < b.second;
                })->first;
    const auto [found, is_new] = own_.try_emplace(chain.rim);
    if (is_new) {
      std::vector<Vector3> corners;
      for (const Index i : rims_[chain.rim]) corners.push_back(points_[i]);
      found->second.first = rows_of(corners);
      found->second.second.emplace(found->second.first);
    }
    const PointTree& tree = *found->second.second;
    chain.distance = 0;
    for (const Index i : chain.points) {
      const Neighbour near = tree.nearest(points_[i]);
      chain.positions.push_back(near.index);
      chain.distance += std::sqrt(near.squared_distance) / static_cast<double>(chain.points.size());
    }
    if (chain.is_closed) chain.turns = turns(chain.points, tree);
  }

 private:
  // Samples of each edge: a triangle within a hexagon is to pass all its corners.
  static constexpr int samples = 8;

  Index turns(const Loop& chain, const PointTree& rim) const {
    Index steps = 0, last = rim.nearest(points_[chain.front()]).index;
    for (std::size_t k = 0; k < chain.size(); ++k) {
      const Vector3 from = points_[chain[k]], to = points_[chain[(k + 1) % chain.size()]];
      for (int sample = 1; sample <= samples; ++sample) {
        const Index next = rim.nearest(from + sample / double{samples} * (to - from)).index;
        Index step = (last - next + rim.size()) % rim.size();
        if (2 * step > rim.size()) step -= rim.size();
        steps += step;
        last = next;
      }
    }
    return steps / rim.size();
  }

  PointsView points_;
  std::vector<Loop> rims_;
  std::vector<std::vector<bool>> used_;  // edges: from each point of a rim to the next
  Points all_;
  std::vector<Index> rim_of_;
  std::optional<PointTree> tree_;
  std::map<Index, std::pair<Points, std::optional<PointTree>>> own_;
};

// For each added point the way out of the added part, where it is on its rim.
Points outwards(PointsView points, const AddedPart& added) {
  Points out = Points::Zero(points.size() - added.first, 3);
  for (const auto& face : added.faces.rowwise()) {
    const Vector3 centroid = (points[face[0]] + points[face[1]] + points[face[2]]) / 3;
    for (const Index i : face) out.row(i - added.first) += (points[i] - centroid).transpose();
  }
  return out;
}

// The stretches of a loop where the mesh goes on.
template <typename Meets>
void add_chains(const Loop& loop, const Meets& meets, std::vector<Chain>& chains) {
  const auto free = std::find_if_not(loop.begin(), loop.end(), meets);
  if (free == loop.end()) {
    chains.push_back({.points = loop, .is_closed = true, .positions = {}});
    return;
  }
  Chain chain;
  const auto finish = [&] {
    if (chain.points.size() > 1) chains.push_back(chain);
    chain.points.clear();
  };
  const auto count = static_cast<std::ptrdiff_t>(loop.size());
  for (std::ptrdiff_t k = 1; k <= count; ++k) {
    const Index i = loop[(free - loop.begin() + k) % count];
    if (meets(i))
      chain.points.push_back(i);
    else
      finish();
  }
}

double length(PointsView points, const Loop& chain) {
  double sum = 0;
  for (std::size_t i = 1; i < chain.size(); ++i)
    sum += (points[chain[i]] - points[chain[i - 1]]).norm();
  return sum;
}

Loop rotated(const Loop& loop, std::ptrdiff_t start) {
  Loop turned(loop.begin() + start, loop.end());
  turned.insert(turned.end(), loop.begin(), loop.begin() + start);
  turned.push_back(turned.front());
  return turned;
}

// The two chains of the strip, side by side; empty where they do not face each other.
std::pair<Loop, Loop> sides_of(PointsView points, const Chain& chain, RimFinder& rims) {
  const Loop& rim = rims.rim(chain.rim);
  std::vector<bool>& used = rims.used(chain.rim);
  const auto size = static_cast<Index>(rim.size());
  Loop left, right;
  if (chain.is_closed) {
    if (chain.turns != 1) return {};
    Index start = 0;
    double nearest = infinity;
    for (Index k = 0; k < static_cast<Index>(chain.points.size()); ++k) {
      const double apart = (points[chain.points[k]] - points[rim[chain.positions[k]]]).norm();
      if (apart < nearest) {
        nearest = apart;
        start = k;
      }
    }
    left = rotated(rim, chain.positions[start]);
    right = rotated(chain.points, start);
  } else {
    for (Index k = chain.positions.back(); k != chain.positions.front(); k = (k + 1) % size)
      left.push_back(rim[k]);
    left.push_back(rim[chain.positions.front()]);
    right = chain.points;
    const double one = length(points, left), other = length(points, right);
    if (std::max(one, other) > longest_ratio * std::min(one, other)) return {};
  }
  std::reverse(right.begin(), right.end());
  const Index begin = chain.is_closed ? 0 : chain.positions.back();
  const auto edges = static_cast<Index>(left.size()) - 1;
  for (Index k = 0; k < edges; ++k)
    if (used[(begin + k) % size]) return {};
  for (Index k = 0; k < edges; ++k) used[(begin + k) % size] = true;
  return {left, right};
}

}  // namespace

Triangles seam_between(PointsView points, const TriangleMesh& mesh, const AddedPart& added,
                       double touching, const Context& context) {
  std::vector<Loop> loops = mesh.boundary_loops();
  // Those around faces that are kept aside are no holes.
  const std::vector<bool> is_boundary = mesh.is_boundary();
  std::erase_if(loops, [&](const Loop& loop) {
    return std::none_of(loop.begin(), loop.end(), [&](Index i) { return is_boundary[i]; });
  });
  if (loops.empty()) return Triangles(0, 3);
  const PointsView own(points.data() + 3 * added.first, points.size() - added.first);
  const Triangles own_faces = added.faces.array() - added.first;
  RimFinder rims(points, std::move(loops));
  const Points out = outwards(points, added);
  const auto meets = [&](Index i) {
    if (added.meets_mesh[i - added.first]) return true;
    const Vector3 to_rim = rims.nearest(points[i]) - points[i];
    const Vector3 way_out = out.row(i - added.first).transpose();
    return to_rim.norm() < touching &&
           to_rim.dot(way_out) >= facing * to_rim.norm() * way_out.norm();
  };
  std::vector<Chain> chains;
  for (Loop& loop : TriangleMesh(own, own_faces, context).boundary_loops()) {
    for (Index& i : loop) i += added.first;
    add_chains(loop, meets, chains);
  }
  for (Chain& chain : chains) rims.place(chain);
  std::stable_sort(chains.begin(), chains.end(),
                   [](const Chain& a, const Chain& b) { return a.distance < b.distance; });
  std::vector<std::array<Index, 3>> triangles;
  for (const Chain& chain : chains) {
    const auto [left, right] = sides_of(points, chain, rims);
    if (left.size() < 2) continue;
    const Triangles strip = strip_between(points, left, right, context);
    for (const auto& t : strip.rowwise()) triangles.push_back({t[0], t[1], t[2]});
  }
  return rows_of(triangles);
}

}  // namespace symsurf
