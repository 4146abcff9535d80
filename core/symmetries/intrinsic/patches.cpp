#include "intrinsic/patches.h"

#include <algorithm>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr double rounding = 1e-12;  // of residuals of flat patches, which both maps fit
constexpr Index fewest = 6;  // samples of a patch: three determine a reflection, noise asks more

}  // namespace

Patches::Patches(const ConnectedSurface& surface, const SampledPoints& samples,
                 const PointTree& vertices, double radius)
    : surface_(surface), samples_(samples), vertices_(vertices) {
  for (Index j = 0; j < samples.count(); ++j) {
    Eigen::VectorXd ascending = samples.distances.col(j);
    const Index last = std::min(fewest, samples.count() - 1);
    std::nth_element(ascending.begin(), ascending.begin() + last, ascending.end());
    radii_.push_back(std::max(radius, ascending[last]));
    std::vector<Member>& patch = patches_.emplace_back();
    for (Index i = 0; i < samples.count(); ++i) {
      const double weight = biweight(samples.distances(i, j) / radii_.back()) * samples.weights[i];
      if (weight > 0) patch.push_back({i, weight});
    }
  }
}

// Of a patch and its image, about their means.
struct Patches::Moments {
  Vector3 mean = Vector3::Zero(), image = Vector3::Zero();
  Matrix3 products = Matrix3::Zero();  // of the images and the samples
  double before = 0, after = 0;        // sums of squares
};

Patches::Moments Patches::moments(const std::vector<Member>& patch,
                                  const std::vector<Index>& images) const {
  const auto at = [&](Index vertex) -> Vector3 { return surface_.points.row(vertex).transpose(); };
  Moments sums;
  double weights = 0;
  for (const auto& [i, weight] : patch) {
    weights += weight;
    sums.mean += weight * at(samples_.vertices[i]);
    sums.image += weight * at(images[i]);
  }
  if (weights == 0) return sums;
  sums.mean /= weights;
  sums.image /= weights;
  for (const auto& [i, weight] : patch) {
    const Vector3 x = at(samples_.vertices[i]) - sums.mean, y = at(images[i]) - sums.image;
    const double share = weight / weights;
    sums.products += share * y * x.transpose();
    sums.before += share * x.squaredNorm();
    sums.after += share * y.squaredNorm();
  }
  return sums;
}

// Mean square distance from turned or reflected samples to their images, in that of the samples.
double Patches::residual(const Moments& sums, double parity) {
  const Matrix3 fit = nearest_orthogonal(sums.products, parity);
  return std::max(0.0, sums.before + sums.after - 2 * fit.cwiseProduct(sums.products).sum()) /
         sums.before;
}

PatchChange Patches::change(const std::vector<Index>& images) const {
  PatchChange change;
  double reflected = 0, turned = 0;
  for (Index j = 0; j < samples_.count(); ++j) {
    const Moments sums = moments(patches_[j], images);
    if (!(sums.before > 0)) continue;
    const double by_reflection = residual(sums, -1);
    change.bending += samples_.weights[j] * std::sqrt(by_reflection);
    reflected += samples_.weights[j] * by_reflection;
    turned += samples_.weights[j] * residual(sums, 1);
  }
  if (reflected + turned > rounding)
    change.handedness = (turned - reflected) / (turned + reflected);
  return change;
}

std::vector<Eigen::Isometry3d> Patches::reflections(const std::vector<Index>& images) const {
  std::vector<Eigen::Isometry3d> fitted;
  for (const std::vector<Member>& patch : patches_) {
    const Moments sums = moments(patch, images);
    fitted.push_back(map_taking(nearest_orthogonal(sums.products, -1), sums.mean, sums.image));
  }
  return fitted;
}

Index Patches::image(const std::vector<Eigen::Isometry3d>& reflections, Index vertex) const {
  const Vector3 x = surface_.points.row(vertex).transpose();
  Vector3 sum = Vector3::Zero();
  double weights = 0;
  for (Index j = 0; j < samples_.count(); ++j) {
    const double weight = biweight(samples_.to_all(vertex, j) / radii_[j]);
    if (weight == 0) continue;
    weights += weight;
    sum += weight * (reflections[j] * x);
  }
  return vertices_
      .nearest(weights > 0 ? Vector3(sum / weights) : reflections[samples_.nearest[vertex]] * x)
      .index;
}

std::vector<Index> Patches::refined(std::vector<Index> images, int rounds) const {
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Eigen::Isometry3d> fitted = reflections(images);
    for (Index i = 0; i < samples_.count(); ++i) images[i] = image(fitted, samples_.vertices[i]);
  }
  return images;
}

Patches::Extended Patches::extended(const std::vector<Index>& images,
                                    const Context& context) const {
  Extended map;
  map.patches_ = this;
  map.reflections_ = reflections(images);
  map.images_.resize(surface_.points.rows());
  parallel_for(context, surface_.points.rows(), 256, [&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) map.images_[v] = image(map.reflections_, v);
  });
  return map;
}

Vector3 Patches::Extended::image(const Vector3& x, Index vertex) const {
  const Points& points = patches_->surface_.points;
  const Vector3 off = x - points.row(vertex).transpose();
  return points.row(images_[vertex]).transpose() +
         reflections_[patches_->samples_.nearest[vertex]].linear() * off;
}

}  // namespace symsurf
