#include "fit/partner_fit.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "fit/shapes.h"
#include "pairing/correspondence.h"

namespace symsurf {

namespace {

// Lengths are in spacings of the points.
constexpr double agree = 0.1;   // two chords on one sphere, in radii or diagonals
constexpr double paired = 0.2;  // an image and a point
constexpr double by_chance = 0.12, least_excess = 0.25;
constexpr Index sampled = 24, near_image = 12;
constexpr Index glance = 40, look = 800;
// Spheres of a start that are refined: true ones are among the first; of a lattice 16 are. Of
// points in crowds, between which any chords fit a sphere, thousands would be.
constexpr int most_refined = 100;
constexpr double exact = 1e-3;
constexpr double near = 1.1;
constexpr double flatter = 0.2;  // a sphere may become, or bend more; curvature times diagonal

double beyond_chance(double share) { return (share - by_chance) / (1 - by_chance); }

}  // namespace

PartnerFit::PartnerFit(const Cloud& cloud, const NearestPoints& points, const PointTree& tree,
                       double spacing, const Context& context)
    : cloud_(cloud), points_(points), tree_(tree), spacing_(spacing), context_(context) {}

SphereCandidate PartnerFit::operator()(const SphereCandidate& start) const {
  SphereCandidate best = start;
  const std::vector<std::vector<Chord>> all = chords(start.shape);
  const double k = start.shape.curvature;
  const double least_curved = std::min({k / 2, 2 * k, k - flatter});
  const double most_curved = std::max({k / 2, 2 * k, k + flatter});
  int refined_count = 0;
  const auto consider = [&](const Chord& a, const Chord& b) {
    const Vector3 apart = a.middle - b.middle, turned = a.along - b.along;
    const double curvature = apart.dot(turned) / apart.squaredNorm();
    if (!(curvature > least_curved) || !(curvature < most_curved)) return;
    const double off = (turned - curvature * apart).norm();
    if (off > agree * spacing_ * std::max(std::abs(curvature), 1.0)) return;
    const UnitSphere sphere{a.middle, a.along, curvature};
    const double least = std::max(least_excess, best.partnered);
    if (beyond_chance(paired_share(sphere, glance)) < least) return;
    ++refined_count;
    const UnitSphere fitted = refined(sphere, look);
    const double excess = beyond_chance(paired_share(fitted, look));
    if (excess < least) return;
    best.shape = fitted;
    best.partnered = excess;
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      for (const Chord& a : all[i])
        for (const Chord& b : all[k]) consider(a, b);
      if (best.partnered > 0 || refined_count >= most_refined) return best;
    }
  return best;
}

std::vector<std::vector<PartnerFit::Chord>> PartnerFit::chords(const UnitSphere& sphere) const {
  const Index n = tree_.size(), count = std::min(n, 2 * sampled);
  std::vector<std::vector<Chord>> found;
  std::vector<Neighbour> near;
  for (Index k = 0; k < count && static_cast<Index>(found.size()) < sampled; ++k) {
    const Index i = tree_.order()[k * n / count];
    const Vector3 x = cloud_.frame.to_frame(cloud_.points[i]), image = sphere.reflect(x);
    if (!image.allFinite() || displaced(sphere.distance(x), spacing_) < 1) continue;
    tree_.nearest(cloud_.frame.from_frame(image), near_image, near);
    std::vector<Chord> chords;
    for (const Neighbour& partner : near) {
      const Vector3 chord = cloud_.frame.to_frame(cloud_.points[partner.index]) - x;
      if (!(chord.norm() > spacing_)) continue;
      const Vector3 middle = x + chord / 2, u = chord.normalized();
      chords.push_back({middle, u.dot(sphere.gradient(middle)) < 0 ? Vector3(-u) : u});
    }
    found.push_back(std::move(chords));
  }
  return found;
}

std::vector<Vector3> PartnerFit::positions(Index wanted) const {
  // In runs along the tree's order, whose images are close as well.
  constexpr Index run = 8;  // points
  const Index n = tree_.size(), runs = (std::min(n, wanted) + run - 1) / run;
  std::vector<Vector3> found;
  for (Index k = 0; k < runs * run; ++k) {
    const Index p = k / run * std::max<Index>(0, n - run) / std::max<Index>(1, runs - 1) + k % run;
    if (p >= n) break;
    found.push_back(cloud_.frame.to_frame(cloud_.points[tree_.order()[p]]));
  }
  return found;
}

// Out of at least a quarter of the points looked at: a mirror that hardly moves any is worth
// little.
double PartnerFit::paired_share(const UnitSphere& sphere, Index wanted) const {
  std::vector<Vector3> moved_points;
  for (const Vector3& x : positions(wanted))
    if (displaced(sphere.distance(x), spacing_) >= 1) moved_points.push_back(x);
  const PointMatcher matcher(moved_points, points_, cloud_.frame, spacing_);
  const std::size_t hits =
      matcher.matches(std::vector<UnitSphere>{sphere}, paired * spacing_).size();
  const auto asked = static_cast<Index>(moved_points.size());
  return static_cast<double>(hits) /
         static_cast<double>(std::max({asked, std::min(wanted, tree_.size()) / 4, Index{1}}));
}

Points PartnerFit::unpaired_points(const UnitSphere& sphere) const {
  const double reach = near * spacing_ * cloud_.frame.size;
  Points rest(cloud_.points.size(), 3);
  Index count = 0;
  for (const std::int32_t i : tree_.order()) {
    context_.check();
    const Vector3 image = sphere.reflect(cloud_.frame.to_frame(cloud_.points[i]));
    if (image.allFinite() &&
        tree_.nearest(cloud_.frame.from_frame(image), reach * reach).index >= 0)
      continue;
    rest.row(count++) = cloud_.points[i].transpose();
  }
  rest.conservativeResize(count, 3);
  return rest;
}

UnitSphere PartnerFit::refined(const UnitSphere& sphere, Index most) const {
  const std::vector<Vector3> looked_at = positions(most);
  return fitted(sphere, PointMatcher(looked_at, points_, cloud_.frame, spacing_),
                {0.75 * spacing_, exact * spacing_, 12, PartnerKernel::rounding},
                PartnerKernel{spacing_, 0.5, infinity});
}

}  // namespace symsurf
