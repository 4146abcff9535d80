#include <algorithm>
#include <cmath>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "pairs/placement_search.h"
#include "partial/partial_symmetries.h"

namespace symsurf {

namespace {

constexpr Index fewest = 20;  // points of a component

// A connected component of a thinned surface.
struct Component {
  std::vector<Index> thinned;
  Points points;
  Vector3 extents = Vector3::Zero();  // standard deviations along its axes, diagonals
};

// The largest first.
std::vector<std::vector<Index>> connected_components(const ThinnedSurface& surface) {
  constexpr double farthest = 3;  // spacings between connected points
  const SurfacePoints& all = surface.points();
  std::vector<char> seen(all.size(), 0);
  std::vector<std::vector<Index>> components;
  for (Index seed = 0; seed < all.size(); ++seed) {
    if (std::exchange(seen[seed], 1)) continue;
    std::vector<Index> component{seed};
    for (std::size_t k = 0; k < component.size(); ++k)
      all.tree.within(all.point(component[k]), farthest * surface.spacing(), [&](Index i, double) {
        if (!std::exchange(seen[i], 1)) component.push_back(i);
      });
    std::sort(component.begin(), component.end());
    components.push_back(std::move(component));
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

Vector3 extents_of(const Points& points) {
  const Points centred = points.rowwise() - points.colwise().mean();
  const double count = static_cast<double>(points.rows());
  return (eigen_of_scatter(centred).values / count).cwiseMax(0).cwiseSqrt();
}

// Those that are no lines, which no placement is found for.
std::vector<Component> components_of(const ThinnedSurface& surface, Index least,
                                     const Context& context) {
  std::vector<std::vector<Index>> found = connected_components(surface);
  std::erase_if(found, [&](const auto& one) { return std::ssize(one) < std::max(least, fewest); });
  if (found.size() < 2) return {};
  std::vector<Index> parts(surface.size(), -1);
  for (std::size_t k = 0; k < found.size(); ++k)
    for (const Index i : found[k]) parts[i] = static_cast<Index>(k);
  std::vector<Points> divided = surface.divided(parts, context);
  divided.resize(found.size());
  std::vector<Component> components;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (divided[k].rows() < fewest) continue;
    const Vector3 extents = extents_of(divided[k]);
    if (extents[1] > surface.spacing())
      components.push_back({std::move(found[k]), std::move(divided[k]), extents});
  }
  return components;
}

// How much longer one is than the other, along the axis that differs most: a logarithm.
double unlikeness(const Component& a, const Component& b, double spacing) {
  const Vector3 margin = Vector3::Constant(spacing);
  return ((a.extents + margin).array() / (b.extents + margin).array()).log().abs().maxCoeff();
}

struct Twins {
  std::size_t from, onto;
  double unlikeness;

  bool operator<(const Twins& other) const { return unlikeness < other.unlikeness; }
};

// Each component with those that are most like it, the likest pairs first.
std::vector<Twins> likely_twins(const std::vector<Component>& components, double spacing) {
  constexpr double most_unlike = 0.15;
  constexpr std::size_t partners = 3, most = 24;
  std::vector<Twins> all;
  for (std::size_t a = 0; a < components.size(); ++a) {
    std::vector<Twins> own;
    for (std::size_t b = a + 1; b < components.size(); ++b)
      if (const double u = unlikeness(components[a], components[b], spacing); u < most_unlike)
        keep_best(own, partners, Twins{a, b, u});
    for (const Twins& twins : own) keep_best(all, most, twins);
  }
  return all;
}

}  // namespace

std::vector<PatchPair> component_pairs(const ThinnedSurface& surface,
                                       const PartialSearchOptions& options, Index least,
                                       const Context& context) {
  const std::vector<Component> components = components_of(surface, least, context.stage(0, 0.1));
  std::vector<PatchPair> pairs;
  const std::vector<Twins> twins = likely_twins(components, surface.spacing());
  for (std::size_t k = 0; k < twins.size(); ++k) {
    const double share = 0.9 / static_cast<double>(twins.size());
    const Context step = context.stage(0.1 + share * static_cast<double>(k),
                                       0.1 + share * static_cast<double>(k + 1));
    const Component &from = components[twins[k].from], &onto = components[twins[k].onto];
    Cloud one = checked_cloud(from.points, {}, fewest, step.stage(0, 0));
    Cloud other = checked_cloud(onto.points, {}, fewest, step.stage(0, 0));
    const double size = std::max(one.frame.size, other.frame.size);
    one.frame = one.frame.with_size(size);
    other.frame = other.frame.with_size(size);
    const PlacedShape own(one, step.stage(0, 0.2)), its(other, step.stage(0.2, 0.4));
    const auto add = [&](bool reflected, const Context& searching) {
      const PlacementSearch search(own, its, reflected);
      const UnitPlacement placement = search.found(searching);
      if (search.fit(placement, 1).share < options.minimum_score) return;
      const double evidence = search.evidence(placement);
      if (evidence < PlacementSearch::least_evidence) return;
      PatchPair pair;
      pair.map = between_frames(placement.map, one.frame, other.frame);
      pair.from = from.thinned;
      pair.hold = evidence;
      pairs.push_back(std::move(pair));
    };
    if (options.votes.motions) add(false, step.stage(0.4, 0.7));
    if (options.votes.reflections) add(true, step.stage(0.7, 1));
  }
  return pairs;
}

}  // namespace symsurf
