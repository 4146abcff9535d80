#include "fixed_direction/surface_refinement.h"

#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace symsurf {

namespace {

constexpr double least_displacement = 1.5;  // spacings
constexpr double reach = 3;                 // spacings from an image to its partner
constexpr std::size_t least_matches = 12;
constexpr double far_gap = 6;        // median gaps
constexpr double least_limit = 0.2;  // spacings: patches of sparse surfaces are wrong by as much
constexpr double turn_gain = 3;      // nearest neighbours see only part of a turn
constexpr double longest_turn = 0.05;
constexpr double node_spacing = 0.6;  // spacings
constexpr Index start_neighbours = 40, round_neighbours = 28;
const std::vector<Index> offered_neighbours{16, 28, 50, 90, 160, 280};

struct Frame {
  explicit Frame(const Vector3& v) : across(orthogonal_to(v)), direction(v) {}
  Vector3 to_frame(const Vector3& x) const {
    Vector3 y;
    y << across.transpose() * x, direction.dot(x);
    return y;
  }
  Points to_frame(const Points& x) const {
    Points y(x.rows(), 3);
    y.leftCols<2>() = x * across;
    y.col(2) = x * direction;
    return y;
  }
  Points from_frame(const Points& y) const {
    return y.leftCols<2>() * across.transpose() + y.col(2) * direction.transpose();
  }
  Eigen::Matrix<double, 3, 2> across;
  Vector3 direction;
};

}  // namespace

SurfaceRefinement::SurfaceRefinement(const SurfacePoints& cloud, const SurfacePatches& patches,
                                     const Context& context)
    : cloud_(cloud), patches_(patches), context_(context), votes_(cloud, context, 1.5) {}

FieldEstimate SurfaceRefinement::voted(const Vector3& direction, double scatter) {
  votes_.support(direction, scatter);
  const Frame frame(direction);
  std::vector<HeightObservation> observations;
  for (const MidSurface::Chord& c : votes_.chords()) {
    const Vector3 y = frame.to_frame(Vector3((cloud_.point(c.low) + cloud_.point(c.high)) / 2));
    observations.push_back({y.head<2>(), y.z(), c.weight});
  }
  if (observations.size() < least_matches) return {};
  const HeightRegression regression(std::move(observations), context_);
  return {direction, frame.from_frame(regression.fitted(votes_.cells(), start_neighbours))};
}

SurfaceRefinement::Matches SurfaceRefinement::matches(const FieldEstimate& estimate) const {
  const Vector3& v = estimate.direction;
  const HeightField field(v, estimate.nodes, context_);
  const double far = reach * cloud_.spacing;
  struct Match {
    Index point, partner;
    double distance;  // of the point from the surface
    double gap;       // from the image along the direction to the partner's surface
    Vector3 aside;    // from the image to the partner
  };
  std::vector<Match> found;
  std::vector<double> gaps;
  double moved = 0;
  for (Index i = 0; i < cloud_.size(); ++i) {
    context_.check();
    const Vector3 x = cloud_.point(i);
    const double distance = field.signed_distance(x);
    if (std::abs(distance) * 2 < least_displacement * cloud_.spacing) continue;
    ++moved;
    const Vector3 image = x - 2 * distance * v;
    const Index j = cloud_.tree.nearest(image, far * far).index;
    if (j < 0) continue;
    const bool same_side = distance * (v.dot(cloud_.point(j) - x) + distance) >= 0;
    const double gap = patches_.along(j, image, v);
    if (same_side || !(std::abs(gap) <= far)) continue;
    found.push_back({i, j, distance, gap, cloud_.point(j) - image});
    gaps.push_back(std::abs(gap));
  }

  Matches result;
  if (found.size() < least_matches) return result;
  const double typical = far_gap * median(gaps);
  const Frame frame(v);
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();
  double lever = 0;
  for (const Match& m : found) {
    const double limit = std::max(typical, least_limit * cloud_.spacings[m.partner]);
    const double robust = biweight(std::abs(m.gap) / limit);
    if (!(robust > 0)) continue;
    result.support += robust / moved;
    // Heights are as uncertain as the surfaces are steep.
    const double here = std::abs(patches_.normal(m.point).dot(v));
    const double there = std::abs(patches_.normal(m.partner).dot(v));
    const double square = here * there / std::hypot(here, there);
    const Vector3 y = frame.to_frame(cloud_.point(m.point));
    result.observations.push_back(
        {y.head<2>(), y.z() - m.distance + m.gap / 2, robust * square * square});
    // The image moves by -2 distance along a turn of the direction.
    const double arm = -2 * m.distance;
    pull += robust * square * arm * (frame.across.transpose() * m.aside);
    lever += robust * square * arm * arm;
  }
  if (lever > 0) result.turn = turn_gain * pull / lever;
  return result;
}

void SurfaceRefinement::refit(FieldEstimate& estimate, Matches found) const {
  const Frame frame(estimate.direction);
  const HeightRegression regression(std::move(found.observations), context_);
  estimate.nodes =
      frame.from_frame(regression.fitted(frame.to_frame(estimate.nodes), round_neighbours));
  Eigen::Vector2d step = found.turn;
  if (step.norm() > longest_turn) step *= longest_turn / step.norm();
  estimate.direction = (estimate.direction + frame.across * step).normalized();
}

FieldEstimate SurfaceRefinement::operator()(const Vector3& direction, double scatter, int rounds) {
  FieldEstimate estimate = voted(direction, scatter);
  for (int round = 1; round <= rounds && estimate.nodes.rows() > 0; ++round) {
    Matches found = matches(estimate);
    estimate.support = found.support;
    if (found.observations.size() < least_matches) return {};
    if (round < rounds) {
      refit(estimate, std::move(found));
      continue;
    }
    const Frame frame(estimate.direction);
    const HeightRegression regression(std::move(found.observations), context_);
    const Index neighbours = regression.best_neighbours(offered_neighbours);
    estimate.nodes = frame.from_frame(
        regression.fitted(regression.thinned_positions(node_spacing * cloud_.spacing), neighbours));
  }
  return estimate;
}

}  // namespace symsurf
