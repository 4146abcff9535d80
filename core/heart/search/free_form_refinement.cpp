#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {
namespace {
constexpr Index grain = 64;          // points or patches that a thread takes at a time
constexpr double exact_miss = 0.25;  // spacings
// Of the partners found. Where single points are missing fewer are exact, and the others say more
// about the mirror than a surface would that goes only where partners are.
constexpr double least_exact = 0.8;
constexpr double flat_enough = 0.995;
constexpr double together = 1.4, together_normals = 0.85;  // spacings, cosine
constexpr double least_component = 0.15;                   // of the largest
constexpr double foot_precision = 1e-3;

struct Smoothing {
  Index neighbours;  // data a patch is fitted to
  double along;
  double robust_scale;  // in units of the diagonal
  double most_missed;   // a patch whose data miss by more, in the median, is none
};

// So many that noise averages out.
Index around_a_patch(const SearchCloud& cloud) {
  constexpr double least = 75, most = 110, averaged = 0.3;  // noise in spacings
  const double excess = std::max(1.0, cloud.noise / (averaged * cloud.spacing));
  return static_cast<Index>(std::min(most, least * excess * excess));
}

double median_miss(const std::vector<Carried>& data) {
  std::vector<double> squared;
  for (const Carried& c : data) squared.push_back(c.miss.squaredNorm());
  return std::sqrt(median(std::move(squared)));
}

Points feet_of(const std::vector<Carried>& carried) {
  Points feet(static_cast<Index>(carried.size()), 3);
  for (Index i = 0; i < feet.rows(); ++i) feet.row(i) = carried[i].foot.transpose();
  return feet;
}

// Small connected components beside a large one are pairs by chance.
void drop_small_components(const SearchCloud& cloud, std::vector<Carried>& carried) {
  if (carried.empty()) return;
  const Points feet = feet_of(carried);
  const PointTree tree(feet);
  std::vector<std::int32_t> component(carried.size(), -1);
  std::vector<Index> sizes, open;
  for (Index first = 0; first < feet.rows(); ++first) {
    if (component[first] >= 0) continue;
    const auto label = static_cast<std::int32_t>(sizes.size());
    sizes.push_back(0);
    component[first] = label;
    open.push_back(first);
    while (!open.empty()) {
      const Index i = open.back();
      open.pop_back();
      ++sizes[label];
      tree.within(feet.row(i), together * cloud.spacing, [&](Index other, double) {
        if (component[other] >= 0) return;
        if (std::abs(carried[other].normal.dot(carried[i].normal)) < together_normals) return;
        component[other] = label;
        open.push_back(other);
      });
    }
  }
  const auto least =
      least_component * static_cast<double>(*std::max_element(sizes.begin(), sizes.end()));
  std::size_t k = 0;
  std::erase_if(carried,
                [&](const Carried&) { return static_cast<double>(sizes[component[k++]]) < least; });
}

// Patches about one spacing apart, each fitted to the data around it.
std::shared_ptr<FreeForm> fitted(const SearchCloud& cloud, const std::vector<Carried>& carried,
                                 const Smoothing& smoothing) {
  if (carried.size() < 6) return nullptr;
  const Points feet = feet_of(carried);
  const PointTree tree(feet);
  const double apart = 0.9 * cloud.spacing;
  std::vector<char> covered(carried.size(), 0);
  std::vector<Index> nodes;
  for (Index i = 0; i < feet.rows(); ++i) {
    if (covered[i]) continue;
    nodes.push_back(i);
    tree.within(feet.row(i), apart, [&](Index other, double) {
      if (carried[other].normal.dot(carried[i].normal) > 0.5) covered[other] = 1;
    });
  }
  Points centres(static_cast<Index>(nodes.size()), 3);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    centres.row(static_cast<Index>(k)) = feet.row(nodes[k]);
  const PointTree centre_tree(centres);

  // Of each node; of no radius where its data determine none.
  std::vector<Patch> patches(nodes.size());
  const auto fit_at = [&](std::size_t k) {
    std::vector<Neighbour> found;
    const Carried& own = carried[nodes[k]];
    tree.nearest(own.foot, std::min<Index>(smoothing.neighbours, feet.rows()), found);
    FitWeights weights;
    weights.radius = 1.1 * std::sqrt(found.back().squared_distance) + 1e-6;
    weights.along = smoothing.along;
    weights.robust_scale = smoothing.robust_scale;
    std::vector<Carried> data;
    for (const Neighbour& other : found) data.push_back(carried[other.index]);
    if (median_miss(data) > smoothing.most_missed) return;
    Patch patch;
    if (!fit_patch(own.foot, own.normal, data, weights, patch)) return;
    centre_tree.nearest(own.foot, std::min<Index>(8, centres.rows()), found);
    patch.radius = std::max(2.2 * apart, std::sqrt(found.back().squared_distance));
    patch.radius = std::min(patch.radius, 8 * apart);
    patches[k] = patch;
  };
  silent_parallel_for(cloud.context, static_cast<Index>(nodes.size()), grain,
                      [&](Index begin, Index end) {
                        for (Index k = begin; k < end; ++k) fit_at(k);
                      });
  std::erase_if(patches, [](const Patch& patch) { return !(patch.radius > 0); });
  if (patches.size() < 3) return nullptr;
  return std::make_shared<FreeForm>(std::move(patches));
}

double local_spacing(const SearchCloud& cloud, Index i) {
  return std::max(cloud.spacing, cloud.spacings[i]);
}

}  // namespace

void orient(SearchCloud& cloud) {
  struct Edge {
    double alike;
    Index from, to;

    bool operator<(const Edge& other) const {
      return std::tie(alike, other.from, other.to) < std::tie(other.alike, from, to);
    }
  };
  std::vector<char> done(cloud.size(), 0);
  std::priority_queue<Edge> edges;
  for (Index first = 0; first < cloud.size(); ++first) {
    edges.push({1, first, first});
    while (!edges.empty()) {
      const Edge edge = edges.top();
      edges.pop();
      if (done[edge.to]) continue;
      done[edge.to] = 1;
      if (cloud.normal(edge.from).dot(cloud.normal(edge.to)) < 0) cloud.normals.row(edge.to) *= -1;
      for (int k = 0; k < SearchCloud::ring; ++k) {
        const Index next = cloud.neighbours(edge.to, k);
        if (!done[next])
          edges.push({std::abs(cloud.normal(edge.to).dot(cloud.normal(next))), edge.to, next});
      }
    }
  }
}

Index points_a_patch(const SearchCloud& cloud) {
  constexpr Index around_exact = 14;
  return cloud.noisy() ? around_a_patch(cloud) : around_exact;
}

std::shared_ptr<FreeForm> surface_through(const SearchCloud& cloud) {
  std::vector<Carried> own;
  for (Index i = 0; i < cloud.size(); ++i)
    own.push_back({cloud.point(i), cloud.normal(i), 0, Vector3::Zero(), cloud.normal(i)});
  const double off = (cloud.noisy() ? 0.6 : 0.02) * cloud.spacing;
  return fitted(cloud, own, {points_a_patch(cloud), 1, off, 1});
}

double reach(const GrownSurface& surface) { return surface.exact ? 0.8 : 1.3; }

void match(const SearchCloud& cloud, const FootOf& foot_of, GrownSurface& surface) {
  surface.carried.clear();
  surface.points.clear();
  surface.partners.clear();
  struct Carry {
    Carried carried;
    std::int32_t partner = -1;
  };
  std::vector<Carry> all(cloud.size());
  const auto carry = [&](Index p) {
    const Index i = cloud.tree.order()[p];
    auto& [c, partner] = all[p];
    const Vector3 x = cloud.point(i);
    if (!foot_of(x, c.foot, c.normal)) return;
    c.distance = c.normal.dot(x - c.foot);
    const Vector3 image = x - 2 * c.distance * c.normal;
    const double farthest = reach(surface) * local_spacing(cloud, i);
    const Neighbour near = cloud.tree.nearest(image, farthest * farthest);
    if (near.index < 0 || near.index == i) return;
    const Vector3 n = cloud.normal(i), other = cloud.normal(near.index);
    const double cosine = std::abs(other.dot(n - 2 * c.normal.dot(n) * c.normal));
    c.turned = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    if (c.turned > 0.75) return;
    c.miss = cloud.point(near.index) - image;
    c.partner_normal = cloud.normal(near.index);
    partner = static_cast<std::int32_t>(near.index);
  };
  silent_parallel_for(cloud.context, cloud.size(), grain, [&](Index begin, Index end) {
    for (Index p = begin; p < end; ++p) carry(p);
  });
  std::vector<double> misses;
  for (Index p = 0; p < cloud.size(); ++p) {
    const auto& [c, partner] = all[p];
    if (partner < 0) continue;
    misses.push_back(c.miss.norm() / cloud.spacing);
    surface.carried.push_back(c);
    surface.points.push_back(cloud.tree.order()[p]);
    surface.partners.push_back(partner);
  }
  if (misses.empty()) return;
  const auto exact =
      std::count_if(misses.begin(), misses.end(), [](double miss) { return miss < exact_miss; });
  surface.exact = static_cast<double>(exact) >= least_exact * static_cast<double>(misses.size());
  surface.typical_miss = median(std::move(misses));
}

void match(const SearchCloud& cloud, double precision, GrownSurface& surface) {
  match(
      cloud,
      [&](const Vector3& x, Vector3& foot, Vector3& normal) {
        return surface.mirror->foot(x, precision, foot, normal);
      },
      surface);
}

double flatness(const GrownSurface& surface) {
  Matrix3 spread = Matrix3::Zero();
  for (const Carried& c : surface.carried) spread += c.normal * c.normal.transpose();
  return eigen_of(spread).values[2] / static_cast<double>(surface.carried.size());
}

bool is_flat(const GrownSurface& surface) { return flatness(surface) > flat_enough; }

void refine(const SearchCloud& cloud, int rounds, GrownSurface& surface) {
  std::size_t matched = 0;
  for (int round = 0; round < rounds; ++round) {
    const Smoothing smoothing =
        surface.exact ? Smoothing{14, 1, 0.02 * cloud.spacing, 0.15 * cloud.spacing}
                      : Smoothing{around_a_patch(cloud), 0.08, 0.6 * cloud.spacing, 1};
    const bool fresh = !surface.mirror;
    if (!surface.exact) drop_small_components(cloud, surface.carried);
    surface.mirror = fitted(cloud, surface.carried,
                            fresh ? Smoothing{24, 0.3, 0.6 * cloud.spacing, 1} : smoothing);
    if (!surface.mirror) return;
    match(cloud, surface.exact ? double_rounding : foot_precision, surface);
    if (surface.carried.size() < 6) {
      surface.mirror = nullptr;
      return;
    }
    surface.support = support(cloud, surface);
    if (round > 1 && surface.carried.size() <= matched + matched / 200) return;
    matched = surface.carried.size();
  }
}

double support(const SearchCloud& cloud, const GrownSurface& surface) {
  double sum = 0;
  for (std::size_t k = 0; k < surface.carried.size(); ++k) {
    const Carried& c = surface.carried[k];
    const double tau = local_spacing(cloud, surface.points[k]);
    // Exact partners differ from their neighbours however near the mirror they are.
    const double least = surface.exact ? 0.3 * tau : tau;
    const double moved = std::clamp(2 * std::abs(c.distance) / least - 1, 0.0, 1.0);
    sum += moved * closeness(c, tau);
  }
  return sum / static_cast<double>(cloud.size());
}

}  // namespace symsurf::perpendicular
