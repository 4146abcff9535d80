#include "point_group/coloured_surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

namespace {

constexpr Index most_samples = 20'000;  // a window of them is some 0.06 % of the surface
constexpr Index window = 12;            // samples next to each other, as of the shape itself
constexpr Index around = 8;  // of these an image may fall on: the ring around the nearest one
// A set as landmarks and atoms are, whose elements map each point onto one: neighbours differ.
constexpr Index most_points_of_set = 1000;

// Of the widest range of a channel: less is not seen as a difference.
constexpr double least_contrast = 0.1;
constexpr double near_enough = 0.75;  // of the radius of a window: farther off is a hole
constexpr double usual_share = 0.9;   // of the samples whose neighbours say how much noise there is
// Samples on a face: on fewer, how the face divides the surface says what lies between its corners.
constexpr double small_face = 30;
// Of a window, samples whose colour is another: at an edge of colours a third of them may seem so.
constexpr double most_unlike = 0.6;

}  // namespace

ColouredSurface::ColouredSurface(PointsView points, TrianglesView faces,
                                 const Eigen::MatrixXd& colours, const Context& context)
    : context_(context) {
  if (!faces.empty()) sample_faces(points, faces, colours);
  if (size() == 0) sample_points(points, colours);  // or no face has an area
  const double range = (colours_.rowwise().maxCoeff() - colours_.rowwise().minCoeff()).maxCoeff();
  if (range > 0) {
    colours_ /= range;
    spread_ /= range;
  }
  tree_ = std::make_unique<const PointTree>(points_, context);
  const bool is_set = faces.empty() && points.size() <= most_points_of_set;
  near_.resize(is_set ? 1 : std::min(window, size()), size());
  std::vector<double> noise;
  std::vector<Neighbour> found;
  for (Index i = 0; i < size(); ++i) {
    context.check();
    tree_->nearest(points_.row(i).transpose(), near_.rows(), found);
    double least = infinity;
    for (Index k = 0; k < near_.rows(); ++k) {
      near_(k, i) = static_cast<std::int32_t>(found[k].index);
      if (k > 0 && k < around) least = std::min(least, difference(i, found[k].index));
    }
    noise.push_back(is_set ? 0 : least);
    reach_.push_back(is_set ? infinity : near_enough * std::sqrt(found.back().squared_distance));
  }
  limit_ = least_contrast + quantile(noise, usual_share);
}

void ColouredSurface::sample_points(PointsView points, const Eigen::MatrixXd& colours) {
  std::vector<Index> chosen;
  const PointTree tree(points, context_);
  const Index stride = 1 + (points.size() - 1) / most_samples;
  for (Index k = 0; k < points.size(); k += stride)
    if (const Index i = tree.order()[k]; points[i].allFinite()) chosen.push_back(i);
  points_ = points.matrix()(chosen, Eigen::indexing::all);
  colours_ = colours(chosen, Eigen::indexing::all).transpose();
  spread_.setZero(size());
}

void ColouredSurface::sample_faces(PointsView points, TrianglesView faces,
                                   const Eigen::MatrixXd& colours) {
  std::vector<double> areas;
  for (Index f = 0; f < faces.size(); ++f) {
    const Vector3 x = points[faces[f][0]];
    const double area = (points[faces[f][1]] - x).cross(points[faces[f][2]] - x).norm() / 2;
    areas.push_back(std::isfinite(area) ? area : 0);
  }
  const std::vector<FaceSample> samples = even_face_samples(areas, most_samples);
  points_.resize(static_cast<Index>(samples.size()), 3);
  colours_.resize(colours.cols(), size());
  spread_.setZero(size());
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  for (Index k = 0; k < size(); ++k) {
    const auto& [face, down, along] = samples[k];
    const Vector3 weights(1 - down, down * (1 - along), down * along);
    const Eigen::Map<const Eigen::Vector<Index, 3>> corners(faces[face]);
    points_.row(k) = weights.transpose() * points.matrix()(corners, Eigen::indexing::all);
    const Eigen::MatrixXd of_corners = colours(corners, Eigen::indexing::all).transpose();
    colours_.col(k) = of_corners * weights;
    if (areas[face] < small_face * area / most_samples)
      spread_[k] = (of_corners.colwise() - colours_.col(k)).colwise().norm().maxCoeff();
  }
}

double ColouredSurface::least_difference(Index sample, const Vector3& image) const {
  thread_local std::vector<Neighbour> found;
  tree_->nearest(image, std::min(around, near_.rows()), found);
  if (std::sqrt(found.front().squared_distance) > reach_[found.front().index]) return 0;  // a hole
  double least = infinity;
  for (const Neighbour& other : found)
    least =
        std::min(least, difference(sample, other.index) - spread_[sample] - spread_[other.index]);
  return least;
}

bool ColouredSurface::is_kept_by(const Eigen::Isometry3d& map) const {
  constexpr Index spread = 7919, grain = 256;  // a prime: differences are soon met
  std::atomic<bool> is_kept = true;
  const auto is_unlike = [&](Index i) {
    return least_difference(i, map * Vector3(points_.row(i).transpose())) > limit_;
  };
  parallel_for(context_, size(), grain, [&](Index begin, Index end) {
    for (Index k = begin; k < end && is_kept; ++k) {
      const Index i = size() % spread == 0 ? k : k * spread % size();
      if (!is_unlike(i)) continue;
      const auto near = near_.col(i);
      const auto unlike = static_cast<double>(std::count_if(near.begin(), near.end(), is_unlike));
      if (unlike > most_unlike * static_cast<double>(near.size())) is_kept = false;
    }
  });
  return is_kept;
}

double ColouredSurface::mean_difference(const Eigen::Isometry3d& map, Index looked) const {
  const Index stride = std::max<Index>(1, size() / looked), count = (size() - 1) / stride + 1;
  constexpr Index grain = 512;
  return parallel_sum(context_, count, grain, 0.0,
                      [&](Index begin, Index end) {
                        double sum = 0;
                        for (Index k = begin; k < end; ++k) {
                          const Index i = k * stride;
                          const Index other =
                              tree_->nearest(map * Vector3(points_.row(i).transpose())).index;
                          sum += difference(i, other);
                        }
                        return sum;
                      }) /
         static_cast<double>(count);
}

// A number for each colour: how far it is from the one farthest from the mean.
Eigen::VectorXd ColouredSurface::values() const {
  Index farthest;
  (colours_.colwise() - colours_.rowwise().mean()).colwise().squaredNorm().maxCoeff(&farthest);
  const Eigen::VectorXd extreme = colours_.col(farthest);
  return (colours_.colwise() - extreme).colwise().norm().transpose();
}

Points ColouredSurface::relief(const Vector3& centre) const {
  constexpr double height = 0.25;
  const Eigen::VectorXd value = values();
  const Eigen::VectorXd factor = (1 + height / value.maxCoeff() * value.array()).matrix();
  return (factor.asDiagonal() * (points_.rowwise() - centre.transpose())).rowwise() +
         centre.transpose();
}

std::vector<Vector3> ColouredSurface::principal_directions(const Vector3& centre) const {
  Eigen::VectorXd value = values();
  value.array() -= value.mean();
  Eigen::VectorXd contrast(size());
  for (Index i = 0; i < size(); ++i)
    contrast[i] = (value(near_.col(i)).array() - value[i]).abs().maxCoeff();
  const Points arms = points_.rowwise() - centre.transpose();
  std::vector<Vector3> found;
  for (const Eigen::VectorXd& weight : {value, contrast}) {
    const Matrix3 vectors =
        eigen_of(Matrix3(arms.transpose() * weight.asDiagonal() * arms)).vectors;
    for (const Vector3 direction : vectors.colwise()) found.push_back(direction);
  }
  if (const Vector3 pole = arms.transpose() * value; pole.norm() > 0)
    found.push_back(pole.normalized());
  return found;
}

}  // namespace symsurf
