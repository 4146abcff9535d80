#include "score/mirror_score.h"

#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/principal_frame.h"
#include "pairing/correspondence.h"
#include "score/mirror_sides.h"

namespace symsurf {

namespace {

// Lengths are in diagonals.
constexpr Index sample_count = 1000;
// Distance from the mirror from which on a sample counts in full, near which any surface is
// symmetric: that; of a thin body a share of its extent, some tolerances at least; some deviations
// of the noise.
constexpr double moved_by_extent = 0.25, moved_by_noise = 4;
constexpr double moved_by_tolerance = 2;
constexpr double least_share = 0.2;  // of all samples, that the mean is taken over
constexpr double held_out = 0.06;    // radius of the windows that sides are predicted over

// Nats that a mirror of any shape begins with, and what it loses with all that contradicts it. Of
// 75 free forms found by search the right ones map 0.96 of what is there in the median, those of
// chance 0.93 at most but for tetrahedra and thin clouds of threads. Any solid has a height field
// half-way through it, along any direction, that maps all.
std::optional<double> prior_of(std::string_view kind) {
  if (kind == "free-form") return 7;
  if (kind == "height field") return -3;
  return std::nullopt;
}
constexpr double contradiction = 100;

// Of what the cloud has where images fall.
double contradicted_of(const MirrorFit& fit) {
  return std::max(0.0, 1 - fit.share / std::max(1 - fit.missing, 1e-9));
}

Eigen::Isometry3d reflection_over(const UnitPlane& plane) {
  const Vector3& normal = plane.normal;
  Eigen::Isometry3d reflection(Matrix3(Matrix3::Identity() - 2 * normal * normal.transpose()));
  reflection.translation() = -2 * plane.offset * normal;
  return reflection;
}

// The image of a surface's point over a rigid map.
struct RigidImage {
  Eigen::Isometry3d map;

  ImagePoint operator()(const ImagePoint& at) const {
    return {map * at.position, map.linear() * at.normal};
  }
  RigidImage moved(const Eigen::Isometry3d& by) const { return {by * map * by.inverse()}; }
};

// The same on another surface, where that moves.
struct PlacedImage : RigidImage {
  PlacedImage moved(const Eigen::Isometry3d& by) const { return {by * map}; }
};

// The same over any mirror, that is moved by a motion.
struct MirrorImage {
  const Mirror& mirror;
  const PrincipalFrame& frame;
  Eigen::Isometry3d by = Eigen::Isometry3d::Identity();

  Vector3 image(const Vector3& x) const {
    return by * frame.to_frame(mirror.reflect(frame.from_frame(by.inverse() * x)));
  }
  ImagePoint operator()(const ImagePoint& at) const {
    constexpr double step = 1e-4;
    const Vector3 here = image(at.position);
    const Eigen::Matrix<double, 3, 2> along = orthogonal_to(at.normal);
    const Vector3 first = image(at.position + step * along.col(0)) - here,
                  second = image(at.position + step * along.col(1)) - here;
    return {here, second.cross(first).stableNormalized()};  // as a reflection turns them round
  }
  MirrorImage moved(const Eigen::Isometry3d& next) const { return {mirror, frame, next * by}; }
};

// The motions that turn a map about these axes through a point, and shift it, by groups: a sheet
// slides in one way only.
std::vector<std::vector<Eigen::Isometry3d>> chance_motions(const Vector3& pivot,
                                                           const std::vector<Vector3>& axes,
                                                           const std::vector<Vector3>& ways) {
  std::vector<std::vector<Eigen::Isometry3d>> groups;
  for (const Vector3& axis : axes) {
    groups.emplace_back();
    for (const double degrees : {-55, -25, 25, 55})
      groups.back().push_back(Eigen::Translation3d(pivot) *
                              Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis) *
                              Eigen::Translation3d(-pivot));
  }
  for (const Vector3& way : ways) {
    groups.emplace_back();
    for (const double shift : {-0.12, -0.06, 0.06, 0.12})
      groups.back().push_back(Eigen::Isometry3d(Eigen::Translation3d(shift * way)));
  }
  return groups;
}

// Those of a mirror: about four axes in it, and across itself.
std::vector<std::vector<Eigen::Isometry3d>> chance_motions(const std::vector<PointFit>& fits,
                                                           const SampledSurface& surface,
                                                           const Cloud& cloud) {
  Matrix3 chords = Matrix3::Zero();
  std::array<std::vector<double>, 3> middles;
  for (const PointFit& fit : fits) {
    const Vector3& x = surface[fit.point].position;
    const Vector3 chord = fit.image - x;
    if (!(chord.norm() > fully_moved)) continue;
    chords += chord.normalized() * chord.normalized().transpose();
    for (int i = 0; i < 3; ++i) middles[i].push_back((x[i] + fit.image[i]) / 2);
  }
  if (middles[0].empty()) return {};
  Vector3 pivot;
  for (int i = 0; i < 3; ++i) pivot[i] = median(std::move(middles[i]));
  const Vector3 normal = eigen_of(chords).vectors.col(2);
  const Matrix3 across = Matrix3::Identity() - normal * normal.transpose();
  const Matrix3 within =
      eigen_of(Matrix3(across * cloud.frame.variance.asDiagonal() * across)).vectors;
  const Vector3 u = within.col(1), v = within.col(2);
  return chance_motions(pivot, {u, v, (u + v).normalized(), (u - v).normalized()}, {normal});
}

}  // namespace

MirrorScore::MirrorScore(const Cloud& cloud, const Context& context)
    : cloud_(cloud), context_(context), surface_(cloud, sample_count, context.stage(0, 0.8)) {
  if (cloud.vertices) mesh_.emplace(*cloud.vertices, context.stage(0.8, 1));
}

// Both sides' surfaces where the line to the image meets them, as the noise is less there. Where
// it hardly meets them the distance of surfaces is unreliable.
void MirrorScore::add_sides(const PointFit& fit, Index partner, MirrorSides& sides) const {
  constexpr double steepest = 0.5;  // cosine
  const Vector3& x = surface_[fit.point].position;
  const double length = (fit.image - x).norm();
  const Vector3 along = (fit.image - x) / length;
  const LocalFacet &here = surface_[fit.point].patch, &there = surface_[partner].patch;
  const double facing = here.normal.dot(along), facing_there = there.normal.dot(along);
  if (std::min(std::abs(facing), std::abs(facing_there)) < steepest) return;
  const double own = -here.above(x) / facing, other = there.above(fit.image) / facing_there;
  const double half = (length - own - other) / 2;
  if (half > 0) sides.add({x + length / 2 * along, along, (own - other) / 2, half});
}

// Calls take(image) with the image of points of the principal frame.
template <typename Take>
void MirrorScore::with_image_of(const Mirror& mirror, const Take& take) const {
  if (mirror.kind() == "plane")
    take(RigidImage{reflection_over(in_frame(mirror, cloud_.frame))});
  else
    take(MirrorImage{mirror, cloud_.frame});
}

// Calls take(what it does as a whole, what with each sample, the image of points).
template <typename Take>
void MirrorScore::with_fit_of(const Mirror& mirror, Index stride, const Take& take) const {
  with_image_of(mirror, [&](const auto& image) {
    const std::optional<double> prior = prior_of(mirror.kind());
    MirrorSides sides(held_out);
    const std::vector<PointFit> fits =
        point_fits(image, stride, surface_, prior ? &sides : nullptr);
    MirrorFit found = whole_of(fits, stride);
    if (prior) found.log_odds = *prior + sides.evidence() - contradiction * contradicted_of(found);
    if (mesh_ && found.share > 0 && (*mesh_)(mirror, cloud_.points))
      found = {1, 0, 1, found.deviation, found.log_odds};
    take(found, fits, image);
  });
}

MirrorFit MirrorScore::fit(const Mirror& mirror, Index stride) const {
  MirrorFit fit;
  with_fit_of(mirror, stride,
              [&](const MirrorFit& found, const auto&, const auto&) { fit = found; });
  return fit;
}

std::vector<PointFit> MirrorScore::point_fits(const Eigen::Isometry3d& map, Index stride) const {
  return point_fits(RigidImage{map}, stride, surface_);
}

MirrorFit MirrorScore::fit(const Eigen::Isometry3d& map, const MirrorScore& onto,
                           Index stride) const {
  return whole_of(point_fits(PlacedImage{map}, stride, onto.surface_), stride);
}

double MirrorScore::evidence(const Eigen::Isometry3d& map, const MirrorScore& onto) const {
  const PlacedImage image{map}, back{map.inverse()};
  const std::vector<Vector3> axes{Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  return evidence(image, point_fits(image, 1, onto.surface_),
                  chance_motions(map.translation(), axes, axes), onto.surface_,
                  onto.unmapped(onto.point_fits(back, 1, surface_)))
      .sure;
}

template <typename Image>
std::vector<PointFit> MirrorScore::point_fits(const Image& image_of, Index stride,
                                              const SampledSurface& onto,
                                              MirrorSides* sides) const {
  constexpr Index grain = 64;  // samples that a thread takes at a time
  const bool is_other = &onto != &surface_;
  const Index looked_at = (surface_.size() + stride - 1) / stride;
  std::vector<ImagePoint> all(looked_at);
  silent_parallel_for(context_, looked_at, grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const SampledSurface::Sample& sample = surface_[i * stride];
      all[i] = image_of({sample.position, sample.facet.normal});
    }
  });
  std::vector<std::pair<Index, ImagePoint>> images;
  std::vector<PointFit> fits;
  std::vector<double> distances{0};
  for (Index k = 0; k < surface_.size(); k += stride) {
    const SampledSurface::Sample& sample = surface_[k];
    const ImagePoint& image = all[k / stride];
    if (!image.position.allFinite() || !image.normal.allFinite()) {
      fits.push_back({k, sample.ceiling, 0, sample.ceiling});
      continue;
    }
    const double distance = is_other ? infinity : (image.position - sample.position).norm() / 2;
    if (distance < single_rounding) continue;
    images.push_back({k, image});
    distances.push_back(distance);
  }
  const double thin =
      std::max(moved_by_extent * quantile(distances, 0.95), moved_by_tolerance * cloud_.tolerance);
  std::vector<SampledSurface::Landing> landings(images.size());
  silent_parallel_for(context_, static_cast<Index>(images.size()), grain,
                      [&](Index begin, Index end) {
                        for (Index i = begin; i < end; ++i)
                          landings[i] = onto.landing(surface_[images[i].first], images[i].second);
                      });
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto& [k, image] = images[i];
    const SampledSurface::Sample& sample = surface_[k];
    const SampledSurface::Landing& landing = landings[i];
    PointFit fit{k, 1, 1, 0, 0, landing.exact, image.position};
    if (!landing.exact) fit.residual = landing.residual;
    fit.normal = landing.facet.normal;
    fit.has_partner = !landing.ends && std::abs(fit.residual) < farthest_residual;
    if (!landing.exact) {
      const double full = std::max(std::min(fully_moved, thin), moved_by_noise * sample.noise);
      const double moved = displaced(distances[i + 1], full);
      fit.weight = moved * sample.ceiling;
      fit.support = moved * landing.support;
      const double lost = std::max(0.0, fit.weight - fit.support);
      fit.missing = lost * std::max(0.0, 1 - landing.there);
      fit.rim = lost * std::max(0.0, 1 - 1 / std::max(landing.there, 1e-9));
      if (sides && landing.support > 0.5) add_sides(fit, landing.sample, *sides);
    }
    fits.push_back(fit);
  }
  return fits;
}

MirrorFit MirrorScore::whole_of(const std::vector<PointFit>& points, Index stride) const {
  double ceilings = 0, weights = 0, support = 0, missing = 0, exact = 0;
  for (Index k = 0; k < surface_.size(); k += stride) ceilings += surface_[k].ceiling;
  std::vector<double> deviations{0};
  for (const PointFit& point : points) {
    if (point.mapped() > 0.5) deviations.push_back(std::abs(point.residual));
    weights += point.weight;
    support += point.support;
    missing += point.missing;
    if (point.exact) exact += point.weight;
  }
  if (!(weights > 0)) return {};
  const double exact_share = exact / weights;
  const double least = least_share * (1 - exact_share) * ceilings;
  return {std::min(1.0, support / std::max(weights, least)), missing / weights, exact_share,
          median(std::move(deviations)) * cloud_.frame.size};
}

std::vector<double> MirrorScore::unmapped(const std::vector<PointFit>& fits) const {
  std::vector<double> unmapped(surface_.size(), 0);
  for (const PointFit& fit : fits) unmapped[fit.point] = 1 - fit.mapped();
  return unmapped;
}

template <typename Image>
MirrorScore::Evidence MirrorScore::evidence(const Image& image, const std::vector<PointFit>& fits,
                                            const Motions& motions, const SampledSurface& onto,
                                            const std::vector<double>& unmapped_there) const {
  constexpr Index stride = 3;        // three hundred samples say what chance maps
  constexpr double doubted = 0.9;    // chance that maps more is a symmetry as well: vases, balls
  constexpr double least = 0.01;     // of its weight, that a sample has whatever chance maps of it
  constexpr Index around_image = 8;  // samples
  std::vector<double> chance(surface_.size(), 0);
  double greatest = 0;
  for (const auto& group : motions) {
    std::vector<double> mapped(surface_.size(), 0);
    for (const Eigen::Isometry3d& by : group) {
      std::vector<double> share(surface_.size(), 0);
      for (const PointFit& fit : point_fits(image.moved(by), stride, onto))
        share[fit.point] = fit.mapped();
      double sum = 0, weights = 0;
      for (const PointFit& fit : fits)
        if (fit.point % stride == 0) {
          sum += fit.weight * share[fit.point];
          weights += fit.weight;
          mapped[fit.point] += share[fit.point] / static_cast<double>(group.size());
        }
      if (weights > 0) greatest = std::max(greatest, sum / weights);
    }
    for (Index k = 0; k < surface_.size(); ++k) chance[k] = std::max(chance[k], mapped[k]);
  }
  double mapped = 0, contradicted = 0, support = 0, weights = 0, deciding = 0, looked_at = 0;
  for (const PointFit& fit : fits) {
    weights += fit.weight;
    support += fit.weight * fit.mapped();
    if (fit.point % stride != 0) continue;
    const double tells = fit.weight * (least + 1 - chance[fit.point]);
    deciding += tells;
    looked_at += fit.weight;
    mapped += tells * fit.mapped();
    if (!fit.image.allFinite()) continue;
    // Where the shape goes on around the image, or is itself unmapped there; else it is missing.
    const std::vector<Index> near = onto.nearest(fit.image, around_image);
    double there = fit.weight > fit.support ? 1 - fit.missing / (fit.weight - fit.support) : 1;
    for (const Index j : near) there += unmapped_there[j] / static_cast<double>(near.size());
    contradicted += tells * (1 - fit.mapped()) * std::min(1.0, there);
  }
  if (!(mapped > 0)) return {};
  const double top = std::min(doubted, greatest), share = std::min(1.0, support / weights);
  return {(mapped / (mapped + contradicted) + std::max(0.0, (share - top) / (1 - top))) / 2,
          deciding / looked_at};
}

namespace {

// The residuals of samples over a mirror, and where on it.
struct Residuals {
  std::vector<double> residual, noise, weight;
  std::vector<char> has_partner;
  std::vector<Eigen::Vector2d> foot;

  // Likeliest asymmetry, share without a partner and log density.
  struct Likeliest {
    double asymmetry = 0, unpaired = 0, log = -infinity;
  };
  Likeliest likeliest() const {
    Likeliest best;
    const auto look = [&](double asymmetry, double unpaired) {
      const double log = log_density(asymmetry, unpaired);
      if (log > best.log) best = {asymmetry, unpaired, log};
    };
    for (const double unpaired : {0.01, 0.05, 0.15, 0.3, 0.5, 0.7})
      for (double asymmetry = 1e-5; asymmetry < 0.02; asymmetry = std::max(2e-4, 1.8 * asymmetry))
        look(asymmetry, unpaired);
    for (const auto& [factor, step] : {std::pair{1.3, 0.05}, {1.08, 0.015}, {1.02, 0.005}}) {
      const Likeliest from = best;
      for (int i = -2; i <= 2; ++i)
        for (int j = -2; j <= 2; ++j)
          look(from.asymmetry * std::pow(factor, i),
               std::clamp(from.unpaired + step * j, 0.005, 0.9));
    }
    return best;
  }

  // Samples that count as one: the variance of sums over windows over that of independent ones.
  double correlation(double asymmetry) const {
    std::vector<double> scaled(residual.size());
    double independent = 1e-12, most = 1;
    for (std::size_t k = 0; k < residual.size(); ++k) {
      const double z = residual[k] / std::hypot(noise[k], asymmetry);
      scaled[k] = has_partner[k] ? weight[k] * std::clamp(z, -3.0, 3.0) : 0;
      independent += scaled[k] * scaled[k];
    }
    for (const double window : {0.12, 0.24}) {
      double together = 0;
      for (const double shift : {0.0, 0.33, 0.67}) {
        std::map<std::pair<int, int>, double> sums;
        for (std::size_t k = 0; k < residual.size(); ++k)
          sums[{static_cast<int>(std::floor(foot[k].x() / window + shift)),
                static_cast<int>(std::floor(foot[k].y() / window + shift))}] += scaled[k];
        for (const auto& [cell, sum] : sums) together += sum * sum / 3;
      }
      most = std::max(most, together / independent);
    }
    return most;
  }

 private:
  double log_density(double asymmetry, double unpaired) const {
    double sum = 0;
    for (std::size_t k = 0; k < residual.size(); ++k) {
      const double scale = std::hypot(noise[k], asymmetry), z = residual[k] / scale;
      const double student =
          2 / (std::numbers::pi * std::sqrt(3.0) * scale) / ((1 + z * z / 3) * (1 + z * z / 3));
      sum += weight[k] * std::log((1 - unpaired) * student + unpaired / (2 * farthest_residual));
    }
    return sum;
  }
};

Residuals residuals_of(const std::vector<PointFit>& fits, const SampledSurface& surface) {
  constexpr double least_noise = 2e-4;
  Residuals all;
  Matrix3 chords = Matrix3::Zero();
  for (const PointFit& fit : fits) {
    const Vector3 chord = fit.image - surface[fit.point].position;
    if (fit.weight > 0 && chord.allFinite()) chords += chord * chord.transpose();
  }
  const Matrix3 axes = eigen_of(chords).vectors;
  all.residual.assign(surface.size(), farthest_residual);
  all.weight.assign(surface.size(), 0);
  all.has_partner.assign(surface.size(), 0);
  all.foot.assign(surface.size(), Eigen::Vector2d::Zero());
  for (const PointFit& fit : fits) {
    const Index k = fit.point;
    all.weight[k] = fit.weight;
    if (!fit.image.allFinite()) continue;
    all.foot[k] = axes.leftCols<2>().transpose() * (fit.image + surface[k].position) / 2;
    if (!fit.has_partner) continue;
    all.has_partner[k] = 1;
    all.residual[k] = fit.normal.dot(axes.col(2)) < 0 ? -fit.residual : fit.residual;
  }
  for (Index k = 0; k < surface.size(); ++k)
    all.noise.push_back(std::max(least_noise, surface[k].noise));
  return all;
}

// Standard deviations of a mirror's orientation about its middle, radians, and of how far it lies
// along its normal, diagonals, by the normal equations of rigid motions. Those that leave it in
// itself are free, and left out.
struct Uncertainty {
  double angle = 0, offset = 0;

  Uncertainty(const std::vector<PointFit>& fits, const SampledSurface& surface) {
    using Motion = Eigen::Vector<double, 6>;
    constexpr double free = 1e-6;  // of the greatest eigenvalue
    Vector3 middle = Vector3::Zero(), normal = Vector3::Zero();
    double weights = 0, squares = 0;
    const auto for_each = [&](const auto& take) {
      for (const PointFit& fit : fits) {
        const Vector3& x = surface[fit.point].position;
        if (fit.has_partner && fit.weight > 0)
          take(fit, Vector3((x + fit.image) / 2), Vector3((fit.image - x).stableNormalized()));
      }
    };
    for_each([&](const PointFit& fit, const Vector3& foot, const Vector3& chord) {
      middle += fit.weight * foot;
      weights += fit.weight;
      squares += fit.weight * fit.residual * fit.residual;
      normal += fit.weight * (chord.dot(normal) < 0 ? -chord : chord);
    });
    if (!(weights > 0)) return;
    middle /= weights;
    Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(6, 6);
    for_each([&](const PointFit& fit, const Vector3& foot, const Vector3& chord) {
      Motion moved;
      moved << chord, (foot - middle).cross(chord);
      moved *= 2 * fit.normal.dot(chord);
      equations += fit.weight * moved * moved.transpose();
    });
    const double square = squares / weights;
    const double alike = residuals_of(fits, surface).correlation(std::sqrt(square));
    const auto [values, vectors] = eigen_of(equations);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(6, 6);
    for (int i = 0; i < 6; ++i)
      if (values[i] > free * values[5])
        covariance += square * alike / values[i] * vectors.col(i) * vectors.col(i).transpose();
    const Matrix3 shifts = covariance.topLeftCorner<3, 3>();
    const Matrix3 turns = covariance.bottomRightCorner<3, 3>();
    angle = std::sqrt(std::max(0.0, eigen_of(turns).values[2]));
    offset = std::sqrt(std::max(0.0, normal.normalized().dot(shifts * normal.normalized())));
  }
};

}  // namespace

double MirrorScore::nats(const Mirror& freer, const Mirror& simpler, double freedom) const {
  const auto over = [&](const Mirror& mirror) {
    Residuals all;
    with_image_of(mirror, [&](const auto& image) {
      all = residuals_of(point_fits(image, 1, surface_), surface_);
    });
    return all;
  };
  Residuals less = over(simpler), more = over(freer);
  double samples = 0;
  for (Index k = 0; k < surface_.size(); ++k) {
    less.weight[k] = more.weight[k] = (less.weight[k] + more.weight[k]) / 2;
    samples += more.weight[k];
  }
  const Residuals::Likeliest at = more.likeliest();
  const double alike = more.correlation(at.asymmetry);
  return (at.log - less.likeliest().log) / alike -
         freedom / 2 * std::log(std::max(2.0, samples / alike));
}

namespace {

void tell(std::string_view kind, const MirrorFit& fit, Result& result) {
  result.score = score_of(fit, kind);
  result.statistics["mapped_share"] = result.statistics["explained_share"] = fit.share;
  result.statistics["missing_share"] = fit.missing;
  result.statistics["covered_share"] = 1 - fit.missing;
  result.statistics["contradicted_share"] = std::max(0.0, 1 - fit.share - fit.missing);
  result.statistics["exact_share"] = fit.exact;
  result.statistics["deviation"] = fit.deviation;
  if (prior_of(kind)) result.statistics["log_odds"] = fit.log_odds;
}

// Exact mirrors come first, then those that map more; of equal ones that with more exact partners.
std::pair<double, double> order_of(const MirrorFit& fit) {
  return {fit.exact >= 1 ? infinity : fit.share, fit.exact};
}

}  // namespace

void MirrorScore::fill(const Mirror& mirror, Result& result) const {
  // Shares that say by themselves whether a mirror is found.
  constexpr double certain = 0.97, too_little = 0.3;
  with_fit_of(mirror, 1, [&](const MirrorFit& its, const auto& fits, const auto& image) {
    tell(mirror.kind(), its, result);
    const Evidence found = its.share > certain ? Evidence{1}
                           : its.share < too_little
                               ? Evidence{0}
                               : evidence(image, fits, chance_motions(fits, surface_, cloud_),
                                          surface_, unmapped(fits));
    result.statistics["evidence"] = found.sure;
    result.statistics["deciding_share"] = found.deciding;
    const Uncertainty uncertainty(fits, surface_);
    result.statistics["angle_sd"] = uncertainty.angle * 180 / std::numbers::pi;
    result.statistics["offset_sd"] = uncertainty.offset * cloud_.frame.size;
  });
}

Result MirrorScore::ranked(const std::string& method,
                           const std::vector<std::shared_ptr<Mirror>>& mirrors) const {
  constexpr std::size_t closely = 4;
  struct Ranked {
    std::shared_ptr<Mirror> mirror;
    MirrorFit fit;
  };
  const auto better = [](const Ranked& a, const Ranked& b) {
    return order_of(a.fit) > order_of(b.fit);
  };
  std::vector<Ranked> found;
  for (const std::shared_ptr<Mirror>& mirror : mirrors) found.push_back({mirror, fit(*mirror, 3)});
  std::stable_sort(found.begin(), found.end(), better);
  const auto end = found.begin() + static_cast<std::ptrdiff_t>(std::min(closely, found.size()));
  std::for_each(found.begin(), end, [&](Ranked& one) { one.fit = fit(*one.mirror); });
  std::stable_sort(found.begin(), end, better);
  Result best;
  for (const Ranked& one : found) {
    const bool is_best = &one == &found.front();
    Result& result = is_best ? best : best.candidates.emplace_back();
    result.method = method;
    result.mirror = one.mirror;
    tell(one.mirror->kind(), one.fit, result);
  }
  fill(best);
  // Of a mirror that others fit no better, none is surer.
  for (Result& other : best.candidates) other.score = std::min(other.score, best.score);
  return best;
}

double score_of(const MirrorFit& fit, std::string_view kind) {
  if (fit.exact >= 1) return 1;
  const double likely = prior_of(kind) ? 1 / (1 + std::exp(-fit.log_odds)) : 1;
  return fit.share * std::max(fit.exact, likely);
}

bool is_exact(const Result& result) { return statistic(result, "exact_share") >= 1; }

}  // namespace symsurf
