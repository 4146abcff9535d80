#include "methods/height_field/surface_refinement.h"

#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/least_squares.h"
#include "base/math.h"

namespace symsurf {

namespace {

constexpr Index rim_neighbours = 24, looked_at = 56;
constexpr double on_the_rim = 0.42;   // lean
constexpr double least_lean = 0.2;    // chance leans as much inside a surface
constexpr double lean_a_reach = 0.5;  // that is lost going inwards
constexpr double same_surface = 0.6;  // cosine between normals
constexpr double thickness = 0.35;    // of a surface, against the reach
constexpr double end_on = 0.1;        // sine below which a rim is seen end-on

constexpr double inside = 0.6;             // reaches, of a point that sees no rim
constexpr double near_rim = 0.5;           // reaches
constexpr double opposed = 1.2;            // sum of the inward directions of two different rims
constexpr double prior_turn = 0.1;         // radians
constexpr double prior_difference = 0.02;  // diagonals

}  // namespace

SurfaceRims::SurfaceRims(const SurfacePoints& cloud)
    : cloud_(cloud), lean_(Points::Zero(cloud.size(), 3)), reach_(cloud.size()) {
  std::vector<Neighbour> near;
  for (Index i = 0; i < cloud.size(); ++i) {
    const Vector3 normal = cloud.normal(i);
    cloud.tree.nearest(cloud.point(i), looked_at, near);
    Vector3 sum = Vector3::Zero();
    Index count = 0;
    for (const Neighbour& n : near) {
      const Vector3 d = cloud.point(n.index) - cloud.point(i);
      const double off = normal.dot(d);
      const double far = std::sqrt(n.squared_distance);
      if (n.index == i || std::abs(off) > std::max(thickness * far, 0.5 * cloud.spacing) ||
          std::abs(normal.dot(cloud.normal(n.index))) < same_surface)
        continue;
      sum += d - off * normal;
      reach_[i] = far;
      if (++count == rim_neighbours) break;
    }
    if (count > 0) lean_.row(i) = (sum / static_cast<double>(count) / reach_[i]).transpose();
  }
}

bool SurfaceRims::seen_across(Index i, const Eigen::Matrix<double, 3, 2>& across, Rim& rim) const {
  const Vector3 lean = lean_.row(i).transpose();
  const double size = lean.norm();
  if (size < least_lean) return false;
  const Vector3 inwards = lean / size;
  const Eigen::Vector2d along = across.transpose() * cloud_.normal(i).cross(inwards);
  const double length = along.norm();
  if (!(length > end_on)) return false;
  const Eigen::Vector2d flat = across.transpose() * inwards;
  const Eigen::Vector2d square = flat - along * (along.dot(flat) / (length * length));
  const double shortened = square.norm();
  if (!(shortened > end_on)) return false;
  rim.inwards = square / shortened;
  rim.reach = reach_[i] * shortened;
  rim.distance = std::max(0.0, (on_the_rim - size) / lean_a_reach) * rim.reach;
  return true;
}

void RimAlignment::add(Index point, Index partner, const Eigen::Vector2d& aside, double arm,
                       double weight) {
  SurfaceRims::Rim own, other;
  const bool own_seen = rims_.seen_across(point, across_, own);
  const bool other_seen = rims_.seen_across(partner, across_, other);
  if (!own_seen && !other_seen) return;
  if (!own_seen) own = {other.inwards, inside * other.reach, other.reach};
  if (!other_seen) other = {own.inwards, inside * own.reach, own.reach};
  Eigen::Vector2d inwards = own.inwards + other.inwards;
  if (inwards.norm() < opposed) return;
  inwards.normalize();
  const double reach = (own.reach + other.reach) / 2;
  const double image = other.distance - (other_seen ? inwards.dot(aside) : 0.0);
  if (image + own.distance > 2 * near_rim * reach) return;
  Vector3 row;
  row << arm * inwards, std::copysign(prior_difference, arm);
  weight /= reach * reach;
  normal_ += weight * row * row.transpose();
  right_ -= weight * (image - own.distance) * row;
}

Eigen::Vector2d RimAlignment::turn(const Eigen::Vector2d& start) const {
  constexpr double prior = 1 / (prior_turn * prior_turn);
  Matrix3 normal = normal_;
  normal.diagonal() += Vector3(prior, prior, 1);
  Vector3 right = right_;
  right.head<2>() += prior * start;
  return solved(normal, right).head<2>();
}

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
  std::optional<RimAlignment> rims;
  if (rims_) rims.emplace(*rims_, frame.across);
  for (const Match& m : found) {
    const double limit = std::max(typical, least_limit * cloud_.spacings[m.partner]);
    const double robust = biweight(std::abs(m.gap) / limit);
    if (!(robust > 0)) continue;
    result.support += robust / moved;
    // Heights are as uncertain as the surfaces are steep, and surfaces as their points are sparse.
    const double here = std::abs(patches_.normal(m.point).dot(v));
    const double there = std::abs(patches_.normal(m.partner).dot(v));
    const double square = here * there / std::hypot(here, there);
    const double density = std::pow(cloud_.spacing / cloud_.spacings[m.partner], 4);
    const Vector3 y = frame.to_frame(cloud_.point(m.point));
    result.observations.push_back(
        {y.head<2>(), y.z() - m.distance + m.gap / 2, robust * square * square * density});
    // The image moves by -2 distance along a turn of the direction.
    const double arm = -2 * m.distance;
    pull += robust * square * arm * (frame.across.transpose() * m.aside);
    lever += robust * square * arm * arm;
    if (rims)
      rims->add(m.point, m.partner, frame.across.transpose() * m.aside, arm, robust * square);
  }
  if (rims)
    result.turn = rims->turn(frame.across.transpose() * start_);
  else if (lever > 0)
    result.turn = turn_gain * pull / lever;
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
  start_ = direction;
  if (std::isfinite(scatter))
    rims_.reset();
  else
    rims_.emplace(cloud_);
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
    HeightRegression regression(std::move(found.observations), context_);
    regression.reject_outliers(round_neighbours);
    const Index neighbours = regression.best_neighbours(offered_neighbours);
    estimate.nodes = frame.from_frame(
        regression.fitted(regression.thinned_positions(node_spacing * cloud_.spacing), neighbours));
  }
  return estimate;
}

}  // namespace symsurf
