#include "mirror_score.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "mirror_layers.h"
#include "parallel.h"
#include "plane/agreement.h"
#include "quantile.h"

namespace symsurf {

namespace {

// Patches large enough to average what is crooked in a small way.
constexpr Index coarse_size = 400, most_samples = 1600;
constexpr double reach = 0.06;  // how far a partner may be
constexpr double least_moved = 0.35;
constexpr double exact = 1e-6;  // of the cloud's size: the rounding of single precision

// What the best mirror of a kind explains of random blobs, less what the best plane does; and,
// since of two mirrors that explain the same the simpler is meant, what its freedom costs.
struct Freedom {
  double by_chance = 0, cost = 0;
  // Without it, sheets as near as patches are wide become one: freer kinds, which are theirs, keep
  // it.
  NoiseIs noise = NoiseIs::kept;
  bool anywhere = false;  // it may have any height over each place
};

Freedom freedom_of(std::string_view kind) {
  static const std::map<std::string_view, Freedom> freedoms{
      {"plane", {0, 0, NoiseIs::smoothed}},
      {"sphere", {0.15, 0.01, NoiseIs::extrapolated}},
      {"cylinder", {0.15, 0.02, NoiseIs::extrapolated}},
      {"quadric", {0.4, 0.03}},
      {"height field", {0.85, 0.05, NoiseIs::kept, true}},
      {"free-form", {0.65, 0.06, NoiseIs::kept, true}},
  };
  const auto found = freedoms.find(kind);
  return found == freedoms.end() ? Freedom() : found->second;
}

// Patches that are apart agree less than neighbours' do.
double agreement_apart(NoiseIs noise) {
  switch (noise) {
    case NoiseIs::smoothed:
      return 0.93;
    case NoiseIs::extrapolated:
      return 0.85;
    default:
      return 1;
  }
}

// The image's normal, from where its tangents go: exact whatever the mirror's curvature.
Vector3 image_normal(const Mirror& mirror, const Vector3& x, const Vector3& normal,
                     const Vector3& image, double step) {
  const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vector3 along = mirror.reflect(Vector3(x + step * u)) - image;
  const Vector3 across = mirror.reflect(Vector3(x + step * v)) - image;
  return along.cross(across).normalized();
}

}  // namespace

double distance_past(const Vector3& gap, const Facet& partner, double spacing) {
  const auto squared = [](double x) { return x * x; };
  const double length = gap.norm(), off_sheet = gap.dot(partner.normal);
  const double along_sheet = std::sqrt(std::max(0.0, squared(length) - squared(off_sheet)));
  const double sheet = squared(off_sheet) + squared(0.3 * std::max(0.0, along_sheet - spacing));
  const double blob = squared(0.6 * std::max(0.0, length - spacing));
  const double flat = squared(partner.flatness), round = squared(1 - partner.flatness);
  return std::min(std::sqrt(flat * sheet + round * blob), 3 * length);
}

MirrorScore::MirrorScore(const Cloud& cloud, const NearestPoints& points, const Context& context)
    : cloud_(cloud),
      points_(points),
      coarse_(cloud, coarse_size, context.stage(0, 0.5)),
      fine_(cloud, coarse_, context.stage(0.5, 1)),
      spacing_(coarse_.spacing_of(cloud.total)),
      places_(coarse_, fine_, {}, cloud.total) {
  take_samples();
  look_at_neighbours();
}

void MirrorScore::take_samples() {
  const Index step = std::max<Index>(1, fine_.size() / most_samples);
  for (Index k = 0; k < fine_.size(); k += step) {
    const Vector3 x = fine_[k].sampled;
    if (const Surfel* surfel = surfel_at(x)) samples_.push_back({x, surfel});
  }
}

void MirrorScore::look_at_neighbours() {
  if (samples_.empty()) return;
  const std::vector<Vector3> nearest = neighbours_of(samples_, cloud_.frame, points_);
  const SheetNoise noise(samples_, nearest, fine_);
  places_ = SheetPlaces(coarse_, fine_, noise, cloud_.total);
  neighbours_.fill(said(nearest, NoiseIs::kept));
  if (!noise.shows()) return;
  for (const NoiseIs taken_off : {NoiseIs::smoothed, NoiseIs::extrapolated})
    neighbours_[static_cast<std::size_t>(taken_off)] = said(nearest, taken_off);
}

// Neighbours tell how far noise, or curvature between sparse points, takes a point off the surface:
// less than that is no miss. Without the noise, which their patches have in common, they agree more
// than patches apart from each other.
MirrorScore::Neighbours MirrorScore::said(const std::vector<Vector3>& nearest,
                                          NoiseIs noise) const {
  struct Look {
    double residual, facing, uncertain;
  };
  std::vector<Look> looks;
  std::vector<double> residuals;
  Neighbours all;
  for (const OnSheet& s : samples_) all.samples.push_back(places_.at(s.position, noise));
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const OnSheet& s = samples_[k];
    const Surfel* partner = surfel_at(nearest[k]);
    if (!partner) continue;
    const Located& here = all.samples[k];
    const Located there = places_.at(nearest[k], noise);
    const Vector3 gap = here.place - there.place;
    const Agreement agreement(gap, s.surfel->normal, s.surfel->flatness, *partner);
    residuals.push_back(distance_past(gap, *partner, spacing_));
    looks.push_back(
        {residuals.back(), agreement.facing, std::hypot(here.uncertain, there.uncertain)});
  }
  if (looks.empty()) return all;
  all.roughness = median(std::move(residuals));
  const auto surer = [](const Look& a, const Look& b) { return a.uncertain < b.uncertain; };
  const double least = std::min_element(looks.begin(), looks.end(), surer)->uncertain;
  all.testimony = all.testimony.of(all.roughness);
  // A sheet is no mirror of the noise on its two sides.
  all.moved_tolerance = std::hypot(all.moved_tolerance, 10 * std::hypot(all.roughness, least));
  double sum = 0;
  for (const Look& look : looks)
    sum += all.testimony.of(look.uncertain)(look.residual, look.facing);
  const double as_alike = least > 0 ? agreement_apart(noise) : 1;
  all.explain = as_alike * sum / static_cast<double>(samples_.size());
  return all;
}

Explained MirrorScore::explained(const Mirror& mirror) const {
  const Freedom freedom = freedom_of(mirror.kind());
  const Neighbours& own = neighbours(freedom.noise);
  if (!(own.explain > 0)) return {};
  const double size = cloud_.frame.size;
  double moved = 0, sum = 0, exactly = 0;
  struct Moved {
    std::size_t sample;
    double weight;
    Vector3 to;  // its image
  };
  std::vector<Moved> asked;
  std::vector<Vector3> images;
  std::optional<MirrorLayers> layers;
  if (freedom.anywhere)
    layers.emplace(0.7 * fine_.spacing() * size, 15 * own.roughness * size, size);
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    const OnSheet& s = samples_[k];
    const Located& from = own.samples[k];
    const Vector3 x = cloud_.frame.leave(s.position), image = mirror.reflect(x);
    const Vector3 place = cloud_.frame.leave(from.place);
    const Vector3 to = from.uncertain > 0 ? mirror.reflect(place) : image;
    if (!image.allFinite() || !to.allFinite()) {
      moved += 1;
      continue;
    }
    if (layers) layers->add(x, cloud_.frame.axes * s.surfel->normal, image);
    const double weight = displaced((to - place).norm() / (2 * size), own.moved_tolerance);
    if (weight <= 0) continue;
    moved += weight;
    asked.push_back({k, weight, to});
    images.push_back(image);
  }
  const std::vector<Vector3> partners = points_.nearest(images, reach * size);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!partners[k].allFinite()) continue;
    const auto& [sample, weight, to] = asked[k];
    const Surfel& surfel = *samples_[sample].surfel;
    const Located& from = own.samples[sample];
    const Vector3 at = cloud_.frame.enter(partners[k]);
    const Surfel* partner = surfel_at(at);
    if (!partner) continue;
    if ((cloud_.frame.enter(images[k]) - at).norm() < exact) exactly += weight;
    const Vector3 normal = image_normal(mirror, cloud_.frame.leave(from.place),
                                        cloud_.frame.axes * surfel.normal, to, 1e-4 * size);
    if (!normal.allFinite()) continue;
    const Located other = places_.at(at, freedom.noise);
    const Vector3 gap = cloud_.frame.enter(to) - other.place;
    const Agreement agreement(gap, cloud_.frame.axes.transpose() * normal, surfel.flatness,
                              *partner);
    const Testimony testimony = own.testimony.of(std::hypot(from.uncertain, other.uncertain));
    sum += weight * testimony(distance_past(gap, *partner, spacing_), agreement.facing);
  }
  const double witnesses = std::max(moved, least_moved * static_cast<double>(samples_.size()));
  return {std::clamp(sum / witnesses / own.explain, 0.0, 1.0), exactly / witnesses,
          layers ? layers->single() : 0};
}

void MirrorScore::fill(Result& result) const {
  const Explained found = explained(*result.mirror);
  result.score = discounted(found, result.mirror->kind());
  result.statistics["explained_share"] = found.share;
  result.statistics["exact_share"] = found.exactly;
  if (freedom_of(result.mirror->kind()).anywhere)
    result.statistics["single_layer"] = found.single_layer;
}

Result MirrorScore::ranked(const std::string& method,
                           const std::vector<std::shared_ptr<Mirror>>& mirrors,
                           Index settled) const {
  std::vector<Result> found;
  for (const std::shared_ptr<Mirror>& mirror : mirrors) {
    Result& result = found.emplace_back();
    result.method = method;
    result.mirror = mirror;
    fill(result);
  }
  std::stable_sort(found.begin() + settled, found.end(),
                   [](const Result& a, const Result& b) { return a.score > b.score; });
  Result best = std::move(found.front());
  best.candidates.assign(std::make_move_iterator(found.begin() + 1),
                         std::make_move_iterator(found.end()));
  return best;
}

double discounted(const Explained& explained, std::string_view kind) {
  const Freedom freedom = freedom_of(kind);
  const double by_chance = freedom.by_chance * (1 - explained.exactly);
  const double beyond = std::max(0.0, explained.share - by_chance) / (1 - by_chance);
  const double placed = explained.single_layer * (1 - explained.exactly);
  return (1 - freedom.cost) * (1 - placed) * beyond;
}

}  // namespace symsurf
