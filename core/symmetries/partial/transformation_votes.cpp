#include "partial/transformation_votes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/kd_tree.h"
#include "partial/surface_fit.h"

namespace symsurf {

namespace {

using Invariants = KdTree<HeightSignature::length>;

// Of the points about one whose map is looked at, the share that hold it: below it slides.
constexpr double least_vote_hold = 0.07;
constexpr int slides = 3;  // a smooth body is held by long ones

// What the map of a pair becomes when it is fitted to the surface about its points; nothing where
// that does not lie on the surface then.
class VoteCheck {
 public:
  VoteCheck(const ThinnedSurface& surface, const VoteOptions& options)
      : surface_(surface), fit_(surface, options.scales), radius_(options.radius) {}

  // Those of the surface about a point that are looked at.
  std::vector<Index> about(Index point) const {
    constexpr std::size_t enough = 48;
    std::vector<Index> within;
    const SurfacePoints& all = surface_.points();
    all.tree.within(all.point(point), reach * radius_,
                    [&](Index i, double) { within.push_back(i); });
    std::sort(within.begin(), within.end());
    std::vector<Index> few;
    const std::size_t stride = 1 + within.size() / enough;
    // Those first that an early look takes are spread over all.
    for (std::size_t begin = 0; begin < stride * early; begin += stride)
      for (std::size_t k = begin; k < within.size(); k += stride * early) few.push_back(within[k]);
    return few;
  }

  // Those of the surface about which it does not slide on itself.
  std::vector<Index> held_points(const Context& context) const {
    const Index size = surface_.size();
    std::vector<char> held(size, 0);
    constexpr Index grain = 64;
    parallel_for(context, size, grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        const double tolerance = surface_.tolerance();
        const std::vector<Index> points = about(i);
        const SurfaceFit::Fit fit = fit_.fitted(Eigen::Affine3d::Identity(), points, tolerance, 1);
        held[i] = fit_.hold(fit, points, tolerance, slides) > least_vote_hold;
      }
    });
    std::vector<Index> found;
    for (Index i = 0; i < size; ++i)
      if (held[i]) found.push_back(i);
    return found;
  }

  std::optional<TransformationVote> fitted(TransformationVote vote,
                                           const std::vector<Index>& about) const {
    constexpr double wide = 4, most = 0.6, half = 0.5;
    const double tolerance = surface_.tolerance();
    const std::vector<Index> first(about.begin(), about.begin() + std::ssize(about) / early);
    if (fit_.share(vote.map, first, wide * tolerance) < half) return {};
    vote.map = fit_.fitted(vote.map, about, wide * tolerance, 2).map;
    if (fit_.share(vote.map, first, 2 * tolerance) < half) return {};
    const SurfaceFit::Fit fit = fit_.fitted(vote.map, about, 2 * tolerance, 3);
    vote.map = fit.map;
    const double agreeing = fit_.share(vote.map, about, tolerance);
    if (agreeing < most) return {};
    const double hold = fit_.hold(fit, about, tolerance, slides);
    if (hold < least_vote_hold) return {};
    vote.weight = agreeing * hold * hold;
    return vote;
  }

 private:
  static constexpr std::size_t early = 4;
  static constexpr double reach = 1.2;  // radii

  const ThinnedSurface& surface_;
  SurfaceFit fit_;
  double radius_;
};

struct Disc {
  Index point;
  HeightSignature signature;
};

// About points whose surroundings do not slide on themselves.
std::vector<Disc> described_discs(const ThinnedSurface& surface, const std::vector<Index>& points,
                                  double radius, const Context& context) {
  const SurfaceDiscs about(surface.points(), radius);
  const auto count = static_cast<Index>(points.size());
  std::vector<std::optional<HeightSignature>> signatures(count);
  constexpr Index grain = 64;
  parallel_for(context, count, grain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) signatures[k] = about.about(points[k]);
  });
  std::vector<Disc> discs;
  for (Index k = 0; k < count; ++k)
    if (signatures[k]) discs.push_back({points[k], *signatures[k]});
  return discs;
}

}  // namespace

std::vector<TransformationVote> transformation_votes(const ThinnedSurface& surface,
                                                     const VoteOptions& options,
                                                     const Context& context) {
  constexpr Index most_asking = 2000;
  constexpr std::size_t alike = 8, looked_at = 64;  // points, and of which those that are apart
  constexpr double greatest_residual = 0.7;
  constexpr std::size_t most_turns = 4;
  std::vector<double> ratios{1};
  if (options.scales) ratios = {1, std::sqrt(0.5), std::sqrt(2.0), 0.5, 2};
  const VoteCheck check(surface, options);
  const std::vector<Index> held = check.held_points(context.stage(0, 0.2));
  std::vector<std::vector<Disc>> discs;
  const Context describing = context.stage(0.2, 0.5);
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    const double each = 1 / static_cast<double>(ratios.size()), at = each * static_cast<double>(k);
    discs.push_back(described_discs(surface, held, options.radius * ratios[k],
                                    describing.stage(at, at + each)));
  }
  std::vector<Disc> found;
  for (const auto& scale : discs) found.insert(found.end(), scale.begin(), scale.end());
  if (found.empty()) return {};
  std::vector<Invariants::Point> invariants;
  for (const Disc& disc : found) invariants.push_back(disc.signature.invariants());
  const Invariants tree(invariants, context);
  const Index asking = static_cast<Index>(discs.front().size());
  // Those along the whole list.
  const Index stride = (asking + most_asking - 1) / most_asking;
  const SurfacePoints& all = surface.points();

  constexpr Index grain = 64;
  std::vector<std::vector<TransformationVote>> parts((asking + grain - 1) / grain);
  parallel_for(context.stage(0.5, 1), asking, grain, [&](Index begin, Index end) {
    std::vector<TransformationVote>& votes = parts[begin / grain];
    std::vector<Neighbour> likest;
    for (Index k = begin; k < end; ++k) {
      const Disc& disc = found[k];
      if (k % stride != 0) continue;
      likest.clear();
      tree.search(invariants[k], infinity, [&](std::uint32_t other, double squared) {
        const double apart = (all.point(found[other].point) - all.point(disc.point)).norm();
        if (apart > disc.signature.radius)
          keep_best(likest, looked_at, Neighbour{static_cast<Index>(other), squared});
        return likest.size() < looked_at ? infinity
                                         : Invariants::at_most(likest.back().squared_distance);
      });
      suppress_non_maxima(likest, alike, [&](const Neighbour& a, const Neighbour& b) {
        const Vector3 x = all.point(found[a.index].point), y = all.point(found[b.index].point);
        return (x - y).norm() < disc.signature.radius / 2;
      });
      const std::vector<Index> about = check.about(disc.point);
      for (const Neighbour& other : likest)
        for (const bool reflected : {false, true}) {
          if (!(reflected ? options.reflections : options.motions)) continue;
          const Disc& onto = found[other.index];
          std::vector<DiscMatch> turns = matches(disc.signature, onto.signature, reflected);
          if (turns.size() > most_turns) turns.resize(most_turns);
          for (const DiscMatch& match : turns) {
            if (match.residual > greatest_residual) continue;
            const Eigen::Affine3d map =
                laid_onto(disc.signature, onto.signature, reflected, match.angle);
            const auto vote = check.fitted({disc.point, onto.point, map, 0}, about);
            if (!vote) continue;
            votes.push_back(*vote);
            votes.push_back({vote->onto, vote->from, vote->map.inverse(), vote->weight});
          }
        }
    }
  });
  std::vector<TransformationVote> votes;
  for (const auto& part : parts) votes.insert(votes.end(), part.begin(), part.end());
  return votes;
}

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
  const auto around = [&](Place at, const auto& visit) {
    for (int side = 0; side < 2; ++side) {  // every turn has two quaternions
      space.search(at, Space::at_most(1), [&](std::uint32_t k, double squared) {
        if (squared < 1) visit(static_cast<Index>(k), 1 - squared);
        return Space::at_most(1);
      });
      at.head<4>() *= -1;
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
      around(places[v],
             [&](Index other, double kernel) { density += kernel * votes[other].weight; });
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
    around(places[v], [&](Index other, double kernel) {
      is_new = is_new && !(taken[other] && kernel > 0.5);
      cluster.votes.push_back(other);
    });
    for (const Index other : cluster.votes) taken[other] = 1;
    // The way back is the same symmetry.
    around(place_of(votes[v].map.inverse()), [&](Index other, double) { taken[other] = 1; });
    if (is_new) clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace symsurf
