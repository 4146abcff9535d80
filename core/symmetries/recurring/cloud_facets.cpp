#include "recurring/cloud_facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/distinct_points.h"
#include "recurring/great_facets.h"

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
    found_.facet = great_facets(*this, std::move(found_.facet), context);
    fit_planes();
  }

  SurfaceMoments moments(Index i) const { return SurfaceMoments::of_point(surface_.point(i)); }
  bool is_in(const FacetPlane& plane, Index i) const {
    return std::abs(plane.normal.dot(surface_.point(i) - plane.centroid)) <= off_;
  }
  template <typename Visit>
  void for_each_next(Index i, const Visit& visit) const {
    surface_.tree.within(surface_.point(i), hole * surface_.spacing,
                         [&](std::int32_t next, double) { visit(next); });
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

  void grow(Index seed) {
    const auto own = static_cast<Index>(found_.planes.size());
    SurfaceMoments sums = moments(seed);
    for (const std::int32_t j : surface_.neighbours.row(seed)) sums += moments(j);
    FacetPlane plane = plane_of(sums);
    double fitted = sums.area;
    sums = moments(seed);
    std::vector<Index> members{seed};
    found_.facet[seed] = own;
    for (std::size_t k = 0; k < members.size(); ++k)
      for (const std::int32_t j : surface_.neighbours.row(members[k])) {
        if (found_.facet[j] >= 0 || !is_in(plane, j) ||
            std::abs(plane.normal.dot(surface_.normal(j))) < same_normal)
          continue;
        found_.facet[j] = own;
        members.push_back(j);
        sums += moments(j);
        if (sums.area > refitted * fitted) {
          plane = plane_of(sums);
          fitted = sums.area;
        }
      }
    if (static_cast<Index>(members.size()) < least_points) {
      for (const Index i : members) found_.facet[i] = -1;
      return;
    }
    found_.planes.push_back(plane);
  }

  // Through the points that facets have now; without any there is none.
  void fit_planes() {
    std::vector<SurfaceMoments> sums;
    std::vector<Index> number(found_.planes.size(), -1);
    for (Index i = 0; i < surface_.size(); ++i) {
      if (found_.facet[i] < 0) continue;
      Index& own = number[found_.facet[i]];
      if (own < 0) {
        own = static_cast<Index>(sums.size());
        sums.emplace_back();
      }
      found_.facet[i] = own;
      sums[own] += moments(i);
    }
    found_.planes.clear();
    for (const SurfaceMoments& facet : sums) found_.planes.push_back(plane_of(facet));
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
