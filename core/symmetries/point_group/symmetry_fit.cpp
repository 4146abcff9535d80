#include "point_group/symmetry_fit.h"

#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "pairing/correspondence.h"

namespace symsurf {

namespace {

using Vector6 = Eigen::Vector<double, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

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

// A Gauss-Newton step of the pose: a small turn of its axes and a shift of its centre.
class SymmetryFit::Step {
 public:
  void add(const Match& match, const GroupPose& pose, const Eigen::Isometry3d& map,
           double tolerance) {
    const double moved = displaced((match.image - match.point).norm() / 2, tolerance);
    if (moved <= 0) return;
    const Vector3 gap = match.image - match.partner;
    const Correspondence correspondence(gap, map.linear() * match.own->normal, match.own->flatness,
                                        *match.other);
    const double weight = moved * correspondence.weight(tolerance);
    if (weight <= 0) return;
    const Matrix3& turn = map.linear();
    Eigen::Matrix<double, 3, 6> by;
    by << turn * cross_matrix(match.point - pose.centre) - cross_matrix(match.image - pose.centre),
        Matrix3::Identity() - turn;
    const Matrix3 metric = correspondence.metric();
    products_ += weight * by.transpose() * metric * by;
    pull_ += weight * by.transpose() * metric * gap;
  }

  // Directions that the elements leave free, as along an axis, stay as they are.
  GroupPose taken(const GroupPose& pose) const {
    constexpr double free = 1e-4;  // of the stiffest direction
    const auto [values, directions] = eigen_of(Eigen::MatrixXd(products_));
    Vector6 step = Vector6::Zero();
    if (!(values[5] > 0)) return pose;
    for (int i = 0; i < 6; ++i)
      if (values[i] > free * values[5])
        step -= directions.col(i) * directions.col(i).dot(pull_) / values[i];
    constexpr double longest = 0.2;  // radians, diagonals: what is longer is no small turn
    if (step.norm() > longest) step *= longest / step.norm();
    GroupPose next = pose;
    const double angle = step.head<3>().norm();
    if (angle > 0)
      next.axes = Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix() * pose.axes;
    next.centre += step.tail<3>();
    return next;
  }

 private:
  Matrix6 products_ = Matrix6::Zero();
  Vector6 pull_ = Vector6::Zero();
};

SymmetryFit::SymmetryFit(const Cloud& cloud, const PointTree& tree, const NearestPoints& points,
                         const Surfels& coarse, const Surfels& fine)
    : cloud_(cloud),
      points_(points),
      coarse_(coarse),
      fine_(fine),
      map_(coarse),
      noise_(measured_noise()),
      spacing_(surface_spacing(cloud.points, tree) / cloud.frame.size) {}

SurfaceNoise SymmetryFit::measured_noise() const {
  constexpr Index few_samples = 250;
  std::vector<OnSurface> samples;
  for (Index i = 0; i < fine_.size(); i += std::max<Index>(1, fine_.size() / few_samples))
    if (const Surfel* surfel = surfel_at(fine_[i].sampled))
      samples.push_back({fine_[i].sampled, surfel});
  return {samples, neighbours_of(samples, cloud_.frame, points_)};
}

std::vector<SymmetryFit::Match> SymmetryFit::on_surfels(const Eigen::Isometry3d& map,
                                                        std::size_t stride) const {
  std::vector<Match> matches;
  for (Index i = 0; i < coarse_.size(); i += static_cast<Index>(stride)) {
    const Surfel& surfel = coarse_[i];
    const Vector3 image = map * surfel.position;
    const Index j = map_.nearest(image);
    if (j >= 0)
      matches.push_back({surfel.position, image, coarse_[j].position, &surfel, &coarse_[j]});
  }
  return matches;
}

std::vector<SymmetryFit::Match> SymmetryFit::on_cloud(const Eigen::Isometry3d& map, double reach,
                                                      std::size_t stride) const {
  std::vector<Match> matches;
  std::vector<Vector3> images;
  for (Index i = 0; i < fine_.size(); i += static_cast<Index>(stride)) {
    const Vector3& x = fine_[i].sampled;
    const Surfel* own = surfel_at(x);
    if (!own) continue;
    const Vector3 smoothed = noise_.smoothed(x, *own);
    matches.push_back({smoothed, map * smoothed, x, own, nullptr});
    images.push_back(cloud_.frame.from_frame(map * x));
  }
  const std::vector<Vector3> partners = points_.nearest(images, reach * cloud_.frame.size);
  for (std::size_t k = 0; k < matches.size(); ++k) {
    if (!partners[k].allFinite()) continue;
    const Vector3 partner = cloud_.frame.to_frame(partners[k]);
    matches[k].other = surfel_at(partner);
    if (matches[k].other) matches[k].partner = noise_.smoothed(partner, *matches[k].other);
  }
  std::erase_if(matches, [](const Match& match) { return !match.other; });
  return matches;
}

GroupPose SymmetryFit::roughly(GroupPose pose, const std::vector<Matrix3>& elements) const {
  constexpr std::size_t looked = 600;
  const std::size_t stride = std::max<std::size_t>(1, elements.size() * coarse_.size() / looked);
  for (const double tolerance : {0.06, 0.045, 0.03, 0.022, 0.015, 0.015}) {
    Step step;
    for (const Matrix3& element : elements) {
      const Eigen::Isometry3d map = pose.placed(element);
      for (const Match& match : on_surfels(map, stride)) step.add(match, pose, map, tolerance);
    }
    pose = step.taken(pose);
  }
  return pose;
}

GroupPose SymmetryFit::closely(GroupPose pose, const std::vector<Matrix3>& elements,
                               std::size_t looked) const {
  const std::size_t stride = std::max<std::size_t>(1, elements.size() * fine_.size() / looked);
  for (const double narrow : {0.015, 0.01, 0.006, 0.006, 0.004, 0.004}) {
    const double tolerance = std::max(narrow, noise_.deviation());  // noise agrees no closer
    Step step;
    for (const Matrix3& element : elements) {
      const Eigen::Isometry3d map = pose.placed(element);
      for (const Match& match : on_cloud(map, 3 * tolerance, stride))
        step.add(match, pose, map, tolerance);
    }
    pose = step.taken(pose);
  }
  return pose;
}

double SymmetryFit::support(const GroupPose& pose, const Matrix3& element, double tolerance) const {
  constexpr double least_moved = 0.2;  // of the surfels
  const Eigen::Isometry3d map = pose.placed(element);
  double all = 0, supported = 0;
  for (Index i = 0; i < coarse_.size(); ++i) {
    const Surfel& surfel = coarse_[i];
    const Vector3 image = map * surfel.position;
    const double moved = displaced((image - surfel.position).norm() / 2, tolerance);
    all += moved;
    const Index j = map_.nearest(image);
    if (moved <= 0 || j < 0) continue;
    const Correspondence correspondence(image - coarse_[j].position, map.linear() * surfel.normal,
                                        surfel.flatness, coarse_[j]);
    supported += moved * correspondence.weight(tolerance);
  }
  return supported / std::max(all, least_moved * static_cast<double>(coarse_.size()));
}

// As near as noise and the spacing of the points let images come to it.
std::vector<bool> SymmetryFit::on_surface(const std::vector<Vector3>& images) const {
  constexpr double least = 0.008, deviations = 3, widest = 0.05;
  const double near = std::max(least, deviations * noise_.deviation());
  std::vector<Vector3> queries;
  for (const Vector3& image : images) queries.push_back(cloud_.frame.from_frame(image));
  const std::vector<Vector3> partners =
      points_.nearest(queries, std::max(widest, near + 2 * spacing_) * cloud_.frame.size);
  std::vector<bool> found(images.size(), false);
  for (std::size_t k = 0; k < images.size(); ++k) {
    if (!partners[k].allFinite()) continue;
    const Vector3 partner = cloud_.frame.to_frame(partners[k]);
    const Surfel* surfel = surfel_at(partner);
    found[k] = surfel && distance_past(images[k] - partner, *surfel, spacing_) <= near;
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
