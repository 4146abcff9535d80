#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {

namespace {

using Row = Eigen::Matrix<double, 6, 1>;
using Normal = Eigen::Matrix<double, 6, 6>;

struct Equation {
  std::array<Row, 3> rows;
  Vector3 right;
  double weight = 0;
};

// What an equation adds to the normal equations at weight 1: the lower triangle, row by row, the
// right side, and a zero to fill the vector.
using Products = std::array<double, 28>;

Products products_of(const Equation& q) {
  Products products{};
  auto* next = products.data();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j, ++next)
      for (const Row& row : q.rows) *next += row[i] * row[j];
  for (int i = 0; i < 6; ++i, ++next)
    for (int a = 0; a < 3; ++a) *next += q.right[a] * q.rows[a][i];
  return products;
}

SYMSURF_VECTORISED void add_weighted(const double* products, const double* weights,
                                     std::size_t count, double* __restrict sum) {
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t k = 0; k < 28; ++k) sum[k] += weights[e] * products[28 * e + k];
}

}  // namespace

double closeness(const Carried& c, double spacing) {
  constexpr double across_scale = 0.3, angle_scale = 0.3, exact_scale = 0.2, exact_share = 0.3;
  const double across = c.miss.dot(c.partner_normal) / (across_scale * spacing);
  const double angle = c.turned / angle_scale;
  const double exact = c.miss.squaredNorm() / (exact_scale * exact_scale * spacing * spacing);
  return (1 - exact_share) * std::exp(-(across * across + angle * angle) / 2) +
         exact_share * std::exp(-exact / 2);
}

bool fit_patch(const Vector3& centre, const Vector3& normal, const std::vector<Carried>& data,
               const FitWeights& weights, Patch& patch) {
  patch.centre = centre;
  patch.frame = frame_of(normal);
  const double unit = weights.radius;  // coordinates in units of the radius: well scaled

  static thread_local std::vector<Equation> equations;
  static thread_local std::vector<Products> products;
  static thread_local std::vector<double> trusted;
  equations.clear();
  products.clear();
  double total = 0;
  for (const Carried& c : data) {
    const Vector3 at = patch.frame * (c.foot - centre), n = patch.frame * c.normal;
    const double squared = at.squaredNorm() / (unit * unit);
    if (squared >= 1 || n.z() < 0.3) continue;
    Equation q;
    q.weight = c.weight * (1 - squared) * (1 - squared) * (1 - squared);
    total += q.weight;
    const double s = at.x() / unit, t = at.y() / unit;
    Row height, slope_s, slope_t;
    height << 1, s, t, s * s, s * t, t * t;
    slope_s << 0, 1, 0, 2 * s, t, 0;
    slope_t << 0, 0, 1, 0, s, 2 * t;
    // Where the mirror was: the patch's heights are measured from there.
    const double old_height = at.z() / unit;
    const double old_s = -n.x() / n.z(), old_t = -n.y() / n.z();
    const Vector3 miss = patch.frame * c.miss / unit;
    const Vector3 across = patch.frame * c.partner_normal;
    Matrix3 metric =
        weights.along * Matrix3::Identity() + (1 - weights.along) * across * across.transpose();
    const double d = c.distance / unit;
    // dx' = 2 (P - old) cos n + 2 d (grad P - old slope)
    std::array<Row, 3> shift;
    Vector3 right = miss / 2;
    for (int a = 0; a < 3; ++a) {
      shift[a] = n[a] * n.z() * height;
      right[a] += n[a] * n.z() * old_height;
    }
    shift[0] += d * slope_s;
    shift[1] += d * slope_t;
    right[0] += d * old_s;
    right[1] += d * old_t;
    for (int a = 0; a < 3; ++a)
      q.rows[a] = metric(a, 0) * shift[0] + metric(a, 1) * shift[1] + metric(a, 2) * shift[2];
    q.right = metric * right;
    equations.push_back(q);
    products.push_back(products_of(q));
  }
  if (equations.size() < 3) return false;

  Row solution = Row::Zero();
  static thread_local std::vector<double> misses, sorted;
  misses.resize(equations.size());
  for (int pass = 0; pass < weights.passes; ++pass) {
    double scale = 0;
    if (pass > 0) {
      for (std::size_t e = 0; e < equations.size(); ++e) {
        const Equation& q = equations[e];
        double squared = 0;
        for (int a = 0; a < 3; ++a) {
          const double r = q.rows[a].dot(solution) - q.right[a];
          squared += r * r;
        }
        misses[e] = 2 * std::sqrt(squared) * unit;
      }
      sorted = misses;
      const auto middle = sorted.begin() + sorted.size() / 2;
      std::nth_element(sorted.begin(), middle, sorted.end());
      scale = std::max(weights.robust_scale, 1.5 * *middle);
    }
    trusted.resize(equations.size());
    for (std::size_t e = 0; e < equations.size(); ++e)
      trusted[e] = equations[e].weight * (pass > 0 ? biweight(misses[e] / (4.7 * scale)) : 1);
    Products sum{};
    add_weighted(products.front().data(), trusted.data(), products.size(), sum.data());
    Normal matrix;
    const double* at = sum.data();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j, ++at) matrix(i, j) = matrix(j, i) = *at;
    const Row right = Row::Map(at);
    // Little data: prefer flat to wild.
    for (int k = 3; k < 6; ++k)
      matrix(k, k) += 1e-3 * total / static_cast<double>(equations.size());
    for (int k = 0; k < 3; ++k) matrix(k, k) += 1e-12 * total;
    const Row next = solved(matrix, right);
    if (!next.allFinite()) return false;
    solution = next;
  }
  patch.height = solution;
  patch.height[0] *= unit;
  patch.height.tail<3>() /= unit;
  patch.radius = weights.radius;
  return true;
}

bool patch_foot(const Patch& patch, const Vector3& x, Vector3& foot, Vector3& normal) {
  const Vector3 at = patch.frame * (x - patch.centre);
  const auto& h = patch.height;
  double s = 0, t = 0;
  Vector3 n;
  for (int step = 0; step < 8; ++step) {
    const double z = h[0] + h[1] * s + h[2] * t + h[3] * s * s + h[4] * s * t + h[5] * t * t;
    const double zs = h[1] + 2 * h[3] * s + h[4] * t, zt = h[2] + h[4] * s + 2 * h[5] * t;
    // Half the gradient of the squared distance, and its Gauss-Newton-plus-curvature matrix.
    const double up = z - at.z();
    const Eigen::Vector2d g(s - at.x() + up * zs, t - at.y() + up * zt);
    Eigen::Matrix2d m;
    m << 1 + zs * zs + 2 * up * h[3], zs * zt + up * h[4], zs * zt + up * h[4],
        1 + zt * zt + 2 * up * h[5];
    if (m.determinant() <= 0.01 || m.trace() <= 0) {
      m << 1 + zs * zs, zs * zt, zs * zt, 1 + zt * zt;
    }
    const Eigen::Vector2d move = m.inverse() * g;
    s -= move.x();
    t -= move.y();
    if (s * s + t * t > 4 * patch.radius * patch.radius) return false;
    if (move.norm() < 1e-6 * patch.radius) break;
  }
  const double z = h[0] + h[1] * s + h[2] * t + h[3] * s * s + h[4] * s * t + h[5] * t * t;
  n << -(h[1] + 2 * h[3] * s + h[4] * t), -(h[2] + h[4] * s + 2 * h[5] * t), 1;
  foot = patch.centre + patch.frame.transpose() * Vector3(s, t, z);
  normal = (patch.frame.transpose() * n).normalized();
  return true;
}

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
