#include <symsurf/mirrors.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "fixed_direction/fixed_direction.h"

namespace symsurf {

namespace {

constexpr Index most_left_out = 300;  // observations that cross-validation predicts
// Partners share patches, so that neighbours err together: prediction flatters few of them.
constexpr double tolerated_error = 1.25;  // of the least
constexpr double curvature_ridge = 1e-4;
constexpr Index stretch = 256;  // fits, of some ten microseconds

}  // namespace

HeightRegression::HeightRegression(std::vector<HeightObservation> observations,
                                   const Context& context)
    : observations_(std::move(observations)), context_(context), tree_(positions()) {}

Points HeightRegression::positions() const {
  Points positions(static_cast<Index>(observations_.size()), 3);
  for (Index i = 0; i < positions.rows(); ++i)
    positions.row(i) << observations_[i].position.x(), observations_[i].position.y(), 0;
  return positions;
}

Points HeightRegression::thinned_positions(double distance) const {
  const Points all = positions();
  std::vector<char> covered(all.rows(), 0);
  std::vector<Index> kept;
  for (Index i = 0; i < all.rows(); ++i) {
    if (covered[i]) continue;
    kept.push_back(i);
    tree_.within(all.row(i).transpose(), distance, [&](Index j, double) { covered[j] = 1; });
  }
  return all(kept, Eigen::indexing::all);
}

double HeightRegression::height(const Eigen::Vector2d& position, std::span<const Neighbour> near,
                                Index left_out) const {
  const double radius = std::sqrt(near.back().squared_distance) * 1.0001;
  if (!(radius > 0)) return observations_[near.front().index].height;

  QuadraticFit fit;
  const double level = observations_[near.front().index].height;
  for (const Neighbour& n : near) {
    if (n.index == left_out) continue;
    const HeightObservation& o = observations_[n.index];
    const double d = std::sqrt(n.squared_distance) / radius;
    const double cubic = 1 - d * d * d;
    const double weight = o.weight * cubic * cubic * cubic;
    const Eigen::Vector2d at = (o.position - position) / radius;
    fit.add(at.x(), at.y(), o.height - level, weight);
  }
  if (!(fit.weight() > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double ridge = fit.weight() * curvature_ridge;
  return level + fit.coefficients(ridge, 1e-2 * ridge, 1e-9 * ridge)[0];
}

void HeightRegression::nearest(const Eigen::Vector2d& position, Index neighbours,
                               std::vector<Neighbour>& near) const {
  tree_.nearest({position.x(), position.y(), 0}, neighbours + 1, near);
}

Points HeightRegression::fitted(const Points& positions, Index neighbours) const {
  Points fits = positions;
  std::vector<Index> kept;
  std::vector<Neighbour> near;
  const auto fit = [&](Index i) {
    const Eigen::Vector2d position(positions(i, 0), positions(i, 1));
    nearest(position, neighbours, near);
    fits(i, 2) = height(position, near, -1);
    if (std::isfinite(fits(i, 2))) kept.push_back(i);
  };
  interruptible_for(context_, positions.rows(), fit, stretch);
  return fits(kept, Eigen::indexing::all);
}

Index HeightRegression::best_neighbours(const std::vector<Index>& offered) const {
  const Index n = static_cast<Index>(observations_.size());
  const Index step = std::max<Index>(1, n / most_left_out);
  struct Error {
    double sum = 0, weights = 0;
  };
  std::vector<Error> errors(offered.size());
  std::vector<Neighbour> near;
  for (Index i = 0; i < n; i += step) {
    context_.check();
    const HeightObservation& o = observations_[i];
    if (!(o.weight > 0)) continue;
    nearest(o.position, std::min(n - 1, offered.back()), near);
    for (std::size_t k = 0; k < offered.size() && offered[k] < n; ++k) {
      const double residual =
          o.height - height(o.position, std::span(near).first(offered[k] + 1), i);
      if (!std::isfinite(residual)) continue;
      errors[k].sum += o.weight * residual * residual;
      errors[k].weights += o.weight;
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Error& e : errors)
    if (e.weights > 0) least = std::min(least, e.sum / e.weights);
  std::size_t best = 0;
  for (std::size_t k = 0; k < offered.size(); ++k)
    if (errors[k].weights > 0 && errors[k].sum / errors[k].weights <= tolerated_error * least)
      best = k;
  return offered[best];
}

namespace {

constexpr double least_cosine = 0.15;
constexpr int crossings = 3;  // Newton steps of a line onto a patch

}  // namespace

SurfacePatches::SurfacePatches(const SurfacePoints& cloud, Index neighbours, const Context& context)
    : patches_(cloud.size()) {
  std::vector<Neighbour> near;
  for (Index i = 0; i < cloud.size(); ++i) {
    context.check();
    Patch& patch = patches_[i];
    patch.normal = cloud.normal(i);
    const Eigen::Matrix<double, 3, 2> tangent = orthogonal_to(patch.normal);
    patch.first = tangent.col(0);
    patch.second = tangent.col(1);
    patch.centre = cloud.point(i);
    cloud.tree.nearest(patch.centre, neighbours, near);
    patch.reach = std::sqrt(near.back().squared_distance);
    QuadraticFit fit;
    for (const Neighbour& n : near) {
      const Vector3 d = (cloud.point(n.index) - patch.centre) / patch.reach;
      fit.add(patch.first.dot(d), patch.second.dot(d), patch.normal.dot(d),
              1 - 0.8 * d.squaredNorm());
    }
    const auto h = fit.coefficients(1e-3 * fit.weight());
    const double r = patch.reach;
    patch.height << h[0] * r, h[1], h[2], h[3] / r, h[4] / r, h[5] / r;
  }
}

double SurfacePatches::along(Index j, const Vector3& x, const Vector3& direction) const {
  const Patch& patch = patches_[j];
  const double da = patch.first.dot(direction), db = patch.second.dot(direction);
  const double dn = patch.normal.dot(direction);
  const Vector3 d = x - patch.centre;
  const double a0 = patch.first.dot(d), b0 = patch.second.dot(d), n0 = patch.normal.dot(d);
  const auto& h = patch.height;
  double t = 0;
  for (int step = 0; step < crossings; ++step) {
    double a = a0 + t * da, b = b0 + t * db;
    const double length = std::hypot(a, b);
    const double inside = length > patch.reach ? patch.reach / length : 1;
    const double tangent = h[1] * a + h[2] * b;
    const double bend = h[3] * a * a + h[4] * a * b + h[5] * b * b;
    const double height = h[0] + tangent + bend * (2 * inside - inside * inside);
    const double slope_a = h[1] + (2 * h[3] * a + h[4] * b) * inside;
    const double slope_b = h[2] + (h[4] * a + 2 * h[5] * b) * inside;
    const double rate = dn - slope_a * da - slope_b * db;
    if (std::abs(rate) < least_cosine) return std::numeric_limits<double>::quiet_NaN();
    t -= (n0 + t * dn - height) / rate;
  }
  return t;
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
