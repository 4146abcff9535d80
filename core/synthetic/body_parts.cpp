#include "body_parts.h"

#include <algorithm>
#include <cmath>

namespace symsurf {

namespace {

constexpr double hard_band = 0.006;  // thinner than any wall

// Below 0 inside, and the unit direction of its fastest growth. Inside, and right before a face,
// the distance from the surface.
double outside(const Block& block, const Vector3& x, Vector3& gradient) {
  const Vector3 local = block.axes.transpose() * (x - block.centre);
  double most = std::abs(local.z()) - block.half.z();
  gradient = local.z() < 0 ? Vector3(-block.axes.col(2)) : Vector3(block.axes.col(2));
  if (block.round) {
    const double radius = std::sqrt(local.x() * local.x() + local.y() * local.y());
    if (radius - block.half.x() <= most || radius == 0) return most;
    gradient = (local.x() * block.axes.col(0) + local.y() * block.axes.col(1)) / radius;
    return radius - block.half.x();
  }
  for (int axis = 0; axis < 2; ++axis) {
    const double past = std::abs(local[axis]) - block.half[axis];
    if (past <= most) continue;
    most = past;
    gradient = local[axis] < 0 ? Vector3(-block.axes.col(axis)) : Vector3(block.axes.col(axis));
  }
  return most;
}

}  // namespace

Block Block::mirrored() const {
  Block image = *this;
  image.centre.z() = -centre.z();
  image.axes.row(2) = -axes.row(2);
  return image;
}

HardBody::HardBody(std::vector<Block> blocks) : blocks_(std::move(blocks)) {
  low_ = Vector3::Constant(1e9);
  high_ = -low_;
  for (const Block& block : blocks_) {
    if (block.hole) continue;
    Vector3 reach;
    for (int axis = 0; axis < 3; ++axis)
      reach[axis] = std::abs(block.axes(axis, 0)) * block.half.x() +
                    std::abs(block.axes(axis, 1)) * block.half.y() +
                    std::abs(block.axes(axis, 2)) * block.half.z();
    low_ = low_.cwiseMin(block.centre - reach);
    high_ = high_.cwiseMax(block.centre + reach);
  }
}

double HardBody::value(const Vector3& x, Vector3& gradient) const {
  double least = 1e9, most = -1e9;
  Vector3 from_blocks = Vector3::UnitX(), from_holes = Vector3::UnitX(), own;
  for (const Block& block : blocks_) {
    const double past = outside(block, x, own);
    if (!block.hole && past < least) {
      least = past;
      from_blocks = own;
    }
    if (block.hole && -past > most) {
      most = -past;
      from_holes = -own;
    }
  }
  gradient = most > least ? from_holes : from_blocks;
  return std::max(least, most);
}

// From inside only: outside an edge a band would fold onto the edge.
Vector3 HardBody::point(Random& random) const {
  constexpr double on_surface = 1e-12;
  constexpr int steps = 3;
  for (;;) {
    Vector3 x, gradient;
    for (int axis = 0; axis < 3; ++axis) x[axis] = random.uniform(low_[axis], high_[axis]);
    double past = value(x, gradient);
    if (!(past < 0) || past < -hard_band) continue;
    for (int step = 0; step < steps && std::abs(past) > on_surface; ++step) {
      x -= past * gradient;
      past = value(x, gradient);
    }
    if (std::abs(past) <= on_surface) return x;
  }
}

namespace {

constexpr double level = 0.5;
// Of a limb's reach: where (1 - d^2)^3 falls to the level.
constexpr double surface_at = 0.4542;
// Points this close to the surface are moved onto it; as evenly spread as the band is thick.
constexpr double soft_band = 0.01;

}  // namespace

SoftBody::SoftBody(std::vector<Limb> limbs) : limbs_(std::move(limbs)) {
  low_ = Vector3::Constant(1e9);
  high_ = -low_;
  for (const Limb& limb : limbs_) {
    if (limb.weight < 0) continue;
    // Where limbs add up, their surface lies further out than that of each.
    const Vector3 reach = Vector3::Constant(1.6 * limb.radius);
    low_ = low_.cwiseMin((limb.a - reach).cwiseMin(limb.b - reach));
    high_ = high_.cwiseMax((limb.a + reach).cwiseMax(limb.b + reach));
  }
}

double SoftBody::value(const Vector3& x, Vector3& gradient) const {
  double sum = -level;
  gradient.setZero();
  for (const Limb& limb : limbs_) {
    const double reach = limb.radius / surface_at;
    const Vector3 along = limb.b - limb.a;
    const double length = along.squaredNorm();
    const double t = length > 0 ? std::clamp(along.dot(x - limb.a) / length, 0.0, 1.0) : 0.0;
    const Vector3 off = x - limb.a - t * along;
    const double left = 1 - off.squaredNorm() / (reach * reach);
    if (left <= 0) continue;
    sum += limb.weight * left * left * left;
    gradient -= 6 * limb.weight / (reach * reach) * left * left * off;
  }
  return sum;
}

Vector3 SoftBody::point(Random& random) const {
  constexpr double on_surface = 1e-12;
  constexpr int steps = 8;
  for (;;) {
    Vector3 x, gradient;
    for (int axis = 0; axis < 3; ++axis) x[axis] = random.uniform(low_[axis], high_[axis]);
    double inside = value(x, gradient);
    if (!(inside * inside < soft_band * soft_band * gradient.squaredNorm())) continue;
    for (int step = 0; step < steps && std::abs(inside) > on_surface; ++step) {
      x -= inside / gradient.squaredNorm() * gradient;
      inside = value(x, gradient);
    }
    if (std::abs(inside) <= on_surface) return x;
  }
}

SoftBody SoftBody::with_bumps(int count, double least, double greatest, bool symmetric,
                              Random& random) const {
  std::vector<Limb> limbs = limbs_;
  for (int k = 0; k < count; ++k) {
    const Vector3 at = point(random);
    const Limb bump{at, at, random.uniform(least, greatest),
                    random.uniform(0, 1) < 0.6 ? 0.5 : -0.4};
    limbs.push_back(bump);
    if (symmetric) limbs.push_back(bump.mirrored());
  }
  return SoftBody(std::move(limbs));
}

}  // namespace symsurf
