#include "score/sampled_surface.h"

#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/surfels.h"

namespace symsurf {

namespace {

constexpr Index in_plane = 8;     // points that a plane is fitted to
constexpr double near = 0.08;     // diagonals: what is around a sample
constexpr Index like_it = 12;     // samples around one, which have its noise and spacing
constexpr std::size_t quiet = 9;  // of these, but for edges
constexpr double apart = 2.2;     // spacings: the surface ends there
// In the mean, of what has a surface: of its neighbours, which noise makes a volume where points
// are dense, and of patches.
constexpr double least_flatness = 0.09, least_patch_flatness = 0.25;
constexpr Index few = 1000;            // points, whose patches are too large to tell
constexpr double least_ceiling = 0.3;  // of points too few to say anything of each other

Points points_of(const Surfels& patches) {
  Points positions(patches.size(), 3);
  for (Index k = 0; k < patches.size(); ++k) positions.row(k) = patches[k].sampled.transpose();
  return positions;
}

// 1 to 0: whether the residual is within the tolerance or the noise, points are as near as on the
// surface, and the normals agree where both sides have one.
double support_of(double residual, double tolerance, double third, double spacing,
                  const Vector3& normal, double flatness, const LocalFacet& facet) {
  constexpr double crossing = 0.3, along = 0.7;  // cosines between normals
  const double off = std::pow(residual / tolerance, 4);
  const double beyond = std::pow(third / (apart * spacing + tolerance), 6);
  const double cosine = std::abs(normal.dot(facet.normal));
  const double agree = std::clamp((cosine - crossing) / (along - crossing), 0.0, 1.0);
  return (1 - flatness * facet.flatness * (1 - agree)) / ((1 + off) * (1 + beyond));
}

// 1 to 0: of a point without a surface, how near the nearest one is. Of points at random one in ten
// is as near.
double met(double distance, double spacing) {
  constexpr double near_enough = 0.25;
  return 1 / (1 + std::pow(distance / (near_enough * spacing), 4));
}

// Positions without their noise are compared with fewer points than it is measured by.
double tolerance_of(const Cloud& cloud, double noise, bool is_noisy) {
  const double deviations = is_noisy ? 3.5 : 2.5;
  return std::max(cloud.tolerance, deviations * noise);
}

}  // namespace

SampledSurface::SampledSurface(const Cloud& cloud, Index count, const Context& context)
    : cloud_(cloud),
      tree_(cloud.tree(context.stage(0, 0.5))),
      patches_(cloud.patches(std::clamp<Index>(cloud.points.size() / 2, 1, count),
                             context.stage(0.5, 1))),
      positions_(points_of(patches_)),
      sample_tree_(positions_) {
  constexpr Index grain = 64;  // samples that a thread takes at a time
  struct Own {
    LocalFacet other;
    double residual, third;
  };
  std::vector<OnSurface> on_surface;
  for (Index k = 0; k < positions_.rows(); ++k)
    on_surface.push_back({positions_.row(k).transpose(), &patches_[k]});
  is_noisy_ = SurfaceNoise(on_surface,
                           neighbours_of(on_surface, cloud.frame, NearestPoints(cloud, context)))
                  .shows();
  std::vector<Own> own(positions_.rows());
  samples_.resize(positions_.rows());
  const auto look_at = [&](Index k) {
    Sample& sample = samples_[k];
    sample.position = positions_.row(k).transpose();
    std::vector<Neighbour> others = neighbours(sample.position, 2 * in_plane + 1);
    others.erase(others.begin());  // itself
    sample.facet = facet(others, 0);
    sample.patch = {patches_[k].mean, patches_[k].normal, patches_[k].flatness};
    sample.around = around(sample.position);
    const LocalFacet other = facet(others, 1);
    if (is_noisy_) sample.above = sample.facet.above(sample.position);
    const Vector3 smoothed = sample.position - sample.above * sample.facet.normal;
    own[k] = {other, other.above(smoothed), third_of(others)};
  };
  silent_parallel_for(context, size(), grain, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) look_at(k);
  });
  double flatness = 0, patch_flatness = 0;
  for (const Sample& sample : samples_) {
    flatness += sample.facet.flatness;
    patch_flatness += sample.patch.flatness;
  }
  for (Index k = 0; k < size(); ++k) {
    std::vector<double> squares, thirds;
    for (const Index j : nearest(samples_[k].position, like_it)) {
      squares.push_back(own[j].residual * own[j].residual);
      thirds.push_back(own[j].third);
    }
    std::sort(squares.begin(), squares.end());
    squares.resize(std::min(quiet, squares.size()));
    double sum = 0;
    for (const double square : squares) sum += square;
    samples_[k].noise = std::sqrt(sum / static_cast<double>(squares.size()));
    samples_[k].spacing = median(std::move(thirds));
  }
  fills_volume_ = flatness < least_flatness * static_cast<double>(size()) &&
                  (cloud.points.size() <= few ||
                   patch_flatness < least_patch_flatness * static_cast<double>(size()));
  for (Index k = 0; k < size(); ++k) {
    Sample& sample = samples_[k];
    const double support =
        support_of(own[k].residual, tolerance_of(cloud, sample.noise, is_noisy_), own[k].third,
                   sample.spacing, sample.facet.normal, sample.facet.flatness, own[k].other);
    sample.ceiling = fills_volume_ ? 1 : std::max(least_ceiling, support);
  }
}

SampledSurface::Landing SampledSurface::landing(const Sample& sample,
                                                const ImagePoint& image) const {
  const std::vector<Neighbour> found = neighbours(image.position, 2 * in_plane);
  Landing landing;
  if (found.empty()) return landing;
  const double rounding = single_rounding * cloud_.frame.size;
  landing.exact = found.front().squared_distance < rounding * rounding;
  landing.facet = facet(found, 1);
  landing.there = around(image.position) / sample.around;
  landing.sample = nearest(image.position, 1).front();
  const Sample& partner = samples_[landing.sample];
  const double noise = std::hypot(sample.noise, partner.noise) / std::sqrt(2.0);
  landing.residual = landing.facet.above(image.position - sample.above * image.normal);
  const double third = third_of(found);
  landing.ends = third > apart * partner.spacing + farthest_residual;
  landing.support =
      fills_volume_
          ? met(std::sqrt(found.front().squared_distance) / cloud_.frame.size, partner.spacing)
          : support_of(landing.residual, tolerance_of(cloud_, noise, is_noisy_), third,
                       partner.spacing, image.normal, sample.facet.flatness, landing.facet);
  return landing;
}

std::vector<Index> SampledSurface::nearest(const Vector3& position, Index count) const {
  std::vector<Neighbour> found;
  sample_tree_.nearest(position, count, found);
  std::vector<Index> numbers;
  for (const Neighbour& one : found) numbers.push_back(one.index);
  return numbers;
}

double SampledSurface::around(const Vector3& position) const {
  double count = 0;
  sample_tree_.within(position, near, [&](Index, double) { ++count; });
  return count;
}

std::vector<Neighbour> SampledSurface::neighbours(const Vector3& position, Index count) const {
  std::vector<Neighbour> found;
  tree_.nearest(cloud_.frame.from_frame(position), count, found);
  return found;
}

double SampledSurface::third_of(const std::vector<Neighbour>& neighbours) const {
  if (neighbours.empty()) return 0;
  const std::size_t third = std::min<std::size_t>(2, neighbours.size() - 1);
  return std::sqrt(neighbours[third].squared_distance) / cloud_.frame.size;
}

LocalFacet SampledSurface::facet(const std::vector<Neighbour>& neighbours,
                                 std::size_t first) const {
  LocalFacet facet;
  std::vector<Vector3> points;
  for (std::size_t k = first; k < neighbours.size(); k += 2) {
    points.push_back(cloud_.frame.to_frame(cloud_.points[neighbours[k].index]));
    facet.mean += points.back();
  }
  if (points.empty()) return facet;
  facet.mean /= static_cast<double>(points.size());
  Matrix3 scatter = Matrix3::Zero();
  for (const Vector3& x : points) scatter += (x - facet.mean) * (x - facet.mean).transpose();
  const LeastEigen least = least_eigen_of(scatter);
  facet.normal = least.vector;
  // A surface where the points spread at least twice as far across the thinnest direction.
  const double ratio = std::sqrt(std::max(0.0, least.value) / std::max(least.next, 1e-24));
  facet.flatness = 1 - std::min(1.0, 2 * ratio);
  return facet;
}

}  // namespace symsurf
