#include "score/mirror_score.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "base/math.h"
#include "cloud/surface_noise.h"
#include "mirrors/mirror_layers.h"
#include "score/correspondence.h"
#include "score/mirror_sides.h"

namespace symsurf {

namespace {

// Lengths are in diagonals. Chosen on sampled meshes, scans and random solids of 1000 to 100,000
// points with noise of 0 to 2 %: shapes with a mirror score 0.5 and more, others 0.42 at most
// (`make accuracy OPTIONS='--cases none "one shape" "more noise"'`).
constexpr Index sample_count = 500;                            // points whose support is measured
constexpr double least_radius = 0.05, greatest_radius = 0.15;  // of the balls
constexpr Index points_in_ball = 30;  // in the median, where the cloud is that dense
constexpr double near = 0.004, far = 0.018, penalty = 1.2;
// Shares of a ball's points: fewer on one side are a rim, as many are there by chance.
constexpr double strip = 0.5, whole = 0.7;
constexpr double unsure = 0.006;   // standard error of a mean, at which it counts half
constexpr double sparse = 0.2;     // of the median count of points: fewer are no surface
constexpr double in_volume = 0.4;  // weight of a point inside a volume, on a surface 1
constexpr double by_chance = 0.1;  // probability of a neighbour: likelier ones do not count
// From which distance from the mirror on a point counts in full, near which any surface is
// symmetric: at least, in standard deviations of the noise, in shares of the cloud's extent.
constexpr double least_moved = 0.006, moved_by_noise = 5, moved_by_extent = 0.25;
constexpr double most_moved = 0.1;     // of few points scattered at random all passes for noise
constexpr double layer_of_noise = 15;  // standard deviations: what lies farther apart is no layer
constexpr double least_share = 0.2;    // of all points, that the mean is taken over
constexpr double rounding = 1e-6;      // single precision
constexpr double held_out = 0.06;      // radius of the windows that sides are predicted over

// Of random solids the best plane, sphere and cylinder fit 0.4 at most, the best quadric 0.6, the
// best free form 0.96 and the best height field, as any convex solid has one, 0.98: what is beyond
// `by_chance` favours the last three. Of two mirrors that fit alike the simpler is meant:
// `cost`.
struct Freedom {
  double by_chance = 0, cost = 0;
  bool any_shape = false;  // it may have any height over each position
};

Freedom freedom_of(std::string_view kind) {
  static const std::map<std::string_view, Freedom> freedoms{
      {"sphere", {0, 0.01}},
      {"cylinder", {0, 0.02}},
      {"quadric", {0.2, 0.03}},
      {"height field", {0.85, 0.05, true}},
      {"free-form", {0.8, 0.06, true}},
  };
  const auto found = freedoms.find(kind);
  return found == freedoms.end() ? Freedom() : found->second;
}

// Evidence, in nats, of which half is believed: so the best free forms of 192 random bodies (1000
// to 10,000 points, half of them with noise of 1 %) score 0.43 at most.
constexpr double doubt = 10;

double squared(double x) { return x * x; }

}  // namespace

MirrorScore::Spread::Spread(const Matrix3& covariance, double radius) {
  Eigen::SelfAdjointEigenSolver<Matrix3> solver;
  solver.computeDirect(covariance);
  variances = solver.eigenvalues().cwiseMax(0);
  axes = solver.eigenvectors();
  // Of points that fill the ball, weighted by 1 - (distance / radius)^2.
  const double filled = squared(radius) / 7;
  constexpr double thin = 0.25, thick = 0.5;
  thinness = ((thick - variances.array() / filled) / (thick - thin)).cwiseMax(0).cwiseMin(1);
  const bool is_line = variances[1] <= 0.02 * variances[2];
  flatness = is_line ? 0 : 1 - std::sqrt(variances[0] / variances[1]);
}

MirrorScore::MirrorScore(const Cloud& cloud, const NearestPoints& points, const Context& context,
                         Cells cells)
    : cloud_(cloud),
      points_(points),
      coarse_(cloud, sample_count, context.stage(0, 0.5)),
      fine_(cloud, coarse_, context.stage(0.5, 1)),
      thinned_(thinned(fine_, cells)) {
  for (Index k = 0; k < coarse_.size(); ++k) samples_.push_back({coarse_[k].sampled, {}, 0, 1});
  choose_radius();
  // A surface is no mirror of the noise on its two sides.
  noise_ = measured_noise();
  moved_ = std::clamp(moved_by_noise * noise_, least_moved, most_moved);
  std::vector<double> counts;
  for (Sample& sample : samples_) {
    sample.ball = ball_of(thinned_, sample.position);
    const Spread spread(sample.ball.covariance, radius_);
    const double error = spread.variances[0] * 2 / std::max(1.0, sample.ball.effective);
    sample.surface = spread.surface() / (1 + error / squared(unsure));
    counts.push_back(sample.ball.count);
  }
  const double full = sparse * median(std::move(counts));
  for (Sample& sample : samples_) sample.density = std::min(1.0, sample.ball.count / full);
}

double MirrorScore::measured_noise() const {
  std::vector<OnSurface> samples;
  for (Index k = 0; k < coarse_.size(); ++k) samples.push_back({coarse_[k].sampled, &coarse_[k]});
  return SurfaceNoise(samples, neighbours_of(samples, cloud_.frame, points_)).deviation();
}

void MirrorScore::choose_radius() {
  constexpr double growth = 1.15;
  constexpr std::size_t stride = 8;
  const auto typical_count = [&] {
    std::vector<double> counts;
    for (std::size_t k = 0; k < samples_.size(); k += stride)
      counts.push_back(ball_of(thinned_, samples_[k].position).count);
    return median(std::move(counts));
  };
  radius_ = least_radius;
  while (radius_ * growth <= greatest_radius && typical_count() < points_in_ball) radius_ *= growth;
}

MirrorScore::Ball MirrorScore::ball_of(const PointSet& set, const Vector3& x) const {
  Ball ball;
  double weights = 0, squares = 0;
  Matrix3 products = Matrix3::Zero();  // its lower triangle
  const double per_squared = 1 / squared(radius_);
  set.tree.within(x, radius_, [&](Index i, double squared_distance) {
    const double weight = set.weights[i] * (1 - squared_distance * per_squared);
    const Vector3 offset = set.points.row(i).transpose() - x, weighted = weight * offset;
    ball.count += set.weights[i];
    weights += weight;
    squares += squared(weight);
    ball.mean += weighted;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column <= row; ++column)
        products(row, column) += weighted[row] * offset[column];
  });
  if (!(weights > 0)) return ball;
  ball.effective = squared(weights) / squares;
  ball.mean /= weights;
  ball.covariance = products.selfadjointView<Eigen::Lower>();
  ball.covariance = ball.covariance / weights - ball.mean * ball.mean.transpose();
  return ball;
}

double MirrorScore::Sample::weighed(double surface, double on_surface, double in_body) const {
  return density * (surface * on_surface + in_volume * (1 - surface) * in_body);
}

MirrorScore::PointSet MirrorScore::thinned(const Surfels& fine, Cells cells) {
  Points positions(fine.size(), 3);
  std::vector<double> counts;
  for (Index k = 0; k < fine.size(); ++k) {
    positions.row(k) = fine[k].position.transpose();
    counts.push_back(fine[k].count);
  }
  if (cells == Cells::by_points) {
    const double typical = median(counts);
    for (double& count : counts) count /= typical;
    return {std::move(positions), std::move(counts)};
  }
  const double full = sparse * median(counts);
  for (double& count : counts) count = std::min(1.0, count / full);
  return {std::move(positions), std::move(counts)};
}

MirrorScore::PointSet MirrorScore::mirrored(const Mirror& mirror) const {
  const PrincipalFrame& frame = cloud_.frame;
  Points images(thinned_.points.rows(), 3);
  std::vector<double> weights;
  for (Index i = 0; i < images.rows(); ++i) {
    const Vector3 image = mirror.reflect(frame.from_frame(thinned_.points.row(i).transpose()));
    if (!image.allFinite()) continue;
    images.row(static_cast<Index>(weights.size())) = frame.to_frame(image).transpose();
    weights.push_back(thinned_.weights[i]);
  }
  images.conservativeResize(static_cast<Index>(weights.size()), 3);
  return {std::move(images), std::move(weights)};
}

MirrorScore::Support MirrorScore::supported(const Sample& sample, const Ball& image) const {
  constexpr double least = 3;
  if (image.count < least) return {0, 1, 0, sample.surface};
  const Spread own(sample.ball.covariance, radius_), other(image.covariance, radius_);
  const Vector3 gap = sample.ball.mean - image.mean;
  // Less twice the variance that few points leave to the gap.
  const auto across = [&](const Spread& spread, double effective) {
    const Vector3 along = spread.axes.transpose() * gap;
    const Vector3 left = along.cwiseAbs2() - 4 / effective * spread.variances;
    return spread.thinness.dot(left);
  };
  // At a rim, where one ball holds but a strip, the other shows which way the surface goes.
  const double one = across(own, sample.ball.effective), two = across(other, image.effective);
  const auto [less, more] = std::minmax(sample.ball.count, image.count);
  const double of_whole = more == image.count ? two : one;
  const double shared = std::clamp((less / more - strip) / (whole - strip), 0.0, 1.0);
  const double offset = std::max(0.0, shared * std::max(one, two) + (1 - shared) * of_whole);
  const double complete = std::min(1.0, less / (whole * more));
  const double cosine = own.axes.col(0).dot(other.axes.col(0));
  const double turned = own.flatness * other.flatness * (1 - squared(cosine));
  const double missed = offset / squared(far);
  const double on_surface = complete * (squared(1 - turned) / (1 + offset / squared(near)) -
                                        penalty * missed * std::exp(1 - missed));
  const bool at_rim = more == image.count;
  return {on_surface, at_rim ? 0 : 1 - complete, at_rim ? 1 - complete : 0,
          std::max(sample.surface, other.surface() * sample.surface)};
}

// Both sides' surfaces where the line to the image meets them: the means of the balls, as the noise
// is less there. Where it hardly meets them the distance of surfaces is unreliable.
void MirrorScore::add_sides(const Sample& sample, const Ball& image, const Vector3& to_image,
                            MirrorSides& sides) const {
  constexpr double steepest = 0.5;  // cosine
  const double length = to_image.norm();
  const Vector3 along = to_image / length;
  const Vector3 normal = Spread(sample.ball.covariance, radius_).axes.col(0);
  const double facing = normal.dot(along);
  if (std::abs(facing) < steepest) return;
  const double own = normal.dot(sample.ball.mean) / facing, other = normal.dot(image.mean) / facing;
  const double half = (length - own - other) / 2;
  if (half > 0) sides.add({sample.position + to_image / 2, along, (own - other) / 2, half});
}

MirrorFit MirrorScore::fit(const Mirror& mirror, std::size_t stride) const {
  const PrincipalFrame& frame = cloud_.frame;
  std::optional<MirrorLayers> layers;
  MirrorSides sides(held_out);
  if (freedom_of(mirror.kind()).any_shape)
    layers.emplace(0.7 * fine_.spacing() * frame.size, layer_of_noise * noise_ * frame.size,
                   frame.size);
  std::optional<PointSet> images;  // made for the first ball, as a mirror may move nothing
  const std::vector<PointFit> points =
      point_fits([&](const Vector3& x) { return mirror.reflect(x); },
                 [&](const Vector3& x) {
                   if (!images) images.emplace(mirrored(mirror));
                   return ball_of(*images, x);
                 },
                 stride, layers ? &*layers : nullptr, layers ? &sides : nullptr);
  return whole_of(points, stride, layers ? &*layers : nullptr, &sides);
}

std::vector<PointFit> MirrorScore::point_fits(const Eigen::Isometry3d& map,
                                              std::size_t stride) const {
  const PrincipalFrame& frame = cloud_.frame;
  const Eigen::Isometry3d back = map.inverse();
  return point_fits(
      [&](const Vector3& x) -> Vector3 { return frame.from_frame(map * frame.to_frame(x)); },
      [&](const Vector3& x) {
        Ball ball = ball_of(thinned_, back * x);
        ball.mean = map.linear() * ball.mean;
        ball.covariance = map.linear() * ball.covariance * map.linear().transpose();
        return ball;
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
      fits.push_back({k, sample.weight()});
      continue;
    }
    if (layers)
      layers->add(x, frame.axes * Spread(sample.ball.covariance, radius_).axes.col(0), image);
    const double distance = (image - x).norm() / (2 * frame.size);
    if (distance < rounding) continue;
    asked.push_back({k, distance});
    images.push_back(image);
  }
  if (asked.empty()) return {};
  const std::vector<Vector3> partners = points_.nearest(images, far * frame.size);
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
      fits.push_back({index, sample.weight(), sample.weight(), 0, 0, true});
      continue;
    }
    const double displacement = displaced(distance, in_full);
    if (displacement <= 0) continue;
    const Ball image = image_ball(sample.position);
    const auto [on_surface, missing, rim, surface] = supported(sample, image);
    if (sides && on_surface > 0)
      add_sides(sample, image, frame.to_frame(images[k]) - sample.position, *sides);
    // How likely a neighbour as near is of points spread at random in the volume of the ball.
    const double density = sample.ball.count * static_cast<double>(cloud_.partition.total()) /
                           static_cast<double>(thinned_.points.rows());
    const double chance = 1 - std::exp(-density * std::pow(gap / radius_, 3));
    const double in_body = std::isnan(gap) ? 0 : std::max(0.0, 1 - chance / by_chance);
    fits.push_back({index, displacement * sample.weighed(surface, 1, 1),
                    displacement * sample.weighed(surface, on_surface, in_body),
                    displacement * sample.weighed(surface, missing, std::isnan(gap) ? 1 : 0),
                    displacement * sample.weighed(surface, rim, 0)});
  }
  return fits;
}

MirrorFit MirrorScore::whole_of(const std::vector<PointFit>& points, std::size_t stride,
                                const MirrorLayers* layers, const MirrorSides* sides) const {
  double all = 0, weights = 0, support = 0, exact = 0;
  for (std::size_t k = 0; k < samples_.size(); k += stride) all += samples_[k].weight();
  for (const PointFit& point : points) {
    weights += point.weight;
    support += point.support;
    if (point.exact) exact += point.weight;
  }
  if (!(weights > 0)) return {};
  const double exact_share = exact / weights;
  const double least = least_share * (1 - exact_share) * all;
  return {std::clamp(support / std::max(weights, least), 0.0, 1.0), exact_share,
          layers ? layers->single() : 0, layers ? sides->evidence() : 0};
}

void MirrorScore::fill(Result& result) const {
  const MirrorFit found = fit(*result.mirror);
  result.score = score_of(found, result.mirror->kind());
  result.statistics["explained_share"] = found.share;
  result.statistics["exact_share"] = found.exact;
  if (freedom_of(result.mirror->kind()).any_shape) {
    result.statistics["single_layer"] = found.single_layer;
    result.statistics["evidence"] = found.evidence;
  }
}

Result MirrorScore::ranked(const std::string& method,
                           const std::vector<std::shared_ptr<Mirror>>& mirrors) const {
  std::vector<Result> found;
  for (const std::shared_ptr<Mirror>& mirror : mirrors) {
    Result& result = found.emplace_back();
    result.method = method;
    result.mirror = mirror;
    fill(result);
  }
  // Of those that chance explains, the one that it explains least.
  const auto merit = [](const Result& r) {
    return std::pair(beyond_chance(r), std::get<double>(r.statistics.at("explained_share")));
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const Result& a, const Result& b) { return merit(a) > merit(b); });
  Result best = std::move(found.front());
  best.candidates.assign(std::make_move_iterator(found.begin() + 1),
                         std::make_move_iterator(found.end()));
  cap_candidates(best);
  return best;
}

double score_of(const MirrorFit& fit, std::string_view kind) {
  const Freedom freedom = freedom_of(kind);
  const double chance = 1 - fit.exact;
  const double beyond =
      std::max(0.0, fit.share - freedom.by_chance * chance) / (1 - freedom.by_chance * chance);
  const double believed = fit.share * fit.evidence / (fit.evidence + doubt);
  return (1 - freedom.cost * chance) * std::max((1 - fit.single_layer * chance) * beyond, believed);
}

double beyond_chance(const Result& result) {
  const auto number = [&](const char* name) {
    const auto found = result.statistics.find(name);
    return found == result.statistics.end() ? 0 : std::get<double>(found->second);
  };
  return score_of({number("explained_share"), number("exact_share"), number("single_layer")},
                  result.mirror->kind());
}

void cap_candidates(Result& result) {
  for (Result& other : result.candidates) other.score = std::min(other.score, result.score);
}

}  // namespace symsurf
