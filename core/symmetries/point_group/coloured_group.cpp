#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "point_group/point_group.h"
#include "point_group/symmetry_search.h"
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

namespace {

struct PlacedGroup {
  PointGroup group;
  GroupPose pose;
};

class ColouredAxis {
 public:
  ColouredAxis(const ColouredSurface& surface, const Vector3& axis, const Vector3& centre)
      : surface_(surface), pose_(GroupPose::along(axis, centre)), order_(order()) {}

  // How many elements its group may have at most.
  double most_elements() const { return order_ == 0 ? infinity : 4 * static_cast<double>(order_); }

  // With what the shape has beside its turns about the axis, where the colours have it.
  PlacedGroup group(const AxialElements& shape) {
    AxialElements has;
    const Matrix3 across = reflection(Vector3::UnitZ());
    has.across = shape.across && keeps(across);
    has.rotary =
        shape.across && !has.across && order_ > 0 &&
        keeps(turn(Vector3::UnitZ(), std::numbers::pi / static_cast<double>(order_)) * across);
    has.vertical = shape.vertical && turned_to(reflection(Vector3::UnitX()));
    has.twofold =
        shape.twofold && !has.vertical && turned_to(turn(Vector3::UnitX(), std::numbers::pi));
    return {axial_group(order_, has), pose_};
  }

 private:
  bool keeps(const Matrix3& element) const { return surface_.is_kept_by(pose_.placed(element)); }

  // Of the turns; 0: any.
  Index order() const {
    constexpr int some = 8;
    constexpr Index largest = 64, most = 128;  // as of shapes
    const auto all_kept = [&](const std::vector<Matrix3>& turns) {
      return std::all_of(turns.begin(), turns.end(),
                         [&](const Matrix3& each) { return keeps(each); });
    };
    if (all_kept(any_turns(Vector3::UnitZ(), some))) return 0;
    Index order = 1;
    for (const Index prime : {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31})
      for (Index power = prime; power <= largest && order * prime <= most; power *= prime) {
        if (!all_kept(turns_of(power))) break;
        order *= prime;
      }
    return order;
  }

  // Turns the pose about its axis to where an element with its axis or normal along x keeps the
  // colours; false: nowhere.
  bool turned_to(const Matrix3& element) {
    if (order_ == 0) return keeps(element);
    constexpr double step = 0.0175;    // radians: a degree, that samples lie apart
    constexpr double finest = 0.0005;  // radians
    constexpr Index looked = 5000;     // samples at each step
    constexpr std::size_t most = 4;    // minima
    const double period = std::numbers::pi / static_cast<double>(order_);
    const auto at = [&](double angle) {
      GroupPose pose = pose_;
      pose.axes = turn(pose_.axes.col(2), angle) * pose_.axes;
      return pose;
    };
    const auto difference = [&](double angle, Index count) {
      return surface_.mean_difference(at(angle).placed(element), count);
    };
    std::vector<std::pair<double, double>> starts;
    for (double angle = 0; angle < period; angle += step)
      starts.emplace_back(difference(angle, looked), angle);
    std::stable_sort(starts.begin(), starts.end());
    suppress_non_maxima(starts, most, [&](const auto& a, const auto& b) {
      const double apart = std::abs(a.second - b.second);
      return std::min(apart, period - apart) < 4 * step;
    });
    for (auto [least, angle] : starts) {
      least = difference(angle, surface_.size());
      for (double reach = step / 2; reach > finest; reach /= 2)
        for (const double other : {angle - reach, angle + reach})
          if (const double there = difference(other, surface_.size()); there < least) {
            least = there;
            angle = other;
          }
      if (!surface_.is_kept_by(at(angle).placed(element))) continue;
      pose_ = at(angle);
      return true;
    }
    return false;
  }

  const ColouredSurface& surface_;
  GroupPose pose_;
  Index order_;
};

// The elements that keep the colours, less those that make none of a group with the rest.
PlacedGroup kept_elements(const Symmetries& found, const ColouredSurface& surface) {
  std::vector<Matrix3> kept, generators;
  GroupPose pose;
  pose.centre = found.centre;
  for (const Matrix4& element : found.elements)
    if (surface.is_kept_by(Eigen::Isometry3d(element)))
      kept.push_back(element.topLeftCorner<3, 3>());
  std::vector<Matrix3> elements{Matrix3::Identity()};
  for (const Matrix3& element : kept) {
    if (contains(elements, element)) continue;
    generators.push_back(element);
    std::vector<Matrix3> more = closed(generators);
    if (std::all_of(more.begin(), more.end(),
                    [&](const Matrix3& each) { return contains(kept, each); }))
      elements = std::move(more);
    else
      generators.pop_back();
  }
  return {PointGroup(std::move(elements)), pose};
}

// A sphere's: that of the colours as a relief, or that about one of its axes or a principal
// direction, the largest.
PlacedGroup group_of_sphere(const Symmetries& found, const ColouredSurface& surface,
                            const Context& context) {
  constexpr AxialElements all{.across = true, .vertical = true, .twofold = true};
  constexpr double least_score = 0.7;  // as of shapes
  const bool any_turn = std::all_of(found.axes.begin(), found.axes.end(), [&](const auto& axis) {
    return ColouredAxis(surface, axis.direction, found.centre).most_elements() == infinity;
  });
  if (any_turn) return {spherical_group(), {}};
  const Points relief = surface.relief(found.centre);
  const Symmetries raised = search_symmetries(
      checked_cloud(relief, {}, 4, context), least_score,
      [&](const Symmetries& group) {
        return std::all_of(group.elements.begin(), group.elements.end(), [&](const Matrix4& each) {
          return surface.is_kept_by(Eigen::Isometry3d(each));
        });
      },
      context);
  std::vector<Vector3> directions = surface.principal_directions(found.centre);
  for (const SymmetryAxis& axis : raised.axes) directions.push_back(axis.direction);
  suppress_non_maxima(directions, directions.size(), [](const Vector3& a, const Vector3& b) {
    constexpr double same = 0.01;  // radians
    return are_parallel(a, b, same);
  });
  const auto size = [](const PlacedGroup& placed) {
    return placed.group.continuous ? infinity : static_cast<double>(placed.group.elements.size());
  };
  PlacedGroup best = kept_elements(raised, surface);
  for (const Vector3& direction : directions) {
    ColouredAxis axis(surface, direction, found.centre);
    if (axis.most_elements() <= size(best)) continue;
    PlacedGroup other = axis.group(all);
    if (size(other) > size(best)) best = std::move(other);
  }
  return best;
}

}  // namespace

Symmetries coloured_group(const Symmetries& found, const ColouredSurface& surface,
                          const Context& context) {
  const auto has_plane = [&](bool across) {
    return std::any_of(found.planes.begin(), found.planes.end(), [&](const Plane& plane) {
      return (std::abs(plane.normal().dot(found.axes.front().direction)) > 0.5) == across;
    });
  };
  PlacedGroup kept;
  if (found.axes.empty() || found.axes.front().order != 0)
    kept = kept_elements(found, surface);
  else if (found.group == "K")
    kept = group_of_sphere(found, surface, context);
  else
    kept = ColouredAxis(surface, found.axes.front().direction, found.centre)
               .group({.across = has_plane(true),
                       .vertical = has_plane(false),
                       .twofold = found.axes.size() > 1});
  if (kept.group.name == found.group) return found;
  return described(kept.group, kept.pose, {.support = found.score, .missing = found.missing}, {});
}

}  // namespace symsurf
