#include "fit/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <type_traits>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "fit/candidate.h"
#include "fit/shapes.h"

namespace symsurf {

namespace {

constexpr double reach = 0.06;    // how far a partner may be
constexpr double widest = 0.012;  // tolerance of what is only looked at
constexpr double score_tolerance = 0.015;
constexpr double least_moved = 0.35;  // share of the samples
// Stricter than the score: where much is missing, how close the rest comes distinguishes a false
// mirror from the true. As close as the noise lets it.
constexpr double closest = 0.0003, close = 0.001;
constexpr double near_miss = 0.016, penalty = 0.4;

// Noise is taken off the points for affine maps alone: along the planes of patches, it would take
// what tells how a mirror bends as well. Of 24 spheres through noise 22 are right without, 12 with
// it; of 60 oblique planes 46 without, 55 with it.
template <typename Shape>
constexpr bool is_plane = std::is_same_v<Shape, UnitPlane>;

// The mean over tolerances from coarse to fine: images that meet a point exactly count in full,
// chance correspondence less the finer one looks.
double closeness(const Correspondence& correspondence) {
  constexpr std::array tolerances{0.01, 0.005, 0.0025, 0.00125};
  double sum = 0;
  for (const double tolerance : tolerances) sum += correspondence.weight(tolerance);
  return sum / static_cast<double>(tolerances.size());
}

// Along the Z-order curve of the principal frame, not of the input's: pose must not show.
std::uint32_t place_on_curve(const Vector3& x) {
  constexpr int bits = 8;
  constexpr double shift = 0.038197;  // off any lattice, as the surfels' grid
  const Eigen::Vector3i cell = ((x.array() + 1 + shift) * (1 << (bits - 1)) / 1.1).cast<int>();
  std::uint32_t position = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (int axis = 0; axis < 3; ++axis) position = position << 1 | (cell[axis] >> bit & 1);
  return position;
}

}  // namespace

Refinement::Refinement(const Cloud& cloud, const NearestPoints& points, const Surfels& coarse,
                       const Surfels& fine)
    : cloud_(cloud),
      points_(points),
      coarse_(coarse),
      fine_(fine),
      spacing_(coarse.spacing_of(cloud.points.size())) {
  for (Index k = 0; k < fine.size(); ++k) {
    const Vector3& x = fine[k].sampled;
    if (const Surfel* surfel = surfel_at(x)) samples_.push_back({x, surfel, place_on_curve(x)});
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.position < b.position; });
  noise_ = measured_noise();
  kernel_ = {.inlier = std::clamp(noise_.deviation(), closest, close),
             .near_miss = near_miss,
             .penalty = penalty};
  for (Sample& s : samples_) s.smoothed = noise_.smoothed(s.point, *s.surfel);
}

SurfaceNoise Refinement::measured_noise() const {
  constexpr Index wanted = 250;
  const Index stride = stride_for(wanted);
  std::vector<OnSurface> asked;
  for (std::size_t i = 0; i < samples_.size(); i += stride)
    asked.push_back({samples_[i].point, samples_[i].surfel});
  return {asked, neighbours_of(asked, cloud_.frame, points_)};
}

Index Refinement::stride_for(Index wanted) const {
  return std::max<Index>(1, (static_cast<Index>(samples_.size()) + wanted / 2) / wanted);
}

template <typename Shape>
double Refinement::support(const Shape& shape, Index samples) const {
  const Index stride = stride_for(samples);
  double moved = 0, support = 0;
  Index looked = 0;
  for (std::size_t i = 0; i < samples_.size(); i += stride, ++looked)
    moved += displaced(shape.distance(position<Shape>(samples_[i])), score_tolerance);
  for (const Match& match : matches(shape, reach, stride)) {
    const Vector3& x = match.point;
    const Vector3 off = shape.reflect(x) - match.partner;
    const Correspondence correspondence(off, shape.reflect_direction(x, match.facet.normal),
                                        match.facet.flatness, match.partner_facet);
    const double agrees = is_plane<Shape>
                              ? kernel_(distance_past(off, match.partner_facet, spacing_),
                                        correspondence.normal_consistency)
                              : closeness(correspondence);
    support += displaced(shape.distance(x), score_tolerance) * agrees;
  }
  return support / std::max(moved, least_moved * static_cast<double>(looked));
}

template <typename Shape>
Candidate<Shape> Refinement::fitted(const Candidate<Shape>& start, const Fit& fit) const {
  Candidate<Shape> candidate = start;
  candidate.shape = fitted(start.shape, fit);
  candidate.support = support(candidate.shape, fit.samples);
  return candidate;
}

template <typename Shape>
Shape Refinement::refined(const Shape& start, const Refinement& onto) const {
  constexpr double wide = 0.01;
  constexpr Index many = 1000;
  constexpr int steps = 12;
  const double noise = std::max(noise_.deviation(), onto.noise_.deviation());
  const double narrow = std::clamp(noise, 0.003, wide);  // noise agrees no closer
  std::vector<Shape> shape{start};
  for (const Fit& fit : {Fit{many, wide, steps}, Fit{many, narrow, steps},
                         Fit{static_cast<Index>(samples_.size()), narrow, 2}})
    shape = fitted(shape, fit, onto);
  return exact(shape.front(), onto);
}

template <typename Shape>
Shape Refinement::exact(const Shape& start, const Refinement& onto) const {
  constexpr Index wanted = 1000;
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < samples_.size(); i += stride_for(wanted))
    positions.push_back(samples_[i].point);
  return fitted_to_exact_pairs(start, positions, onto.points_, onto.cloud_.frame, onto.spacing_)
      .value_or(start);
}

template <typename Shape>
Eigen::Matrix<double, Eigen::Dynamic, 2> Refinement::loosest(const Shape& shape) const {
  constexpr Index wanted = 400;
  GaussNewton<Shape> held, moved;
  double count = 0;
  for (const Match& match : matches(shape, reach, stride_for(wanted))) {
    const Vector3& x = match.point;
    const double weight = displaced(shape.distance(x), widest);
    if (weight <= 0) continue;
    const Vector3 off = shape.reflect(x) - match.partner;
    const Correspondence correspondence(off, shape.reflect_direction(x, match.facet.normal),
                                        match.facet.flatness, match.partner_facet);
    const Vector3& n = match.partner_facet.normal;
    held.add(shape, x, off, Metric{0, 1, n}, weight * correspondence.weight(widest));
    moved.add(shape, x, off, Metric{1, 0, n}, weight);
    count += weight;
  }
  if (!(count > 0))
    return Eigen::Matrix<double, Eigen::Dynamic, 2>::Zero(moved.hessian().rows(), 2);
  Eigen::MatrixXd moves = moved.hessian() / count;
  moves.diagonal().array() += double_rounding * moves.trace();
  return eigen_of(Eigen::MatrixXd(held.hessian()), moves).vectors.leftCols(2);
}

// A mirror that is h higher over the plane moves the image by 2 h along its normal.
PlaneBend Refinement::bend_of(const UnitPlane& plane) const {
  constexpr Index wanted = 1200;
  constexpr int rounds = 3;
  using Heights = Eigen::Vector<double, 6>;
  const Vector3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  const std::vector<Match> found = matches(plane, reach, stride_for(wanted));
  Heights heights = Heights::Zero();
  for (int round = 0; round < rounds; ++round) {
    Eigen::Matrix<double, 6, 6> products = Eigen::Matrix<double, 6, 6>::Zero();
    Heights asked = Heights::Zero();
    for (const Match& match : found) {
      const Vector3& x = match.point;
      const double s = u.dot(x), t = v.dot(x);
      const Heights terms(Heights{1, s, t, s * s / 2, s * t, t * t / 2});
      const Vector3 flat = plane.reflect(x) - match.partner;
      const Vector3 off = flat + 2 * heights.dot(terms) * plane.normal;
      const Correspondence correspondence(off, plane.reflect_direction(match.facet.normal),
                                          match.facet.flatness, match.partner_facet);
      const double weight = displaced(plane.distance(x), widest) * correspondence.weight(widest) *
                            inside_surface(off, match.partner_facet, spacing_);
      const Vector3& across = match.partner_facet.normal;
      const double slope = 2 * across.dot(plane.normal);
      products += weight * slope * slope * terms * terms.transpose();
      asked -= weight * slope * across.dot(flat) * terms;
    }
    products.diagonal().array() += double_rounding * products.trace() + 1e-300;
    heights = solved(products, asked);
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

template UnitPlane Refinement::refined(const UnitPlane&, const Refinement&) const;
template UnitPlane Refinement::exact(const UnitPlane&, const Refinement&) const;
template Candidate<UnitPlane> Refinement::fitted(const Candidate<UnitPlane>&, const Fit&) const;
template double Refinement::support(const UnitPlane&, Index) const;

template UnitObliquePlane Refinement::refined(const UnitObliquePlane&, const Refinement&) const;
template UnitPlacement Refinement::refined(const UnitPlacement&, const Refinement&) const;

template Candidate<UnitSphere> Refinement::fitted(const Candidate<UnitSphere>&, const Fit&) const;
template double Refinement::support(const UnitSphere&, Index) const;
template Eigen::Matrix<double, Eigen::Dynamic, 2> Refinement::loosest(const UnitSphere&) const;

template Candidate<UnitCylinder> Refinement::fitted(const Candidate<UnitCylinder>&,
                                                    const Fit&) const;
template double Refinement::support(const UnitCylinder&, Index) const;
template Eigen::Matrix<double, Eigen::Dynamic, 2> Refinement::loosest(const UnitCylinder&) const;

namespace {

// Mirrors over the plane of the two loosest changes of one: from one to the next, images move by
// half the spacing of the points.
template <typename Shape>
std::vector<Shape> shapes_around(const Shape& shape,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 2>& loosest,
                                 double spacing) {
  constexpr double step = 0.5;          // of the spacing
  constexpr std::array farthest{7, 4};  // steps to either side, of the loosest and the next
  std::vector<Shape> around;
  for (int i = -farthest[0]; i <= farthest[0]; ++i)
    for (int j = -farthest[1]; j <= farthest[1]; ++j)
      around.push_back(shape.changed(step * spacing * loosest * Eigen::Vector2d(i, j)));
  return around;
}

template <typename Shape>
Candidate<Shape> slid_along_surfaces(Candidate<Shape> candidate, const Refinement& refinement) {
  constexpr int slides = 4;
  constexpr Index first_samples = 120, second_samples = 800;
  constexpr std::size_t tried_slides = 4;
  constexpr double clearly_more = 1e-3;
  candidate.support = refinement.support(candidate.shape, second_samples);
  for (int slide = 0; slide < slides; ++slide) {
    std::vector<Candidate<Shape>> positions;
    for (const Shape& shape :
         shapes_around(candidate.shape, refinement.loosest(candidate.shape), refinement.spacing()))
      positions.push_back({shape, refinement.support(shape, first_samples)});
    sort_best_first(positions);
    positions.resize(std::min(tried_slides, positions.size()));
    const double before = candidate.support;
    for (const Candidate<Shape>& position : positions) {
      const Candidate<Shape> fitted =
          refinement.fitted(position, {.samples = second_samples, .steps = 6});
      if (fitted.support > candidate.support + clearly_more) candidate = fitted;
    }
    if (candidate.support == before) break;
  }
  return candidate;
}

}  // namespace

template <typename Shape>
Candidate<Shape> polished(const Candidate<Shape>& candidate, const Fit& fit,
                          const Refinement& refinement) {
  Candidate<Shape> close = refinement.fitted(slid_along_surfaces(candidate, refinement), fit);
  close.shape = refinement.exact(close.shape);
  close.support = refinement.support(close.shape, fit.samples);
  return close;
}

template Candidate<UnitSphere> polished(const Candidate<UnitSphere>&, const Fit&,
                                        const Refinement&);
template Candidate<UnitCylinder> polished(const Candidate<UnitCylinder>&, const Fit&,
                                          const Refinement&);

}  // namespace symsurf
