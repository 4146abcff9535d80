#include <algorithm>
#include <cmath>
#include <vector>

#include "generators.h"

namespace symsurf {

namespace {

Vector3 in_box(const Vector3& low, const Vector3& high, Random& random) {
  Vector3 x;
  for (int axis = 0; axis < 3; ++axis) x[axis] = random.uniform(low[axis], high[axis]);
  return x;
}

// Parts of a body, each beside the mirror with its image there; without a mirror each is drawn by
// itself, on either side.
template <typename Part>
class Parts {
 public:
  Parts(bool symmetric, Random& random) : symmetric_(symmetric), random_(random) {}

  std::vector<Part> all;

  template <typename Draw>
  void pair(const Draw& draw) {
    const Part first = draw();
    all.push_back(first);
    all.push_back(symmetric_ ? first.mirrored() : draw().mirrored());
  }
  // On the mirror; without one, beside it.
  void middle(Part part, double beside);

 private:
  bool symmetric_;
  Random& random_;
};

template <>
void Parts<Limb>::middle(Limb limb, double beside) {
  if (!symmetric_) {
    limb.a.z() += random_.uniform(-beside, beside);
    limb.b.z() += random_.uniform(-beside, beside);
  }
  all.push_back(limb);
}

template <>
void Parts<Block>::middle(Block block, double beside) {
  if (!symmetric_) block.centre.z() += random_.uniform(-beside, beside);
  all.push_back(block);
}

std::unique_ptr<RandomBody> creature(bool symmetric, Random& random) {
  Parts<Limb> limbs(symmetric, random);
  const double trunk = random.uniform(0.07, 0.12);
  const Vector3 neck(0.28, random.uniform(0, 0.08), 0);
  limbs.middle({Vector3(-0.28, 0, 0), neck, trunk}, 0.1);
  const Vector3 head = neck + in_box({0.08, 0.02, 0}, {0.16, 0.15, 0}, random);
  limbs.middle({neck, head, 0.5 * trunk}, 0.1);
  limbs.middle(
      {head, head + in_box({0.02, -0.05, 0}, {0.1, 0.03, 0}, random), random.uniform(0.05, 0.09)},
      0.1);
  const Vector3 tail = Vector3(-0.3, 0.02, 0) + in_box({-0.2, -0.1, 0}, {-0.1, 0.15, 0}, random);
  limbs.middle({Vector3(-0.28, 0, 0), tail, random.uniform(0.02, 0.04)}, 0.15);
  limbs.pair([&] {
    const Vector3 ear = head + in_box({-0.02, 0.03, 0.03}, {0.02, 0.06, 0.06}, random);
    return Limb{ear, ear + in_box({-0.05, 0.02, 0.01}, {0.02, 0.1, 0.08}, random), 0.02};
  });
  const int pairs = 2 + static_cast<int>(random.below(3));
  for (int k = 0; k < pairs; ++k) {
    const double at = -0.26 + 0.5 * k / (pairs - 1);
    const Vector3 reach = in_box({-0.06, -0.14, 0.06}, {0.06, 0.02, 0.16}, random);
    const Vector3 further = in_box({-0.1, -0.22, -0.02}, {0.1, -0.08, 0.1}, random);
    const double thick = random.uniform(0.025, 0.045);
    const auto varied = [&](const Vector3& way) {
      return symmetric ? way : Vector3(way + in_box({-0.1, -0.1, -0.05}, {0.1, 0.1, 0.1}, random));
    };
    Vector3 knee;
    const Vector3 hip(at, 0, 0.6 * trunk);
    const Vector3 first = varied(reach), second = varied(reach);
    limbs.all.push_back({hip, hip + first, thick});
    limbs.all.push_back(Limb{hip, hip + second, thick}.mirrored());
    const Vector3 third = varied(further), fourth = varied(further);
    limbs.all.push_back({hip + first, hip + first + third, 0.7 * thick});
    limbs.all.push_back(Limb{hip + second, hip + second + fourth, 0.7 * thick}.mirrored());
  }
  const int bumps = 10 + static_cast<int>(random.below(20));
  return std::make_unique<SoftBody>(
      SoftBody(limbs.all).with_bumps(bumps, 0.015, 0.03, symmetric, random));
}

SoftBody head(bool symmetric, Random& random) {
  Parts<Limb> limbs(symmetric, random);
  const double size = random.uniform(0.2, 0.26);
  limbs.middle({Vector3(-0.08, 0, 0), Vector3(0.06, random.uniform(0, 0.08), 0), size}, 0.06);
  const double jaw = random.uniform(0.1, 0.25);
  limbs.middle({Vector3(0.1, -0.2, 0), Vector3(0.1 + jaw, -0.25, 0), random.uniform(0.08, 0.12)},
               0.12);
  limbs.middle({Vector3(0.25, 0, 0), Vector3(0.3, -0.08, 0), random.uniform(0.03, 0.06)}, 0.1);
  const int lumps = 3 + static_cast<int>(random.below(3));
  for (int k = 0; k < lumps; ++k)
    limbs.pair([&] {
      const Vector3 at = in_box({-0.3, -0.25, 0.06}, {0.25, 0.25, 0.22}, random);
      return Limb{at, at, random.uniform(0.06, 0.13)};
    });
  limbs.pair([&] {  // sockets
    const Vector3 at = in_box({0.2, 0, 0.06}, {0.26, 0.1, 0.12}, random);
    return Limb{at, at, random.uniform(0.04, 0.06), -0.8};
  });
  limbs.pair([&] {  // ears
    const Vector3 at = in_box({-0.1, -0.02, 0.2}, {0.05, 0.15, 0.24}, random);
    return Limb{at, at + in_box({-0.1, 0, 0.04}, {0, 0.16, 0.1}, random), 0.035};
  });
  const int bumps = 20 + static_cast<int>(random.below(30));
  return SoftBody(limbs.all).with_bumps(bumps, 0.02, 0.05, symmetric, random);
}

// As a scanner in front of a head sees it.
class Mask : public RandomBody {
 public:
  Mask(bool symmetric, Random& random)
      : head_(head(symmetric, random)), cut_(random.uniform(-0.05, 0.08)) {}

  Vector3 point(Random& random) const override {
    for (;;)
      if (const Vector3 x = head_.point(random); x.x() > cut_) return x;
  }

 private:
  SoftBody head_;
  double cut_;
};

Matrix3 turned_axes(double most, Random& random) {
  // By a quaternion near 1.
  const double x = random.uniform(-most, most), y = random.uniform(-most, most),
               z = random.uniform(-most, most), s = 2 / (1 + x * x + y * y + z * z);
  Matrix3 axes;
  axes << 1 - s * (y * y + z * z), s * (x * y - z), s * (x * z + y),  //
      s * (x * y + z), 1 - s * (x * x + z * z), s * (y * z - x),      //
      s * (x * z - y), s * (y * z + x), 1 - s * (x * x + y * y);
  return axes;
}

std::unique_ptr<RandomBody> part(bool symmetric, Random& random) {
  Parts<Block> blocks(symmetric, random);
  const Matrix3 upright = Matrix3::Identity();
  Matrix3 standing;  // a cylinder along y
  standing << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const double thick = random.uniform(0.03, 0.06);
  blocks.middle({Vector3(0, -0.15, 0), Vector3(0.38, thick, random.uniform(0.15, 0.25)), upright,
                 false, false},
                0.1);
  blocks.middle({in_box({-0.25, 0, 0}, {-0.1, 0, 0}, random),
                 in_box({0.05, 0.15, 0.08}, {0.1, 0.25, 0.08}, random),
                 turned_axes(symmetric ? 0 : 0.3, random), false, false},
                0.12);
  const double boss = random.uniform(0.07, 0.12);
  const Vector3 top(random.uniform(0.1, 0.25), 0, 0);
  blocks.middle({top, Vector3(boss, boss, random.uniform(0.15, 0.25)), standing, true, false},
                0.12);
  blocks.middle({top, Vector3(0.6 * boss, 0.6 * boss, 1), standing, true, true}, 0.02);
  const int ribs = 2 + static_cast<int>(random.below(3));
  for (int k = 0; k < ribs; ++k)
    blocks.pair([&] {
      return Block{in_box({-0.3, -0.15, 0.1}, {0.3, 0.1, 0.25}, random),
                   in_box({0.02, 0.06, 0.03}, {0.1, 0.15, 0.1}, random), turned_axes(0.3, random),
                   false, false};
    });
  for (int k = 0; k < 2; ++k)
    blocks.pair([&] {
      const double radius = random.uniform(0.03, 0.05);
      return Block{in_box({-0.3, 0, 0.07}, {0.3, 0, 0.16}, random), Vector3(radius, radius, 1),
                   standing, true, true};
    });
  return std::make_unique<HardBody>(blocks.all);
}

// A sum of waves over x and y.
class Waves {
 public:
  Waves(double height, Random& random) {
    for (Wave& wave : waves_)
      wave = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(),
              random.uniform(0.5, 1) * height};
  }
  double operator()(double x, double y) const {
    double sum = 0;
    for (const Wave& wave : waves_)
      sum += wave.height * sine_of_turns(wave.x * x + wave.y * y + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    double x, y, phase, height;  // of x and y, turns a unit
  };
  Wave waves_[4];
};

// Two layers at a distance that varies from the mirror, over a rectangle; or one wavy sheet over a
// corner cut out of it.
class Sheets : public RandomBody {
 public:
  Sheets(bool symmetric, Random& random)
      : two_(symmetric),
        distance_(random.uniform(0.08, 0.14)),
        length_(random.uniform(0.35, 0.45)),
        width_(random.uniform(0.25, 0.35)),
        waves_(symmetric ? 0.2 * distance_ : 0.08, random) {
    for (Vector3& edge : edges_) {
      edge = random.direction();
      edge.z() = random.uniform(0.15, 0.3);
    }
  }

  Vector3 point(Random& random) const override {
    for (;;) {
      const double x = random.uniform(-length_, length_), y = random.uniform(-width_, width_);
      if (two_) return {x, y, (random.uniform() < 0.5 ? -1 : 1) * (distance_ + waves_(x, y))};
      bool within = true;
      for (const Vector3& edge : edges_) within &= edge.x() * x + edge.y() * y < edge.z();
      if (within) return {x, y, waves_(x, y)};
    }
  }

 private:
  bool two_;
  double distance_, length_, width_;
  Waves waves_;
  Vector3 edges_[3];
};

}  // namespace

std::unique_ptr<RandomBody> random_body(std::string_view shape, bool symmetric, Random& random) {
  if (shape == "creature") return creature(symmetric, random);
  if (shape == "head") return std::make_unique<SoftBody>(head(symmetric, random));
  if (shape == "part") return part(symmetric, random);
  if (shape == "mask") return std::make_unique<Mask>(symmetric, random);
  return std::make_unique<Sheets>(symmetric, random);
}

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
