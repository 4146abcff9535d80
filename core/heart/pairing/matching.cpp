#include "pairing/matching.h"

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/point_summary.h>
#include <symsurf/points.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "cloud/surface_points.h"

namespace symsurf {

namespace {

// Has memory send a row that is read soon.
void prefetch(PointsView points, Index i) {
#ifdef __GNUC__
  __builtin_prefetch(points.data() + 3 * i);
#endif
}

}  // namespace

Partners find_partners(PointsView points, const PointTree& tree, const Mirror& mirror, double limit,
                       const Context& context) {
  constexpr Index grain = 1024;
  constexpr Index ahead = 8;  // points along the curve lie scattered: a tenth of `plane` of 10^6
  Partners partners{std::vector<std::int32_t>(points.size()), Eigen::VectorXd(points.size())};
  const std::vector<std::int32_t>& order = tree.order();
  parallel_for(context, static_cast<Index>(order.size()), grain, [&](Index begin, Index end) {
    std::vector<Vector3> images;
    images.reserve(end - begin);
    for (Index p = begin; p < end; ++p) {
      if (p + ahead < end) prefetch(points, order[p + ahead]);
      images.push_back(mirror.reflect(points[order[p]]));
    }
    const std::vector<Neighbour> found = tree.nearest(images, limit * limit);
    for (Index p = begin; p < end; ++p) {
      partners.index[order[p]] = static_cast<std::int32_t>(found[p - begin].index);
      partners.squared[order[p]] = found[p - begin].squared_distance;
    }
  });
  return partners;
}

// Little is held beside the tree, and beside the result: at a million points that is what counts.
void add_pairs(Result& result, const Cloud& cloud, const Mirror& mirror, double limit,
               const Context& context) {
  const PointsView points = cloud.points;
  Partners partners = find_partners(points, cloud.tree(context), mirror, limit, context);
  cloud.release_tree();
  const Index size = points.size();
  const Index found = size - std::count(partners.index.begin(), partners.index.end(), -1);
  // The largest first, into the space that the tree left.
  result.surface_points.resize(found, 3);
  Pairs& pairs = result.pairs;
  pairs.resize(found, 2);
  Index row = 0;
  interruptible_for(context, size, [&](Index i) {
    const Index partner = partners.index[i];
    if (partner < 0) return;
    partners.squared[row] = partners.squared[i];
    pairs.row(row++) << i, partner;
  });
  partners.index = std::vector<std::int32_t>();
  result.residuals = std::move(partners.squared);
  result.residuals.conservativeResize(found);
  result.residuals = result.residuals.cwiseSqrt();
  interruptible_for(context, found, [&](Index k) {
    result.surface_points.row(k) = (points[pairs(k, 0)] + points[pairs(k, 1)]).transpose() / 2;
  });
}

void add_pairs(Result& result, const Cloud& cloud, const ParameterValues& values,
               const Context& context) {
  if (values.boolean("pairs"))
    add_pairs(result, cloud, *result.mirror, values.real("pair_distance") * cloud.diagonal,
              context);
}

void keep_pairs(Result& result, const std::vector<Index>& rows) {
  result.pairs = Pairs(result.pairs(rows, Eigen::indexing::all));
  result.residuals = Eigen::VectorXd(result.residuals(rows));
  result.surface_points = Points(result.surface_points(rows, Eigen::indexing::all));
}

void pair_anew(Result& result, const Cloud& cloud, double limit, const Context& context) {
  if (!result.mirror) return;
  add_pairs(result, cloud, *result.mirror, limit, context);
  if (result.mirror->kind() != "free-form" && result.mirror->kind() != "quadric") return;
  result.surface_points = result.mirror->project(result.surface_points, context);
  std::vector<Index> reached;
  for (Index row = 0; row < result.pairs.rows(); ++row)
    if (result.surface_points.row(row).allFinite()) reached.push_back(row);
  keep_pairs(result, reached);
}

struct SurfaceMatcher::Target {
  SurfacePoints surface;
  const Mirror& mirror;
};

SurfaceMatcher::SurfaceMatcher(Points surface, const Mirror& mirror, const Context& context) {
  if (surface.rows() < 3)
    throw InvalidInput("the surface has " + std::to_string(surface.rows()) +
                       " points; at least 3 are needed");
  target_.reset(new Target{SurfacePoints(std::move(surface), context), mirror});
}

SurfaceMatcher::SurfaceMatcher(SurfaceMatcher&&) noexcept = default;
SurfaceMatcher::~SurfaceMatcher() = default;

SurfaceMatcher::Matches SurfaceMatcher::match(PointsView points, double distance,
                                              const Context& context) const {
  constexpr Index grain = 1024;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const SurfacePoints& surface = target_->surface;
  Matches matches{Eigen::VectorX<Index>::Constant(points.size(), -1),
                  Eigen::VectorXd::Constant(points.size(), nan)};
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vector3 image = target_->mirror.reflect(points[i]);
      const Index partner = surface.tree.nearest(image, distance * distance).index;
      if (partner < 0) continue;
      matches.partners[i] = partner;
      matches.residuals[i] = std::abs(surface.normal(partner).dot(image - surface.point(partner)));
    }
  });
  return matches;
}

}  // namespace symsurf
