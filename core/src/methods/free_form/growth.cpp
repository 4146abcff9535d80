#include "methods/free_form/growth.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace symsurf::perpendicular {

namespace {

constexpr double tolerance = 1.3;     // spacings between an image and its partner
constexpr double fit_radius = 4.0;    // spacings
constexpr double most_turned = 0.65;  // sine of the angle
const double steepest = std::cos(30 * M_PI / 180);
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
