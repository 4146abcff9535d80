#include "thinned_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr Index several = 4;  // points of the cloud that are looked at for each thinned one

// Spacings: noise beyond shows in the normals of a dozen points, and is smoothed over so far.
constexpr double noisy = 0.25, reach = 3.5;

// Each point on the quadratic surface fitted to those of the cloud around it, weighted less the
// farther away: moving least squares (Levin 2003).
Points smoothed(const SurfacePoints& surface, const Cloud& cloud, const Context& context) {
  const Cloud& some = cloud.thinned(several * surface.size(), context.stage(0, 0.1));
  const Points all = cloud.frame.to_frame(some.points, context.stage(0.1, 0.2));
  const PointTree tree(all, context.stage(0.2, 0.4));
  const double radius = reach * surface.spacing;
  Points moved = surface.points;
  constexpr Index grain = 256;
  parallel_for(context.stage(0.4, 1), surface.size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> around;
    for (Index i = begin; i < end; ++i) {
      const Vector3 x = surface.point(i);
      around.clear();
      tree.within(x, radius, [&](Index j, double squared) { around.push_back({j, squared}); });
      if (around.empty()) continue;
      std::sort(around.begin(), around.end());
      const LocalPlane plane = plane_through(all, around);
      QuadraticFit fit;
      for (const Neighbour& n : around) {
        const Vector3 at = plane.axes.transpose() * (all.row(n.index).transpose() - x) / radius;
        fit.add(at.y(), at.z(), at.x(), 1 - n.squared_distance / (radius * radius));
      }
      constexpr double ridge = 0.1;  // points
      moved.row(i) += radius * fit.coefficients(ridge, ridge)[0] * plane.axes.col(0).transpose();
    }
  });
  return moved;
}

SurfacePoints surface_of(Points positions, const Cloud& cloud, double& noise,
                         const Context& context) {
  SurfacePoints surface(std::move(positions), context.stage(0, 0.4));
  noise = surface.noise;
  if (!(noise > noisy * surface.spacing)) return surface;
  return {smoothed(surface, cloud, context.stage(0.4, 0.6)), context.stage(0.6, 1)};
}

Cloud sampled(Cloud cloud, SurfaceSamples& sampling, const Context& context) {
  if (!cloud.faces.empty() && sampling.apply(cloud, context)) validate(cloud, 1, context);
  return cloud;
}

}  // namespace

ThinnedSurface::ThinnedSurface(const Cloud& cloud, Index count, const Context& context)
    : cloud_(sampled(cloud, sampling_, context.stage(0, 0.1))),
      surfels_(cloud_.patches(std::min(count, cloud_.points.size() / 2), context.stage(0.1, 0.5))),
      map_(surfels_),
      points_(
          surface_of(surfels_.positions(surfels_.size()), cloud_, noise_, context.stage(0.5, 1))),
      near_(points_.size()) {
  // Samples of faces come behind the cloud's own points.
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Index surfel = surfels_.containing(cloud_.frame.to_frame(cloud.points[i]));
    if (surfel >= 0) near_[surfel].push_back(i);
  }
}

double ThinnedSurface::tolerance() const {
  constexpr double of_spacing = 0.35, deviations = 3, smoothed_deviations = 1.5;
  return std::max(
      {of_spacing * spacing(), deviations * points_.noise, smoothed_deviations * noise_});
}

std::vector<Index> ThinnedSurface::near(const std::vector<Index>& thinned) const {
  std::vector<Index> all;
  for (const Index i : thinned) all.insert(all.end(), near_[i].begin(), near_[i].end());
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Points> ThinnedSurface::divided(const std::vector<Index>& parts,
                                            const Context& context) const {
  const Cloud& some = cloud_.thinned(several * size(), context.stage(0, 0.5));
  const Points all = cloud_.frame.to_frame(some.points, context.stage(0.5, 1));
  std::vector<std::vector<Index>> rows;
  for (Index i = 0; i < all.rows(); ++i) {
    const Index surfel = surfels_.containing(all.row(i).transpose());
    if (surfel < 0 || parts[surfel] < 0) continue;
    if (parts[surfel] >= std::ssize(rows)) rows.resize(parts[surfel] + 1);
    rows[parts[surfel]].push_back(i);
  }
  std::vector<Points> divided;
  for (const std::vector<Index>& part : rows) divided.push_back(chosen_rows(all, part));
  return divided;
}

Matrix4 ThinnedSurface::in_input_units(const Eigen::Affine3d& map) const {
  const PrincipalFrame& frame = cloud_.frame;
  Matrix4 input = Matrix4::Identity();
  const Matrix3 linear = frame.axes * map.linear() * frame.axes.transpose();
  input.topLeftCorner<3, 3>() = linear;
  input.topRightCorner<3, 1>() = frame.from_frame(map.translation()) - linear * frame.centroid;
  return input;
}

}  // namespace symsurf
