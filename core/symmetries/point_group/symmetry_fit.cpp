#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "pairing/correspondence.h"
#include "point_group/symmetry_search.h"

namespace symsurf {

Eigen::Isometry3d GroupPose::placed(const Matrix3& element) const {
  return map_taking(axes * element * axes.transpose(), centre, centre);
}

GroupPose GroupPose::along(const Vector3& z, const Vector3& centre) {
  GroupPose pose;
  pose.axes << orthogonal_to(z), z;
  if (pose.axes.determinant() < 0) pose.axes.col(0) *= -1;
  pose.centre = centre;
  return pose;
}

PosedElement::PosedElement(const GroupPose& pose, const Matrix3& element)
    : pose_(pose), element_(element), map_(pose.placed(element)) {}

Eigen::Matrix<double, 3, 6> PosedElement::slopes(const Vector3& x) const {
  const Matrix3& turn = map_.linear();
  Eigen::Matrix<double, 3, 6> slopes;
  slopes << turn * cross_matrix(x - pose_.centre) - cross_matrix(reflect(x) - pose_.centre),
      Matrix3::Identity() - turn;
  return slopes;
}

std::pair<PosedElement, double> PosedElement::stepped(const Change& by) const {
  constexpr double longest = 0.2;  // radians, diagonals: what is longer is no small turn
  const double length = by.norm();
  const Change cut = length > longest ? Change(longest / length * by) : by;
  GroupPose next = pose_;
  next.axes = turn_by(cut.head<3>()) * pose_.axes;
  next.centre += cut.tail<3>();
  return {{next, element_}, std::min(length, longest)};
}

namespace {

std::vector<PosedElement> posed(const GroupPose& pose, const std::vector<Matrix3>& elements) {
  std::vector<PosedElement> all;
  for (const Matrix3& element : elements) all.emplace_back(pose, element);
  return all;
}

}  // namespace

SymmetryFit::SymmetryFit(const Cloud& cloud, const NearestPoints& points, const Surfels& coarse,
                         const Surfels& fine)
    : cloud_(cloud),
      points_(points),
      coarse_(coarse),
      fine_(fine),
      map_(coarse),
      refinement_(cloud, points, coarse, fine) {}

GroupPose SymmetryFit::roughly(const GroupPose& pose, const std::vector<Matrix3>& elements) const {
  constexpr std::size_t looked = 600;
  const std::size_t stride = std::max<std::size_t>(1, elements.size() * coarse_.size() / looked);
  const PatchMatcher patches(coarse_, map_, static_cast<Index>(stride));
  return fitted(posed(pose, elements), patches, {0.06, 0.015, 6}, patches.kernel())
      .maps.front()
      .pose();
}

GroupPose SymmetryFit::closely(const GroupPose& pose, const std::vector<Matrix3>& elements,
                               std::size_t looked) const {
  const double narrowest = std::max(0.004, refinement_.noise().deviation());  // none agrees closer
  return refinement_
      .fitted(posed(pose, elements), {.samples = static_cast<Index>(looked / elements.size()),
                                      .tolerance = 0.015,
                                      .steps = 6,
                                      .narrowest = narrowest})
      .front()
      .pose();
}

double SymmetryFit::support(const GroupPose& pose, const Matrix3& element, double tolerance) const {
  constexpr double least_moved = 0.2;
  return support_share(coarse_, map_, PosedElement(pose, element), tolerance, 1, 0, least_moved);
}

// As near as noise and the spacing of the points let images come to it.
std::vector<bool> SymmetryFit::on_surface(const std::vector<Vector3>& images) const {
  constexpr double least = 0.008, deviations = 3, widest = 0.05;
  const double near = std::max(least, deviations * refinement_.noise().deviation());
  std::vector<Vector3> queries;
  for (const Vector3& image : images) queries.push_back(cloud_.frame.from_frame(image));
  const std::vector<Vector3> partners = points_.nearest(
      queries, std::max(widest, near + 2 * refinement_.spacing()) * cloud_.frame.size);
  std::vector<bool> found(images.size(), false);
  for (std::size_t k = 0; k < images.size(); ++k) {
    if (!partners[k].allFinite()) continue;
    const Vector3 partner = cloud_.frame.to_frame(partners[k]);
    const Surfel* surfel = refinement_.surfel_at(partner);
    found[k] = surfel && distance_past(images[k] - partner, *surfel, refinement_.spacing()) <= near;
  }
  return found;
}

double SymmetryFit::worst_window(const GroupPose& pose,
                                 const std::vector<Matrix3>& elements) const {
  constexpr std::size_t looked = 48'000;  // images
  constexpr double confirmed = 0.58;      // of the orbit: more than half, less than two of three
  constexpr Index window = 12;            // points
  const std::size_t stride =
      std::max<std::size_t>(1, elements.size() * static_cast<std::size_t>(fine_.size()) / looked);
  std::vector<Vector3> samples;
  for (Index i = 0; i < fine_.size(); i += static_cast<Index>(stride))
    samples.push_back(fine_[i].sampled);
  std::vector<double> confirming(samples.size(), 0);
  for (const Matrix3& element : elements) {
    const Eigen::Isometry3d map = pose.placed(element);
    std::vector<Vector3> images;
    for (const Vector3& x : samples) images.push_back(map * x);
    const std::vector<bool> found = on_surface(images);
    for (std::size_t k = 0; k < found.size(); ++k) confirming[k] += found[k];
  }
  const double least = confirmed * static_cast<double>(elements.size());
  const Points positions = rows_of(samples);
  const PointTree tree(positions);
  std::vector<Neighbour> near;
  double worst = 0;
  for (Index k = 0; k < positions.rows(); ++k) {
    if (confirming[k] >= least) continue;
    tree.nearest(positions.row(k).transpose(), std::min(window, positions.rows()), near);
    const auto outliers = std::count_if(
        near.begin(), near.end(), [&](const Neighbour& n) { return confirming[n.index] < least; });
    worst = std::max(worst, static_cast<double>(outliers) / static_cast<double>(near.size()));
  }
  return worst;
}

}  // namespace symsurf
