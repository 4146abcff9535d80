#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/point_summary.h>
#include <symsurf/points.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "cloud/surface_points.h"

namespace symsurf {

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
