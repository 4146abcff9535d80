#include "methods/parametric/refinement.h"

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "base/math.h"
#include "base/symmetric_eigen.h"
#include "cloud/surface_spacing.h"
#include "methods/parametric/exact_pairs.h"
#include "methods/parametric/shapes.h"
#include "score/correspondence.h"

namespace symsurf {

namespace {

// `held`: what changes cost on the surfaces; `moved`: how far they move the images, summed over
// `count`.
Eigen::Matrix<double, Eigen::Dynamic, 2> loosest_changes(const Eigen::MatrixXd& held,
                                                         Eigen::MatrixXd moved, double count) {
  if (!(count > 0)) return Eigen::Matrix<double, Eigen::Dynamic, 2>::Zero(moved.rows(), 2);
  moved /= count;
  moved.diagonal().array() += 1e-9 * moved.trace();
  return eigen_of(held, moved).vectors.leftCols(2);
}

// The mean over tolerances from coarse to fine: images that meet a point exactly count in full,
// chance correspondence less the finer one looks.
double closeness(const Correspondence& correspondence) {
  constexpr std::array score_tolerances{0.01, 0.005, 0.0025, 0.00125};
  double sum = 0;
  for (const double tolerance : score_tolerances) sum += correspondence.weight(tolerance);
  return sum / static_cast<double>(score_tolerances.size());
}

}  // namespace

ParametricRefinement::ParametricRefinement(const Cloud& cloud, const NearestPoints& points,
                                           const PointTree& tree, const Surfels& surfels,
                                           const Context& context)
    : cloud_(cloud),
      points_(points),
      surfels_(surfels),
      context_(context),
      spacing_(surface_spacing(cloud.points, tree) / cloud.frame.size) {
  constexpr Index most_samples = 8192;
  const Index n = cloud.points.size(), count = std::min(n, most_samples);
  for (Index k = 0; k < count; ++k) {
    const Vector3 x = cloud.frame.to_frame(cloud.points[tree.order()[k * n / count]]);
    const Index surfel = surfels.containing(x);
    if (surfel >= 0) samples_.push_back({x, &surfels[surfel]});
  }
}

Index ParametricRefinement::stride_for(Index wanted) const {
  return std::max<Index>(1, static_cast<Index>(samples_.size()) / wanted);
}

template <typename Shape>
auto ParametricRefinement::matches(const Shape& shape, double limit, Index stride) const
    -> std::vector<Match> {
  std::vector<const Sample*> asked;
  std::vector<Vector3> images, queries;
  for (std::size_t i = 0; i < samples_.size(); i += stride) {
    const Vector3 image = shape.reflect(samples_[i].position);
    if (!image.allFinite()) continue;
    asked.push_back(&samples_[i]);
    images.push_back(image);
    queries.push_back(cloud_.frame.from_frame(image));
  }
  std::vector<Match> found;
  const std::vector<Vector3> nearest = points_.nearest(queries, limit * cloud_.frame.size);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!nearest[k].allFinite()) continue;
    const Vector3 partner = cloud_.frame.to_frame(nearest[k]);
    const Index surfel = surfels_.containing(partner);
    if (surfel >= 0) found.push_back({asked[k], images[k] - partner, &surfels_[surfel]});
  }
  return found;
}

template <typename Shape>
Candidate<Shape> ParametricRefinement::fitted(const Candidate<Shape>& start, Index wanted,
                                              int steps) const {
  constexpr double narrowest = 0.001;
  constexpr double along_surface = 0.01;
  const Index stride = stride_for(wanted);
  Candidate<Shape> candidate = start;
  double tolerance = widest;
  for (int step = 0; step < steps; ++step) {
    typename Shape::Step sum(candidate.shape);
    std::vector<double> residuals;
    for (const Match& match : matches(candidate.shape, reach(), stride)) {
      const Sample& s = *match.sample;
      const double weight = displaced(candidate.shape.distance(s.position), widest);
      if (weight <= 0) continue;
      const Correspondence correspondence(
          match.gap, candidate.shape.reflect_direction(s.position, s.surfel->normal),
          s.surfel->flatness, *match.partner);
      residuals.push_back(correspondence.squared);
      const double trusted =
          correspondence.weight(tolerance) * inside_surface(match.gap, *match.partner, spacing_);
      sum.add(s.position, match.gap, correspondence.metric(along_surface), weight * trusted);
    }
    if (residuals.size() < 5) break;
    double moved;
    candidate.shape = sum.taken(&moved);
    tolerance = std::clamp(2.5 * std::sqrt(median(std::move(residuals))), narrowest, widest);
    if (moved < 1e-5) break;
  }
  candidate.support = support(candidate.shape, wanted);
  return candidate;
}

template <typename Shape>
Candidate<Shape> ParametricRefinement::fitted_to_exact_pairs(const Candidate<Shape>& start) const {
  constexpr Index wanted = 1200;
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < samples_.size(); i += stride_for(wanted))
    positions.push_back(samples_[i].position);
  const std::optional<Shape> exact =
      symsurf::fitted_to_exact_pairs(start.shape, positions, points_, cloud_.frame, spacing_);
  if (!exact) return start;
  Candidate<Shape> candidate = start;
  candidate.shape = *exact;
  candidate.support = support(*exact, wanted);
  return candidate;
}

template <typename Shape>
Eigen::Matrix<double, Eigen::Dynamic, 2> ParametricRefinement::loosest(const Shape& shape) const {
  typename Shape::Step held(shape), moved(shape);
  double count = 0;
  for (const Match& match : matches(shape, reach(), stride_for(400))) {
    const Sample& s = *match.sample;
    const double weight = displaced(shape.distance(s.position), widest);
    if (weight <= 0) continue;
    const Correspondence correspondence(match.gap,
                                        shape.reflect_direction(s.position, s.surfel->normal),
                                        s.surfel->flatness, *match.partner);
    const Vector3& n = match.partner->normal;
    held.add(s.position, match.gap, n * n.transpose(), weight * correspondence.weight(widest));
    moved.add(s.position, match.gap, Matrix3::Identity(), weight);
    count += weight;
  }
  return loosest_changes(held.hessian(), moved.hessian(), count);
}

// A mirror that is h higher over the plane moves the image by 2 h along its normal.
PlaneBend ParametricRefinement::bend_of(const UnitPlane& plane) const {
  constexpr Index wanted = 1200;
  constexpr int rounds = 3;
  using Heights = Eigen::Vector<double, 6>;
  const Vector3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  const std::vector<Match> found = matches(plane, reach(), stride_for(wanted));
  Heights heights = Heights::Zero();
  for (int round = 0; round < rounds; ++round) {
    Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
    Heights asked = Heights::Zero();
    for (const Match& match : found) {
      const Sample& x = *match.sample;
      const double s = u.dot(x.position), t = v.dot(x.position);
      const Heights terms(Heights{1, s, t, s * s / 2, s * t, t * t / 2});
      const Vector3 gap = match.gap + 2 * heights.dot(terms) * plane.normal;
      const Correspondence correspondence(gap, plane.reflect_direction(x.surfel->normal),
                                          x.surfel->flatness, *match.partner);
      const double weight = displaced(plane.distance(x.position), widest) *
                            correspondence.weight(widest) *
                            inside_surface(gap, *match.partner, spacing_);
      const Vector3& across = match.partner->normal;
      const double slope = 2 * across.dot(plane.normal);
      products += weight * slope * slope * terms * terms.transpose();
      asked -= weight * slope * across.dot(match.gap) * terms;
    }
    products.diagonal().array() += 1e-9 * products.trace() + 1e-300;
    heights = products.ldlt().solve(asked);
  }
  Eigen::Matrix2d curvature;
  curvature << heights[3], heights[4], heights[4], heights[5];
  const SymmetricEigen<2> principal = eigen_of(curvature);
  const int most = std::abs(principal.values[0]) > std::abs(principal.values[1]) ? 0 : 1;
  const Eigen::Vector2d way = principal.vectors.col(most);
  const Vector3 normal = (plane.normal - heights[1] * u - heights[2] * v).normalized();
  const Vector3 along = way[0] * u + way[1] * v;
  return {(heights[0] - plane.offset) * plane.normal, normal,
          (along - along.dot(normal) * normal).normalized(), principal.values[most],
          principal.values[1 - most]};
}

template <typename Shape>
double ParametricRefinement::support(const Shape& shape, Index wanted) const {
  constexpr double least_moved = 0.35;
  const Index stride = stride_for(wanted);
  const double tolerance = std::max(0.01, spacing_ / 2);
  double moved = 0, agreeing = 0;
  Index looked = 0;
  for (std::size_t i = 0; i < samples_.size(); i += stride, ++looked)
    moved += displaced(shape.distance(samples_[i].position), tolerance);
  for (const Match& match : matches(shape, reach(), stride)) {
    const Sample& s = *match.sample;
    const Correspondence correspondence(match.gap,
                                        shape.reflect_direction(s.position, s.surfel->normal),
                                        s.surfel->flatness, *match.partner);
    agreeing += displaced(shape.distance(s.position), tolerance) * closeness(correspondence);
  }
  return agreeing / std::max(moved, least_moved * static_cast<double>(looked));
}

template Candidate<UnitPlane> ParametricRefinement::fitted(const Candidate<UnitPlane>&, Index,
                                                           int) const;
template Candidate<UnitSphere> ParametricRefinement::fitted(const Candidate<UnitSphere>&, Index,
                                                            int) const;
template Candidate<UnitCylinder> ParametricRefinement::fitted(const Candidate<UnitCylinder>&, Index,
                                                              int) const;
template Candidate<UnitSphere> ParametricRefinement::fitted_to_exact_pairs(
    const Candidate<UnitSphere>&) const;
template Candidate<UnitCylinder> ParametricRefinement::fitted_to_exact_pairs(
    const Candidate<UnitCylinder>&) const;
template Eigen::Matrix<double, Eigen::Dynamic, 2> ParametricRefinement::loosest(
    const UnitSphere&) const;
template Eigen::Matrix<double, Eigen::Dynamic, 2> ParametricRefinement::loosest(
    const UnitCylinder&) const;
template double ParametricRefinement::support(const UnitCylinder&, Index) const;
template double ParametricRefinement::support(const UnitSphere&, Index) const;

}  // namespace symsurf
