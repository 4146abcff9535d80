#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "spatial/kd_tree.h"
#include "symmetries/partial/transformation_votes.h"

namespace symsurf {

namespace {

using Space = KdTree<9>;  // a quaternion, a shift, the logarithm of a scale, and the parity
using Place = Space::Point;

// The widths of the kernel: radians, diagonals, and of the logarithm. Turns between discs are right
// to some 5 degrees, which moves what lies across the cloud by as much of a diagonal.
constexpr double turn_width = 0.2, shift_width = 0.05, scale_width = 0.15;

Place place_of(const Eigen::Affine3d& map) {
  const double determinant = map.linear().determinant();
  const double scale = std::cbrt(determinant);
  const Eigen::Quaterniond q(Matrix3(map.linear() / scale));  // of a reflection without inversion
  Place place;
  place << 2 / turn_width * q.coeffs(), map.translation() / shift_width,
      std::log(std::abs(scale)) / scale_width, determinant < 0 ? 2 : 0;
  return place;
}

}  // namespace

std::vector<VoteCluster> vote_clusters(const std::vector<TransformationVote>& votes,
                                       std::size_t most, const Context& context) {
  std::vector<VoteCluster> clusters;
  if (votes.empty()) return clusters;
  std::vector<Place> places;
  for (const TransformationVote& vote : votes) places.push_back(place_of(vote.map));
  const Space space(places, context);
  // Epanechnikov's kernel; visit(vote, its value).
  const auto around = [&](Index v, const auto& visit) {
    std::vector<Neighbour> near;
    for (const double side : {1.0, -1.0}) {  // every turn has two quaternions
      Place at = places[v];
      at.head<4>() *= side;
      space.search(at, Space::at_most(1), [&](std::uint32_t k, double squared) {
        if (squared < 1) near.push_back({k, squared});
        return Space::at_most(1);
      });
    }
    std::sort(near.begin(), near.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.index < b.index; });
    for (const Neighbour& n : near) visit(n.index, 1 - n.squared_distance);
  };
  std::vector<double> densities(votes.size(), 0);
  constexpr Index grain = 256;
  parallel_for(context, static_cast<Index>(votes.size()), grain, [&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v)
      around(v, [&](Index other, double kernel) { densities[v] += kernel * votes[other].weight; });
  });
  std::vector<Index> order(votes.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return densities[a] > densities[b]; });
  std::vector<char> taken(votes.size(), 0);
  for (const Index v : order) {
    if (clusters.size() == most) break;
    if (taken[v]) continue;
    context.check();
    VoteCluster cluster{votes[v].map, {}};
    bool is_new = true;
    around(v, [&](Index other, double kernel) {
      is_new = is_new && !(taken[other] && kernel > 0.5);
      cluster.votes.push_back(other);
    });
    for (const Index other : cluster.votes) taken[other] = 1;
    if (is_new) clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace symsurf
