#include "score/mirror_score.h"

#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/math.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "pairing/correspondence.h"
#include "score/mirror_layers.h"

namespace symsurf {

namespace {

// Lengths are in diagonals.
constexpr Index sample_count = 500;                             // points whose support is measured
constexpr double least_radius = 0.035, greatest_radius = 0.15;  // of the balls
constexpr double points_in_ball = 18;  // cells, in the median, where the cloud is that dense
constexpr double far_off = 4.5;        // tolerances: the worst miss
// One random split of so many points is as good as any; of fewer several are compared.
constexpr Index many = 10000, most_splits = 4;
// From which distance from the mirror on a point counts in full, near which any surface is
// symmetric: at least, in standard deviations of the noise, in shares of the cloud's extent.
constexpr double least_moved = 0.006, moved_by_noise = 5, moved_by_extent = 0.25;
constexpr double most_moved = 0.1;      // of few points scattered at random all passes for noise
constexpr double layer_of_noise = 15;   // standard deviations: what lies farther apart is no layer
constexpr double least_share = 0.2;     // of all points, that the mean is taken over
constexpr double least_ceiling = 0.25;  // of points too few to say anything of each other
constexpr double rounding = 1e-6;       // single precision
constexpr double held_out = 0.06;       // radius of the windows that sides are predicted over

// What mirrors of a kind are free to do. Of two that fit alike the simpler is meant: `cost`, of
// the score. Of random solids the best quadric maps 0.6, the best plane, sphere and cylinder 0.4:
// what is beyond `by_chance` favours a quadric.
struct Freedom {
  double cost = 0, by_chance = 0;
  // Of a kind that may have any height over each position.
  struct Evidence {
    double open, closed;  // nats, to begin with: closed where MirrorLayers has a single one
  };
  std::optional<Evidence> any_shape = {};
};

// So the best free forms of 1 % of 216 random bodies (1500 to 40,000 points, clean, noisy and with
// holes) have a score of 0.5, and 71 % of the right ones of 65 bent bodies. Any solid has a height
// field half-way through it, along any direction.
Freedom freedom_of(std::string_view kind) {
  static const std::map<std::string_view, Freedom> freedoms{
      {"sphere", {0.01}},
      {"cylinder", {0.02}},
      {"quadric", {0.03, 0.2}},
      {"height field", {0.05, 0, {{3, -3}}}},
      {"free-form", {0.06, 0, {{3, 0}}}},
  };
  const auto found = freedoms.find(kind);
  return found == freedoms.end() ? Freedom() : found->second;
}

// Parts of a shape, each of which a mirror of any shape maps by chance or not.
constexpr double parts = 30;

// Score of a plane from which on nobody asks whether the shape slides over itself: no sheet without
// a mirror has so much.
constexpr double beyond_doubt = 0.9;

void tell(std::string_view kind, const MirrorFit& fit, Result& result) {
  result.score = score_of(fit, kind);
  result.statistics["explained_share"] = std::min(1.0, fit.share);
  result.statistics["exact_share"] = fit.exact;
  result.statistics["covered_share"] = fit.covered;
  result.statistics["deviation"] = fit.deviation;
  if (freedom_of(kind).any_shape) result.statistics["evidence"] = fit.evidence;
}

Eigen::Isometry3d reflection_over(const UnitPlane& plane) {
  const Vector3& normal = plane.normal;
  Eigen::Isometry3d reflection(Matrix3(Matrix3::Identity() - 2 * normal * normal.transpose()));
  reflection.translation() = -2 * plane.offset * normal;
  return reflection;
}

// Next to a plane: turned both ways about the direction along it in which the cloud is thinnest and
// the one across, and shifted to both sides.
std::vector<UnitPlane> planes_beside(const UnitPlane& plane) {
  constexpr double angle = 0.2, shift = 0.025;  // radians, diagonals
  const Vector3& normal = plane.normal;
  const Vector3 thinnest = Vector3::UnitZ() - normal.z() * normal;
  const Vector3 first =
      thinnest.norm() > 1e-6 ? thinnest.normalized() : Vector3(normal.unitOrthogonal());
  std::vector<UnitPlane> found;
  for (const double side : {-1.0, 1.0}) {
    for (const Vector3& axis : {first, Vector3(normal.cross(first))}) {
      const Vector3 turned = Eigen::AngleAxisd(side * angle, axis) * normal;
      found.push_back({turned, plane.offset * turned.dot(normal)});
    }
    found.push_back({normal, plane.offset + side * shift});
  }
  return found;
}

}  // namespace

MirrorScore::MirrorScore(const Cloud& cloud, const Context& context)
    : cloud_(cloud),
      points_(cloud, context.stage(0, 0)),
      tolerance_{cloud.tolerance, far_off * cloud.tolerance},
      coarse_(cloud.patches(sample_count, context.stage(0, 0.5))) {
  const Index splits = std::clamp<Index>(many / cloud.points.size(), 1, most_splits);
  for (Index k = 0; k < splits; ++k) splits_.emplace_back(cloud, coarse_, k);
  radius_ = radius_for(splits_.front());
  // A surface is no mirror of the noise on its two sides.
  noise_ = measured_noise();
  moved_ = std::clamp(moved_by_noise * noise_, least_moved, most_moved);
  if (cloud.vertices) mesh_.emplace(*cloud.vertices, context.stage(0.5, 0.5));
  for (Index k = 0; k < coarse_.size(); ++k) {
    const Vector3& x = coarse_[k].sampled;
    const std::size_t split = k % splits;
    const CloudHalves& halves = splits_[split];
    const Ball own(halves.one, x, radius_), other(halves.two, x, radius_);
    const double ceiling = BallSupport(own, other, tolerance_).support;
    samples_.push_back({x, split, own, std::max(least_ceiling, ceiling)});
  }
}

double MirrorScore::measured_noise() const {
  std::vector<OnSurface> samples;
  for (Index k = 0; k < coarse_.size(); ++k) samples.push_back({coarse_[k].sampled, &coarse_[k]});
  return SurfaceNoise(samples, neighbours_of(samples, cloud_.frame, points_)).deviation();
}

double MirrorScore::radius_for(const CloudHalves& halves) const {
  constexpr double growth = 1.15;
  constexpr Index stride = 8;
  const auto typical_count = [&](double radius) {
    std::vector<double> counts;
    for (Index k = 0; k < coarse_.size(); k += stride)
      counts.push_back(Ball(halves.one, coarse_[k].sampled, radius).count);
    return median(std::move(counts));
  };
  double radius = least_radius;
  while (radius * growth <= greatest_radius && typical_count(radius) < points_in_ball)
    radius *= growth;
  return radius;
}

ThinnedHalf MirrorScore::mirrored(const ThinnedHalf& half, const Mirror& mirror) const {
  const PrincipalFrame& frame = cloud_.frame;
  Points images(half.points.rows(), 3);
  for (Index i = 0; i < images.rows(); ++i) {
    const Vector3 image = mirror.reflect(frame.from_frame(half.points.row(i).transpose()));
    images.row(i) = frame.to_frame(image).transpose();
  }
  return ThinnedHalf(finite_rows(std::move(images)));
}

// Both sides' surfaces where the line to the image meets them: the means of the balls, as the noise
// is less there. Where it hardly meets them the distance of surfaces is unreliable.
void MirrorScore::add_sides(const Sample& sample, const Ball& image, const Vector3& to_image,
                            MirrorSides& sides) {
  constexpr double steepest = 0.5;  // cosine
  const double length = to_image.norm();
  const Vector3 along = to_image / length;
  const Vector3 normal = sample.ball.normal();
  const double facing = normal.dot(along);
  if (std::abs(facing) < steepest) return;
  const double own = normal.dot(sample.ball.mean) / facing, other = normal.dot(image.mean) / facing;
  const double half = (length - own - other) / 2;
  if (half > 0) sides.add({sample.position + to_image / 2, along, (own - other) / 2, half});
}

MirrorFit MirrorScore::fit(const Mirror& mirror, std::size_t stride) const {
  const PrincipalFrame& frame = cloud_.frame;
  const auto of_mesh = [&](MirrorFit found) {
    if (mesh_ && found.share > 0 && (*mesh_)(mirror, cloud_.points))
      found.share = found.covered = found.exact = 1;
    return found;
  };
  if (mirror.kind() == "plane") {
    const Eigen::Isometry3d reflection = reflection_over(in_frame(mirror, frame));
    return of_mesh(whole_of(point_fits(reflection, stride), stride));
  }
  const Freedom freedom = freedom_of(mirror.kind());
  MirrorLayers layers(0.7 * splits_.front().cell * frame.size, layer_of_noise * noise_ * frame.size,
                      frame.size);
  MirrorSides sides(held_out);
  std::vector<std::optional<ThinnedHalf>> images(splits_.size());  // where any sample asks for them
  const std::vector<PointFit> points = point_fits(
      [&](const Vector3& x) { return mirror.reflect(x); },
      [&](const Sample& sample) {
        std::optional<ThinnedHalf>& image = images[sample.split];
        if (!image) image.emplace(mirrored(splits_[sample.split].two, mirror));
        return Ball(*image, sample.position, radius_);
      },
      stride, freedom.any_shape ? &layers : nullptr, freedom.any_shape ? &sides : nullptr);
  MirrorFit found = whole_of(points, stride);
  if (freedom.any_shape) {
    const auto [open, closed] = *freedom.any_shape;
    found.evidence = (layers.single() > 0 ? closed : open) + sides.evidence() +
                     parts * std::log(std::clamp(found.share, 0.01, 1.0));
  }
  return of_mesh(found);
}

double MirrorScore::distinctive_share(const Mirror& plane) const {
  constexpr double least = 0.1;  // of its weight, that a point keeps whatever it says
  const UnitPlane here = in_frame(plane, cloud_.frame);
  // What the planes beside it map at each sample: the most, but for one of them.
  std::vector<std::array<double, 2>> beside(samples_.size(), {0, 0});
  for (const UnitPlane& other : planes_beside(here))
    for (const PointFit& point : point_fits(reflection_over(other))) {
      const double share = point.weight > 0 ? std::min(1.0, point.support / point.weight) : 0;
      auto& [most, next] = beside[point.point];
      next = std::max(next, std::min(most, share));
      most = std::max(most, share);
    }
  double weights = 0, support = 0;
  for (const PointFit& point : point_fits(reflection_over(here))) {
    const double tells = least + (1 - least) * (1 - beside[point.point][1]);
    weights += tells * point.weight;
    support += tells * point.support;
  }
  return weights > 0 ? std::clamp(support / weights, 0.0, 1.0) : 0;
}

std::vector<PointFit> MirrorScore::point_fits(const Eigen::Isometry3d& map,
                                              std::size_t stride) const {
  const PrincipalFrame& frame = cloud_.frame;
  const Eigen::Isometry3d back = map.inverse();
  return point_fits(
      [&](const Vector3& x) -> Vector3 { return frame.from_frame(map * frame.to_frame(x)); },
      [&](const Sample& sample) {
        return Ball(splits_[sample.split].two, back * sample.position, radius_).moved(map.linear());
      },
      stride, nullptr, nullptr);
}

// Points without an image first.
template <typename Image, typename ImageBall>
std::vector<PointFit> MirrorScore::point_fits(const Image& image_of, const ImageBall& image_ball,
                                              std::size_t stride, MirrorLayers* layers,
                                              MirrorSides* sides) const {
  const PrincipalFrame& frame = cloud_.frame;
  struct Moved {
    std::size_t sample;
    double distance;  // from the mirror
  };
  std::vector<PointFit> fits;
  std::vector<Moved> asked;
  std::vector<Vector3> images;
  for (std::size_t k = 0; k < samples_.size(); k += stride) {
    const Sample& sample = samples_[k];
    const Vector3 x = frame.from_frame(sample.position), image = image_of(x);
    if (!image.allFinite()) {
      fits.push_back({k, sample.ceiling, 0, sample.ceiling});
      continue;
    }
    if (layers) layers->add(x, frame.axes * sample.ball.normal(), image);
    const double distance = (image - x).norm() / (2 * frame.size);
    if (distance < rounding) continue;
    asked.push_back({k, distance});
    images.push_back(image);
  }
  if (asked.empty()) return {};
  const std::vector<Vector3> partners = points_.nearest(images, tolerance_.far * frame.size);
  std::vector<double> partnered{0};
  for (std::size_t k = 0; k < asked.size(); ++k)
    if (partners[k].allFinite()) partnered.push_back(asked[k].distance);
  const double extent = quantile(std::move(partnered), 0.95);
  const double in_full = std::max(moved_, moved_by_extent * extent);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const auto& [index, distance] = asked[k];
    const Sample& sample = samples_[index];
    const double gap = (partners[k] - images[k]).norm() / frame.size;  // NaN where there is none
    if (gap < rounding) {
      fits.push_back({index, 1, 1, 0, 0, true});
      continue;
    }
    const double displacement = displaced(distance, in_full);
    if (displacement <= 0) continue;
    const Ball image = image_ball(sample);
    const BallSupport found(sample.ball, image, tolerance_);
    if (sides && found.support > 0)
      add_sides(sample, image, frame.to_frame(images[k]) - sample.position, *sides);
    const double weight = displacement * sample.ceiling;
    fits.push_back({index, weight, displacement * found.support, weight * found.missing,
                    weight * found.rim, false, found.apart});
  }
  return fits;
}

MirrorFit MirrorScore::whole_of(const std::vector<PointFit>& points, std::size_t stride) const {
  double ceilings = 0, weights = 0, support = 0, missing = 0, exact = 0;
  for (std::size_t k = 0; k < samples_.size(); k += stride) ceilings += samples_[k].ceiling;
  std::vector<double> deviations{0};
  for (const PointFit& point : points) {
    if (point.support > 0) deviations.push_back(point.deviation);
    weights += point.weight;
    support += point.support;
    missing += point.missing;
    if (point.exact) exact += point.weight;
  }
  if (!(weights > 0)) return {};
  const double exact_share = exact / weights;
  const double least = least_share * (1 - exact_share) * ceilings;
  return {std::max(0.0, support / std::max(weights, least)), 1 - missing / weights, exact_share,
          median(std::move(deviations)) * cloud_.frame.size};
}

void MirrorScore::fill(const Mirror& mirror, const MirrorFit& fit, Result& result) const {
  tell(mirror.kind(), fit, result);
  if (mirror.kind() == "plane" && result.score < beyond_doubt)
    result.statistics["distinctive_share"] = distinctive_share(mirror);
}

Result MirrorScore::ranked(const std::string& method,
                           const std::vector<std::shared_ptr<Mirror>>& mirrors) const {
  struct Ranked {
    std::shared_ptr<Mirror> mirror;
    MirrorFit fit;
    double merit;
  };
  std::vector<Ranked> found;
  for (const std::shared_ptr<Mirror>& mirror : mirrors) {
    MirrorFit its = fit(*mirror);
    const double rank = merit(its, mirror->kind());
    found.push_back({mirror, std::move(its), rank});
  }
  // Of those that chance explains, the one that it explains least.
  std::stable_sort(found.begin(), found.end(), [](const Ranked& a, const Ranked& b) {
    return std::pair(a.merit, a.fit.share) > std::pair(b.merit, b.fit.share);
  });
  Result best;
  for (const Ranked& one : found) {
    const bool is_best = &one == &found.front();
    Result& result = is_best ? best : best.candidates.emplace_back();
    result.method = method;
    result.mirror = one.mirror;
    if (is_best)
      fill(*one.mirror, one.fit, result);
    else
      tell(one.mirror->kind(), one.fit, result);
  }
  cap_candidates(best);
  return best;
}

double merit(const MirrorFit& fit, std::string_view kind) {
  if (fit.exact >= 1) return infinity;
  const double others = 1 - fit.exact;
  const Freedom freedom = freedom_of(kind);
  const double by_chance = freedom.by_chance * others;
  return (1 - freedom.cost * others) * std::max(0.0, fit.share - by_chance) / (1 - by_chance);
}

double score_of(const MirrorFit& fit, std::string_view kind) {
  if (fit.exact >= 1) return 1;
  const double likely = freedom_of(kind).any_shape ? 1 / (1 + std::exp(-fit.evidence)) : 1;
  return std::min(1.0, merit(fit, kind) * std::max(fit.exact, likely));
}

double statistic(const Result& result, const char* name) {
  const auto found = result.statistics.find(name);
  return found == result.statistics.end() ? 0 : std::get<double>(found->second);
}

bool is_exact(const Result& result) { return statistic(result, "exact_share") >= 1; }

void cap_candidates(Result& result) {
  for (Result& other : result.candidates) other.score = std::min(other.score, result.score);
}

}  // namespace symsurf
