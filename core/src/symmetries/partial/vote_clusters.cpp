#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/math.h"
#include "base/parallel.h"
#include "spatial/kd_tree.h"
#include "symmetries/partial/transformation_votes.h"

namespace symsurf {

namespace {

using Space = KdTree<8>;  // a quaternion, a shift, the logarithm of a scale
using Place = Space::Point;

// The widths of the kernel: radians, diagonals, and of the logarithm. Turns between discs are right
// to some 5 degrees, which moves what lies across the cloud by as much of a diagonal.
constexpr double turn_width = 0.2, shift_width = 0.05, scale_width = 0.15;

Place place_of(const Eigen::Affine3d& map) {
  const double determinant = map.linear().determinant();
  const double scale = std::cbrt(std::abs(determinant));
  const Matrix3 turn = map.linear() / std::cbrt(determinant);  // of a reflection without inversion
  const Eigen::Quaterniond q(turn);
  Place place;
  place << 2 / turn_width * q.coeffs(), map.translation() / shift_width,
      std::log(scale) / scale_width;
  return place;
}

Place opposite(Place place) {
  place.head<4>() *= -1;
  return place;
}

class VoteSpace {
 public:
  VoteSpace(const std::vector<TransformationVote>& votes, std::vector<Index> members,
            const Context& context)
      : votes_(votes), members_(std::move(members)), tree_(places_of(), context) {}

  Index size() const { return static_cast<Index>(members_.size()); }
  Place place(Index m) const { return place_of(votes_[members_[m]].map); }

  // visit(member, place on the query's side, kernel) within the kernel's width.
  template <typename Visit>
  void around(const Place& at, const Visit& visit) const {
    std::vector<Neighbour> near;
    tree_.search(at, Space::at_most(1), [&](std::uint32_t k, double squared) {
      if (squared < 1) near.push_back({k, squared});
      return Space::at_most(1);
    });
    std::sort(near.begin(), near.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.index < b.index; });
    for (const Neighbour& n : near) {
      const Index m = n.index % size();
      const Place there = n.index < size() ? places_[m] : opposite(places_[m]);
      visit(m, there, 1 - n.squared_distance);
    }
  }

  double density(const Place& at) const {
    double sum = 0;
    around(at, [&](Index m, const Place&, double kernel) { sum += kernel * weight(m); });
    return sum;
  }

  Place mode_from(Place at) const {
    constexpr int steps = 30;
    constexpr double still = 1e-3;
    for (int step = 0; step < steps; ++step) {
      // The shadow of Epanechnikov's kernel is flat.
      Place sum = Place::Zero();
      double weights = 0;
      around(at, [&](Index m, const Place& there, double) {
        sum += weight(m) * there;
        weights += weight(m);
      });
      if (!(weights > 0)) break;
      const Place next = sum / weights;
      const double moved = (next - at).norm();
      at = next;
      if (moved < still) break;
    }
    return at;
  }

  double weight(Index m) const { return votes_[members_[m]].weight; }
  Index vote(Index m) const { return members_[m]; }

 private:
  // Every turn has two quaternions.
  std::vector<Place> places_of() {
    for (const Index v : members_) places_.push_back(place_of(votes_[v].map));
    std::vector<Place> both = places_;
    for (const Place& place : places_) both.push_back(opposite(place));
    return both;
  }

  const std::vector<TransformationVote>& votes_;
  std::vector<Index> members_;
  std::vector<Place> places_;
  Space tree_;
};

void add_clusters(const VoteSpace& space, const std::vector<TransformationVote>& votes,
                  std::size_t most, std::vector<VoteCluster>& clusters, const Context& context) {
  std::vector<double> densities(space.size());
  constexpr Index grain = 256;
  parallel_for(context, space.size(), grain, [&](Index begin, Index end) {
    for (Index m = begin; m < end; ++m) densities[m] = space.density(space.place(m));
  });
  std::vector<Index> order(space.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return densities[a] > densities[b]; });
  std::vector<char> taken(space.size(), 0);
  for (std::size_t k = 0, found = 0; k < order.size() && found < most; ++k) {
    if (taken[order[k]]) continue;
    context.check();
    const Place mode = space.mode_from(space.place(order[k]));
    VoteCluster cluster;
    double nearest = -1;
    bool is_new = true;
    space.around(mode, [&](Index m, const Place&, double kernel) {
      is_new = is_new && !(taken[m] && kernel > 0.5);
      cluster.votes.push_back(space.vote(m));
      cluster.mass += kernel * space.weight(m);
      if (kernel > nearest) {
        nearest = kernel;
        cluster.map = votes[space.vote(m)].map;
      }
    });
    space.around(mode, [&](Index m, const Place&, double) { taken[m] = 1; });
    taken[order[k]] = 1;
    if (!is_new || cluster.votes.empty()) continue;
    std::sort(cluster.votes.begin(), cluster.votes.end());
    clusters.push_back(std::move(cluster));
    ++found;
  }
}

}  // namespace

std::vector<VoteCluster> vote_clusters(const std::vector<TransformationVote>& votes,
                                       std::size_t most, const Context& context) {
  std::vector<VoteCluster> clusters;
  for (const bool reflected : {false, true}) {
    std::vector<Index> members;
    for (Index v = 0; v < static_cast<Index>(votes.size()); ++v)
      if ((votes[v].map.linear().determinant() < 0) == reflected) members.push_back(v);
    if (members.empty()) continue;
    const VoteSpace space(votes, std::move(members), context);
    const double from = reflected ? 0.5 : 0;
    add_clusters(space, votes, most, clusters, context.stage(from, from + 0.5));
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const VoteCluster& a, const VoteCluster& b) { return a.mass > b.mass; });
  if (clusters.size() > most) clusters.resize(most);
  return clusters;
}

}  // namespace symsurf
