#include <algorithm>
#include <cmath>
#include <utility>

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
    for (const double side : {1.0, -1.0}) {  // every turn has two quaternions
      Place at = places[v];
      at.head<4>() *= side;
      space.search(at, Space::at_most(1), [&](std::uint32_t k, double squared) {
        if (squared < 1) visit(static_cast<Index>(k), 1 - squared);
        return Space::at_most(1);
      });
    }
  };
  // Of an exactly symmetric shape half of all votes are one cluster: some are enough to find where
  // it is densest.
  constexpr Index grain = 64, most_looked_at = 6000;
  const Index count = static_cast<Index>(votes.size());
  const Index stride = (count + most_looked_at - 1) / most_looked_at;
  std::vector<std::pair<double, Index>> densities((count + stride - 1) / stride);
  parallel_for(context, static_cast<Index>(densities.size()), grain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      auto& [density, v] = densities[k] = {0, k * stride};
      around(v, [&](Index other, double kernel) { density += kernel * votes[other].weight; });
    }
  });
  std::stable_sort(densities.begin(), densities.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<char> taken(votes.size(), 0);
  for (const auto& [density, v] : densities) {
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
