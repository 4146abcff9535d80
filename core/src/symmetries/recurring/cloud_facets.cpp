#include "symmetries/recurring/cloud_facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/distinct_points.h"

namespace symsurf {

namespace {

// Spacings that a point may lie off the plane of its facet without noise.
constexpr double off_plane = 0.1;

// Cosine between the normals of a facet and of a point that it grows by: 20 degrees.
constexpr double same_normal = 0.94;

constexpr Index least_points = 8;  // of a facet

// Spacings over which a facet goes on: random points leave holes.
constexpr double hole = 3;

class RegionGrowing {
 public:
  explicit RegionGrowing(CloudFacets& found)
      : found_(found),
        surface_(found.surface),
        off_(std::max(in_plane * found.noise, off_plane * surface_.spacing)) {}

  void run(const Context& context) {
    found_.facet.assign(surface_.size(), -1);
    const std::vector<Index> seeds = flattest_first(context.stage(0, 0.3));
    interruptible_for(context, static_cast<Index>(seeds.size()), [&](Index k) {
      if (found_.facet[seeds[k]] < 0) grow(seeds[k]);
    });
    refit();
    take_lesser(context);
    refit();
  }

 private:
  // By how far the normals of a point and its neighbours differ.
  std::vector<Index> flattest_first(const Context& context) const {
    std::vector<double> bend(surface_.size());
    constexpr Index grain = 1024;
    parallel_for(context, surface_.size(), grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
        for (const std::int32_t j : surface_.neighbours.row(i))
          bend[i] = std::max(bend[i], 1 - std::abs(surface_.normal(i).dot(surface_.normal(j))));
    });
    std::vector<Index> order(surface_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return bend[a] < bend[b]; });
    return order;
  }

  double off(const FacetPlane& plane, Index i) const {
    return std::abs(plane.normal.dot(surface_.point(i) - plane.centroid));
  }

  void grow(Index seed) {
    const auto own = static_cast<Index>(found_.planes.size());
    SurfaceMoments moments = SurfaceMoments::of_point(surface_.point(seed));
    for (const std::int32_t j : surface_.neighbours.row(seed))
      moments += SurfaceMoments::of_point(surface_.point(j));
    FacetPlane plane = plane_of(moments);
    double fitted = moments.area;
    moments = SurfaceMoments::of_point(surface_.point(seed));
    std::vector<Index> members{seed};
    found_.facet[seed] = own;
    for (std::size_t k = 0; k < members.size(); ++k)
      for (const std::int32_t j : surface_.neighbours.row(members[k])) {
        if (found_.facet[j] >= 0 || off(plane, j) > off_ ||
            std::abs(plane.normal.dot(surface_.normal(j))) < same_normal)
          continue;
        found_.facet[j] = own;
        members.push_back(j);
        moments += SurfaceMoments::of_point(surface_.point(j));
        if (moments.area > refitted * fitted) {
          plane = plane_of(moments);
          fitted = moments.area;
        }
      }
    if (static_cast<Index>(members.size()) < least_points) {
      for (const Index i : members) found_.facet[i] = -1;
      return;
    }
    found_.planes.push_back(plane);
  }

  // Planes through the points that facets have now; without any there is none.
  void refit() {
    std::vector<SurfaceMoments> moments;
    std::vector<Index> number(found_.planes.size(), -1);
    for (Index i = 0; i < surface_.size(); ++i) {
      if (found_.facet[i] < 0) continue;
      Index& own = number[found_.facet[i]];
      if (own < 0) {
        own = static_cast<Index>(moments.size());
        moments.emplace_back();
      }
      found_.facet[i] = own;
      moments[own] += SurfaceMoments::of_point(surface_.point(i));
    }
    found_.planes.clear();
    for (const SurfaceMoments& facet : moments) found_.planes.push_back(plane_of(facet));
  }

  // Great facets take points of lesser ones that lie in their planes; what has lost much is none.
  void take_lesser(const Context& context) {
    constexpr std::size_t stretch = 4096;  // points between questions whether to go on
    const auto count = static_cast<Index>(found_.planes.size());
    std::vector<std::vector<Index>> members(count);
    for (Index i = 0; i < surface_.size(); ++i)
      if (found_.facet[i] >= 0) members[found_.facet[i]].push_back(i);
    std::vector<Index> order(count), rank(count);
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return members[a].size() > members[b].size(); });
    for (Index k = 0; k < count; ++k) rank[order[k]] = k;
    for (const Index own : order) {
      std::vector<Index> open;
      for (const Index i : members[own])
        if (found_.facet[i] == own) open.push_back(i);
      if (static_cast<double>(open.size()) <
          least_left * static_cast<double>(members[own].size())) {
        for (const Index i : open) found_.facet[i] = -1;
        continue;
      }
      for (std::size_t k = 0; k < open.size(); ++k) {
        if (k % stretch == 0) context.check();
        surface_.tree.within(surface_.point(open[k]), hole * surface_.spacing,
                             [&](std::int32_t j, double) {
                               const Index other = found_.facet[j];
                               if (other == own || (other >= 0 && rank[other] < rank[own]) ||
                                   off(found_.planes[own], j) > off_)
                                 return;
                               found_.facet[j] = own;
                               open.push_back(j);
                             });
      }
    }
  }

  CloudFacets& found_;
  const SurfacePoints& surface_;
  double off_;
};

}  // namespace

CloudFacets::CloudFacets(PointsView points, const Context& context)
    : rows(distinct_points(points, context.stage(0, 0.1)).first),
      surface(chosen_rows(points, rows), context.stage(0.1, 0.6)),
      noise(surface.noise) {
  RegionGrowing(*this).run(context.stage(0.6, 1));
}

double CloudFacets::squared_distance(const Vector3& x) const {
  constexpr Index around = 8;
  constexpr double near = 2;  // spacings
  std::vector<Neighbour> found;
  surface.tree.nearest(x, around, found);
  const double reach = near * surface.spacing;
  double least = infinity;
  for (const Neighbour& n : found) {
    if (n.squared_distance > reach * reach) continue;
    const Index own = facet[n.index];
    const double off = own >= 0 ? planes[own].normal.dot(x - planes[own].centroid)
                                : surface.normal(n.index).dot(x - surface.point(n.index));
    least = std::min(least, off * off);
  }
  return least;
}

}  // namespace symsurf
