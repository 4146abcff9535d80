#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "partial/partial_symmetries.h"

namespace symsurf {

namespace {

constexpr int terms = 15;
using Row = Eigen::Vector<double, terms>;

// Zernike polynomials of root mean square 1 over the unit disc: of order 0, then pairs of a cosine
// and a sine, as HeightSignature::orders; last the tilt.
Row zernike(double u, double v) {
  const std::complex<double> w1(u, v), w2 = w1 * w1, w3 = w2 * w1, w4 = w2 * w2;
  const double r2 = u * u + v * v;
  const double third = std::sqrt(8.0), second = std::sqrt(6.0), fourth = std::sqrt(10.0);
  const std::complex<double> z31 = third * (3 * r2 - 2) * w1, z22 = second * w2,
                             z42 = fourth * (4 * r2 - 3) * w2, z33 = third * w3, z44 = fourth * w4;
  Row row;
  row << 1, std::sqrt(3.0) * (2 * r2 - 1), std::sqrt(5.0) * (6 * r2 * r2 - 6 * r2 + 1), z31.real(),
      z31.imag(), z22.real(), z22.imag(), z42.real(), z42.imag(), z33.real(), z33.imag(),
      z44.real(), z44.imag(), 2 * u, 2 * v;
  return row;
}

Matrix3 frame_along(const Vector3& normal) {
  Matrix3 frame;
  frame.col(0) = orthogonal_to(normal).col(0);
  frame.col(1) = normal.cross(frame.col(0));
  frame.col(2) = normal;
  return frame;
}

}  // namespace

Eigen::Vector<double, HeightSignature::length> HeightSignature::invariants() const {
  // The phase between the two waves of order 2, which a turn leaves and a reflection keeps in its
  // cosine.
  const double both = std::abs(waves[1]) + std::abs(waves[2]);
  const double along = both > 0 ? (waves[1] * std::conj(waves[2])).real() / both : 0;
  Eigen::Vector<double, length> all;
  all << even[0], even[1], std::abs(waves[0]), std::abs(waves[1]), std::abs(waves[2]),
      std::abs(waves[3]), std::abs(waves[4]), along;
  return all;
}

HeightSignature HeightSignature::from_behind() const {
  HeightSignature other = *this;
  other.frame.rightCols<2>() *= -1;  // a reflection of the disc, and of heights
  for (double& x : other.even) x = -x;
  for (auto& wave : other.waves) wave = -std::conj(wave);
  return other;
}

SurfaceDiscs::SurfaceDiscs(const SurfacePoints& surface, double radius)
    : surface_(surface), radius_(radius) {}

std::vector<SurfaceDiscs::Oriented> SurfaceDiscs::connected(Index i) const {
  constexpr double facing_away = -0.3;  // cosine: the sides of a square bar stand upright
  const Vector3 x = surface_.point(i), own = surface_.normal(i);
  std::vector<char> seen(surface_.size(), 0);
  seen[i] = 1;
  std::vector<Oriented> reached{{i, own}};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (int n = 0; n < SurfacePoints::ring; ++n) {
      const Index other = surface_.neighbours(reached[k].point, n);
      if (std::exchange(seen[other], 1)) continue;
      if (!((surface_.point(other) - x).squaredNorm() < radius_ * radius_)) continue;
      Vector3 normal = surface_.normal(other);
      if (normal.dot(reached[k].normal) < 0) normal = -normal;
      if (normal.dot(own) > facing_away) reached.push_back({other, normal});
    }
  return reached;
}

std::optional<HeightSignature> SurfaceDiscs::about(Index i) const {
  constexpr std::size_t enough = 20, most = 150;
  const double radius = radius_;
  const Vector3 x = surface_.point(i);
  const std::vector<Oriented> all = connected(i);
  if (all.size() < enough) return {};
  std::vector<Oriented> around;
  for (std::size_t k = 0; k < all.size(); k += 1 + all.size() / most) around.push_back(all[k]);
  Vector3 normal = Vector3::Zero();
  for (const Oriented& sample : around) normal += sample.normal;
  if (!(normal.norm() > 0)) return {};
  normal.normalize();

  HeightSignature signature;
  signature.radius = radius;
  for (int pass = 0; pass < 2; ++pass) {
    signature.frame = frame_along(normal);
    Eigen::Matrix<double, terms, terms> products = Eigen::Matrix<double, terms, terms>::Zero();
    Row right = Row::Zero();
    for (const Oriented& sample : around) {
      const Vector3 at = signature.frame.transpose() * (surface_.point(sample.point) - x) / radius;
      const Row row = zernike(at.x(), at.y());
      products.selfadjointView<Eigen::Lower>().rankUpdate(row);
      right += at.z() * row;
    }
    // Where a disc is cut by a rim, what it leaves open is drawn to 0.
    constexpr double ridge = 0.02;
    products.diagonal().array() += ridge * static_cast<double>(around.size());
    const Row h = solved(products, right);
    signature.even = {h[1], h[2]};
    for (int w = 0; w < HeightSignature::turning; ++w)
      signature.waves[w] = {h[3 + 2 * w], h[4 + 2 * w]};
    const double height = h[0] - std::sqrt(3.0) * h[1] + std::sqrt(5.0) * h[2];
    signature.origin = x + radius * height * normal;
    const Vector3 slope = -2 * (h[13] * signature.frame.col(0) + h[14] * signature.frame.col(1));
    normal = (normal + slope).normalized();
  }
  return signature.even[0] < 0 ? signature.from_behind() : signature;
}

std::vector<DiscMatch> matches(const HeightSignature& from, const HeightSignature& onto,
                               bool reflected) {
  std::array<std::complex<double>, 5> by_order{};
  double squares = 0, mean = 0;
  for (int w = 0; w < HeightSignature::turning; ++w) {
    const std::complex<double> a = reflected ? std::conj(from.waves[w]) : from.waves[w];
    by_order[HeightSignature::orders[w]] += onto.waves[w] * std::conj(a);
    squares += std::norm(from.waves[w]) + std::norm(onto.waves[w]);
  }
  for (int e = 0; e < 2; ++e) {
    const double gap = from.even[e] - onto.even[e];
    mean += gap * gap;
  }
  if (!(squares > 0)) return {};
  constexpr int steps = 36;
  constexpr double step = 2 * std::numbers::pi / steps;
  static const auto turned = [] {
    std::array<std::complex<double>, steps> unit;
    for (int k = 0; k < steps; ++k) unit[k] = std::polar(1.0, -k * step);
    return unit;
  }();
  std::array<double, steps> overlaps{};
  for (int k = 0; k < steps; ++k)
    for (int m = 1; m <= 4; ++m) overlaps[k] += (by_order[m] * turned[m * k % steps]).real();
  std::vector<DiscMatch> found;
  for (int k = 0; k < steps; ++k) {
    const double before = overlaps[(k + steps - 1) % steps], after = overlaps[(k + 1) % steps];
    const double bend = before - 2 * overlaps[k] + after;
    if (!(overlaps[k] >= before && overlaps[k] > after && bend < 0)) continue;
    const double left = std::max(0.0, squares - 2 * overlaps[k]) + mean;
    found.push_back({(k + (before - after) / (2 * bend)) * step, std::sqrt(2 * left / squares)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const DiscMatch& a, const DiscMatch& b) { return a.residual < b.residual; });
  return found;
}

Eigen::Affine3d laid_onto(const HeightSignature& from, const HeightSignature& onto, bool reflected,
                          double angle) {
  Matrix3 turn = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  if (reflected) turn.col(1) *= -1;
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.linear() = onto.radius / from.radius * (onto.frame * turn * from.frame.transpose());
  map.translation() = onto.origin - map.linear() * from.origin;
  return map;
}

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
        held[i] = fit_.hold(Eigen::Affine3d::Identity(), about(i), surface_.tolerance(), slides) >
                  least_vote_hold;
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
    vote.map = fit_.fitted(vote.map, about, wide * tolerance, 2);
    if (fit_.share(vote.map, first, 2 * tolerance) < half) return {};
    vote.map = fit_.fitted(vote.map, about, 2 * tolerance, 3);
    const double agreeing = fit_.share(vote.map, about, tolerance);
    if (agreeing < most) return {};
    const double hold = fit_.hold(vote.map, about, tolerance, slides);
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
        return likest.size() < looked_at ? infinity : at_most(likest.back().squared_distance);
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
      space.search(at, at_most(1), [&](std::uint32_t k, double squared) {
        if (squared < 1) visit(static_cast<Index>(k), 1 - squared);
        return at_most(1);
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
