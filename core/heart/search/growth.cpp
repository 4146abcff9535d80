#include "search/growth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/math.h"
#include "base/parallel.h"

namespace symsurf::perpendicular {

namespace {

constexpr Index first_ends = 500;
constexpr std::size_t most_tested = 2500;
const double parallel_enough = std::cos(30 * std::numbers::pi / 180);
constexpr double normal_consistency = 0.8;  // cosine between chord and normals
constexpr double shortest_chord = 1.2;      // spacings

double support_of(const SearchCloud& cloud, std::int32_t i, std::int32_t j) {
  const Vector3 middle = (cloud.point(i) + cloud.point(j)) / 2;
  const Vector3 u = (cloud.point(i) - cloud.point(j)).normalized();
  constexpr int sampled = 8;
  double sum = 0;
  for (const std::int32_t end : {i, j}) {
    for (int k = 0; k < sampled; ++k) {
      const Vector3 x = cloud.point(cloud.neighbours(end, k));
      const Vector3 image = x - 2 * u.dot(x - middle) * u;
      const double tau = 0.6 * cloud.spacing;
      const Neighbour near = cloud.tree.nearest(image, 9 * tau * tau);
      if (near.index >= 0) sum += std::exp(-near.squared_distance / (2 * tau * tau));
    }
    if (end == i && sum < 0.25 * sampled) return 0;
  }
  return sum / (2 * sampled);
}

// A fair sample of as many seeds as wanted (Vitter 1985: reservoir sampling).
class Reservoir {
 public:
  Reservoir(std::size_t most, std::uint64_t seed) : most_(most), random_(seed) {
    seeds_.reserve(most);
  }

  void add(const Seed& seed) {
    ++seen_;
    if (seeds_.size() < most_) {
      seeds_.push_back(seed);
    } else if (const std::size_t slot = random_() % seen_; slot < most_) {
      seeds_[slot] = seed;
    }
  }
  std::vector<Seed>& seeds() { return seeds_; }

 private:
  std::size_t most_, seen_ = 0;
  std::mt19937_64 random_;
  std::vector<Seed> seeds_;
};

}  // namespace

Seeds find_seeds(const SearchCloud& cloud, std::uint64_t seed, const Context& context) {
  Reservoir along(most_tested, seed), across(most_tested, seed + 1);
  const double shortest = shortest_chord * cloud.spacing;
  const Index ends = std::min(first_ends, cloud.size());
  for (Index e = 0; e < ends; ++e) {
    context.check();
    const std::int32_t i = cloud.tree.order()[e * cloud.size() / ends];
    const Vector3 x = cloud.point(i), n = cloud.normal(i);
    for (Index j = 0; j < cloud.size(); ++j) {
      const Vector3 chord = x - cloud.point(j);
      const double squared = chord.squaredNorm();
      if (squared < shortest * shortest) continue;
      const Vector3 other = cloud.normal(j);
      const double first = n.dot(chord), second = other.dot(chord);
      if (std::abs(n.dot(other) - 2 * first * second / squared) < parallel_enough) continue;
      const bool faces = std::min(first * first, second * second) >
                         normal_consistency * normal_consistency * squared;
      (faces ? along : across).add({i, static_cast<std::int32_t>(j)});
    }
  }
  Seeds seeds{std::move(along.seeds()), std::move(across.seeds())};
  for (std::vector<Seed>* kind : {&seeds.along, &seeds.across}) {
    const Context half = kind == &seeds.along ? context.stage(0, 0.5) : context.stage(0.5, 1);
    parallel_for(half, static_cast<Index>(kind->size()), 256, [&](Index begin, Index end) {
      for (Index s = begin; s < end; ++s)
        (*kind)[s].support = support_of(cloud, (*kind)[s].first, (*kind)[s].second);
    });
    std::stable_sort(kind->begin(), kind->end(),
                     [](const Seed& a, const Seed& b) { return a.support > b.support; });
  }
  return seeds;
}

namespace {

constexpr double tolerance = 1.3;     // spacings between an image and its partner
constexpr double fit_radius = 4.0;    // spacings
constexpr double most_turned = 0.65;  // sine of the angle
const double steepest = std::cos(30 * std::numbers::pi / 180);
constexpr char most_tries = 3;

}  // namespace

Growth::Growth(const SearchCloud& cloud, const Seed& seed)
    : cloud_(&cloud),
      partner_(cloud.size(), -1),
      guide_(cloud.size(), -1),
      patch_of_(cloud.size(), -1),
      slot_of_(cloud.size(), 0),
      tries_(cloud.size(), 0) {
  const Vector3 x = cloud.point(seed.first), y = cloud.point(seed.second);
  Patch plane;
  plane.centre = (x + y) / 2;
  plane.frame = frame_of((x - y).normalized());
  plane.height.setZero();
  plane.radius = 3 * cloud.spacing;
  for (const std::int32_t end : {seed.first, seed.second}) {
    accept(end, plane);
    for (int k = 0; k < 8; ++k) accept(cloud.neighbours(end, k), plane);
  }
  if (accepted_.size() < 6) {
    accepted_.clear();
    return;
  }
  for (const std::int32_t i : accepted_) refit(i);
  for (const std::int32_t i : accepted_) refit(i);
}

bool Growth::carry(std::int32_t i, const Patch& guide, Carried& c, std::int32_t& partner) const {
  const Vector3 x = cloud_->point(i);
  if (!patch_foot(guide, x, c.foot, c.normal)) return false;
  c.distance = c.normal.dot(x - c.foot);
  const Vector3 image = x - 2 * c.distance * c.normal;
  const double reach = tolerance * std::max(cloud_->spacing, cloud_->spacings[i]);
  const Neighbour near = cloud_->tree.nearest(image, reach * reach);
  if (near.index < 0 || near.index == i) return false;
  const Vector3 y = cloud_->point(near.index), chord = x - y;
  // What the sampling alone turns a chord by does not count against it.
  if (std::abs(chord.dot(c.normal)) < steepest * chord.norm() - 0.5 * reach) return false;
  const Vector3 n = cloud_->normal(i), other = cloud_->normal(near.index);
  const double cosine = std::abs(other.dot(n - 2 * c.normal.dot(n) * c.normal));
  c.turned = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  if (c.turned > most_turned) return false;
  c.miss = y - image;
  c.partner_normal = cloud_->normal(near.index);
  partner = static_cast<std::int32_t>(near.index);
  return true;
}

bool Growth::accept(std::int32_t i, const Patch& guide) {
  if (partner_[i] >= 0) return false;
  Carried c;
  if (!carry(i, guide, c, partner_[i])) return false;
  patch_of_[i] = static_cast<std::int32_t>(patches_.size());
  Patch own = guide;
  own.centre = c.foot;
  own.frame = frame_of(c.normal);
  own.height.setZero();
  patches_.push_back(own);
  carried_.push_back(c);
  accepted_.push_back(i);
  return true;
}

void Growth::refine() {
  for (const std::int32_t i : accepted_) {
    Carried c;
    std::int32_t partner;
    if (!carry(i, patch(i), c, partner)) continue;
    carried_[patch_of_[i]] = c;
    partner_[i] = partner;
  }
  std::vector<double> misses;
  for (const Carried& c : carried_) misses.push_back(c.miss.squaredNorm());
  exact_ = median(std::move(misses)) < 0.25 * 0.25 * cloud_->spacing * cloud_->spacing;
  along_ = exact_ ? 1 : 0.08;
  for (const std::int32_t i : accepted_) refit(i);
}

void Growth::refit(std::int32_t i) {
  cloud_->context.check();
  static thread_local std::vector<Carried> data;
  static thread_local std::vector<std::int32_t> listed;
  data.clear();
  listed.clear();
  // A point that is met more than once is nearer the middle of it all, and weighs more.
  const auto meet = [&](std::int32_t j) {
    if (partner_[j] < 0) return;
    const auto slot = static_cast<std::size_t>(slot_of_[j]);
    if (slot < listed.size() && listed[slot] == j) {
      data[slot].weight += 1;
    } else {
      slot_of_[j] = static_cast<std::int32_t>(listed.size());
      listed.push_back(j);
      data.push_back(carried(j));
    }
  };
  // Where partners are exact, few data determine a patch; elsewhere noise averages out over more.
  const int stride = exact_ ? SearchCloud::ring : 5;
  for (const std::int32_t end : {i, partner_[i]}) {
    meet(end);
    for (int k = 0; k < SearchCloud::ring; ++k) {
      const std::int32_t other = cloud_->neighbours(end, k);
      meet(other);
      for (int l = stride - 1; l < SearchCloud::ring; l += stride)
        meet(cloud_->neighbours(other, l));
    }
  }
  const Carried& own = carried(i);
  FitWeights weights;
  weights.radius = fit_radius * cloud_->spacing;
  weights.along = along_;
  weights.robust_scale = 0.6 * cloud_->spacing;
  Patch patch;
  if (fit_patch(own.foot, own.normal, data, weights, patch)) patches_[patch_of_[i]] = patch;
}

double Growth::nearest_squared(std::int32_t i, std::int32_t by) const {
  const Vector3 x = cloud_->point(i);
  return std::min((x - cloud_->point(by)).squaredNorm(),
                  (x - cloud_->point(partner_[by])).squaredNorm());
}

void Growth::guide_neighbours(std::int32_t i) {
  const auto offer = [&](std::int32_t to) {
    if (partner_[to] >= 0 || tries_[to] >= most_tries) return;
    if (guide_[to] < 0) {
      frontier_.push_back(to);
      guide_[to] = i;
    } else if (nearest_squared(to, i) < nearest_squared(to, guide_[to])) {
      guide_[to] = i;
    }
  };
  offer(partner_[i]);
  for (const std::int32_t end : {i, partner_[i]})
    for (int k = 0; k < SearchCloud::ring; ++k) offer(cloud_->neighbours(end, k));
}

void Growth::grow(Index most) {
  while (fresh_ < accepted_.size() && static_cast<Index>(accepted_.size()) < most) {
    frontier_.clear();
    const std::size_t ring = accepted_.size();
    for (std::size_t a = fresh_; a < ring; ++a) guide_neighbours(accepted_[a]);
    fresh_ = ring;
    for (const std::int32_t i : frontier_) {
      cloud_->context.check();
      // A copy: accepting adds patches.
      const Patch guide = patches_[patch_of_[guide_[i]]];
      guide_[i] = -1;
      if (!accept(i, guide)) ++tries_[i];
    }
    for (std::size_t a = ring; a < accepted_.size(); ++a) refit(accepted_[a]);
  }
}

double Growth::closeness() const {
  double sum = 0;
  for (const std::int32_t i : accepted_)
    sum += perpendicular::closeness(carried(i), cloud_->spacing);
  return accepted_.empty() ? 0 : sum / static_cast<double>(accepted_.size());
}

}  // namespace symsurf::perpendicular
