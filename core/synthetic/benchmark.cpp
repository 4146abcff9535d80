#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/math.h"
#include "base/named_values.h"
#include "base/random.h"
#include "generators.h"

namespace symsurf {

namespace {

constexpr const char* shapes[]{"creature", "head", "part", "mask", "sheets"};
constexpr const char* bends[]{"straight", "bent", "domed", "waved", "twisted"};
constexpr const char* kinds_of_damage[]{"exact",   "clean", "noise-0.5", "noise-1",
                                        "noise-2", "hole",  "half",      "density"};

std::vector<BenchmarkCase> make_cases() {
  std::vector<BenchmarkCase> cases;
  for (const std::string shape : shapes)
    for (const std::string bend : bends) {
      const std::string body = shape + "-" + bend + "-";
      for (const std::string damage : kinds_of_damage)
        cases.push_back({body + damage, shape, bend, damage});
      cases.push_back({body + "asymmetry-1", shape, bend, "clean", 0.01});
      cases.push_back({body + "asymmetry-3", shape, bend, "clean", 0.03});
    }
  for (const std::string shape : shapes)
    for (const std::string damage : {"clean", "noise-1"})
      cases.push_back({shape + "-none-" + damage, shape, "none", damage});
  return cases;
}

// FNV-1a, so that every name has numbers of its own.
Random stream(std::uint64_t seed, const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
  Random mixed(hash ^ seed * 0x9e3779b97f4a7c15);
  return Random(mixed.bits());
}

struct Extent {
  Vector3 low = Vector3::Constant(infinity), high = -low;

  void add(const Vector3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  double diagonal() const { return (high - low).norm(); }
};

// A body whose mirror is the plane z = 0, of diagonal 1, and how that plane is bent.
class Shape {
 public:
  Shape(const BenchmarkCase& wanted, Random& random);

  Vector3 straight(Random& random) const {
    return asymmetry_->operator()((body_->point(random) - middle_) / size_);
  }
  const BenchmarkMirror& plane() const { return *plane_; }

 private:
  std::unique_ptr<RandomBody> body_;
  Vector3 middle_ = Vector3::Zero();
  double size_ = 1;
  std::unique_ptr<SmoothAsymmetry> asymmetry_;
  std::unique_ptr<BenchmarkMirror> plane_;
};

Shape::Shape(const BenchmarkCase& wanted, Random& random) {
  constexpr int measured = 2000;  // points: the same of any number that is asked for
  body_ = random_body(wanted.shape, wanted.bend != "none", random);
  std::vector<Vector3> points;
  Extent extent;
  for (int k = 0; k < measured; ++k) {
    points.push_back(body_->point(random));
    extent.add(points.back());
  }
  size_ = extent.diagonal();
  middle_ = (extent.low + extent.high) / 2;
  middle_.z() = 0;
  double reach = 0;
  for (Vector3& x : points) {
    x = (x - middle_) / size_;
    reach = std::max(reach, std::abs(x.z()));
  }
  plane_ = std::make_unique<BenchmarkMirror>(wanted.bend, reach + 2 * wanted.asymmetry, random);
  asymmetry_ = std::make_unique<SmoothAsymmetry>(wanted.asymmetry, points, random);
}

struct Pose {
  double scale;
  Matrix3 rotation;
  Vector3 translation;

  explicit Pose(Random& random) {
    scale = random.uniform(1, 10);
    for (Index tens = random.below(4); tens > 0; --tens) scale *= 10;
    const Vector3 x = random.direction();
    const Vector3 other = random.direction();
    const Vector3 z = (other - other.dot(x) * x).normalized();
    rotation.col(0) = x;
    rotation.col(1) = Vector3(z.y() * x.z() - z.z() * x.y(), z.z() * x.x() - z.x() * x.z(),
                              z.x() * x.y() - z.y() * x.x());
    rotation.col(2) = z;
    translation = 2 * scale * random.direction();
  }
  Vector3 operator()(const Vector3& x) const { return scale * (rotation * x) + translation; }
};

// Close to normal, of variance 1: Irwin and Hall's sum needs no logarithm.
double nearly_normal(Random& random) {
  double sum = -6;
  for (int k = 0; k < 12; ++k) sum += random.uniform();
  return sum;
}

template <typename Item>
void shuffle(std::vector<Item>& items, Random& random) {
  for (Index k = static_cast<Index>(items.size()) - 1; k > 0; --k)
    std::swap(items[k], items[random.below(k + 1)]);
}

// The first `count` of those that `order` puts first, in their old order.
std::vector<Index> first_by(const std::vector<double>& order, std::vector<Index> rows,
                            Index count) {
  std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return order[a] < order[b]; });
  rows.resize(count);
  std::sort(rows.begin(), rows.end());
  return rows;
}

// Points before and after the mirror was bent.
struct Drawn {
  std::vector<Vector3> straight, bent;

  Index size() const { return static_cast<Index>(straight.size()); }
  void keep(const std::vector<Index>& rows) {
    Drawn kept;
    for (const Index row : rows) {
      kept.straight.push_back(straight[row]);
      kept.bent.push_back(bent[row]);
    }
    *this = std::move(kept);
  }
};

Drawn drawn(const Shape& shape, Index count, Random& random) {
  Drawn points;
  for (Index k = 0; k < count; ++k) {
    points.straight.push_back(shape.straight(random));
    points.bent.push_back(shape.plane().bent(points.straight.back()));
  }
  return points;
}

std::vector<double> distances(const Drawn& points, const Vector3& from) {
  std::vector<double> squared;
  for (const Vector3& x : points.bent) squared.push_back((x - from).squaredNorm());
  return squared;
}

// A fifth is missing around a point.
void cut_hole(Drawn& points, Index count, Random& random) {
  std::vector<Index> rows(points.size());
  std::iota(rows.begin(), rows.end(), Index{0});
  std::vector<double> near = distances(points, points.bent[random.below(points.size())]);
  for (double& distance : near) distance = -distance;
  points.keep(first_by(near, rows, count));
}

// One side, and of the other the 30 % around one of its points.
void cut_half(Drawn& points, Random& random) {
  const double sign = random.uniform() < 0.5 ? -1 : 1;
  std::vector<Index> whole, other;
  for (Index k = 0; k < points.size(); ++k)
    (sign * points.straight[k].z() >= 0 ? whole : other).push_back(k);
  const Vector3 centre = points.bent[other[random.below(static_cast<Index>(other.size()))]];
  const auto left = static_cast<Index>(0.3 * static_cast<double>(other.size()));
  const std::vector<Index> piece = first_by(distances(points, centre), other, left);
  whole.insert(whole.end(), piece.begin(), piece.end());
  points.keep(whole);
}

// Along a direction the chance to stay falls to a quarter.
void thin_out(Drawn& points, Random& random) {
  const Vector3 way = random.direction();
  double low = infinity, high = -infinity;
  for (const Vector3& x : points.bent) {
    low = std::min(low, way.dot(x));
    high = std::max(high, way.dot(x));
  }
  std::vector<Index> kept;
  for (Index k = 0; k < points.size(); ++k)
    if (random.uniform() < 1 - 0.75 * (way.dot(points.bent[k]) - low) / (high - low))
      kept.push_back(k);
  points.keep(kept);
}

void add_noise(Drawn& points, double deviation, const BenchmarkMirror& plane, Random& random) {
  for (Index k = 0; k < points.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) points.bent[k][axis] += deviation * nearly_normal(random);
    points.straight[k] = plane.straightened(points.bent[k], points.straight[k]);
  }
}

double diagonal_of(const std::vector<Vector3>& points) {
  Extent extent;
  for (const Vector3& x : points) extent.add(x);
  return extent.diagonal();
}

}  // namespace

const std::vector<BenchmarkCase>& benchmark_cases() {
  static const std::vector<BenchmarkCase> cases = make_cases();
  return cases;
}

BenchmarkSample benchmark_sample(std::string_view name, Index count, std::uint64_t seed) {
  constexpr Index least = 100;
  const BenchmarkCase& wanted = find_named(benchmark_cases(), name, "case");
  if (count < least)
    throw InvalidParameter("count is " + std::to_string(count) + "; allowed is [" +
                           std::to_string(least) + ", inf)");
  Random body = stream(seed, wanted.shape + "-" + wanted.bend);
  const Shape shape(wanted, body);
  const Pose pose(body);
  const bool has_mirror = wanted.bend != "none";
  const std::string& damage = wanted.damage;
  Random random = stream(seed, wanted.name);

  BenchmarkSample sample;
  Drawn points = drawn(shape, damage == "exact" ? count / 2 : count, random);
  if (damage == "exact")
    for (Index k = 0, half = points.size(); k < half; ++k) {
      points.straight.push_back(over_mirror(points.straight[k]));
      points.bent.push_back(shape.plane().bent(points.straight.back()));
    }
  sample.diagonal = pose.scale * diagonal_of(points.bent);
  // More are drawn where damage takes some.
  const auto more = [&](double times) {
    const Drawn others =
        drawn(shape, static_cast<Index>((times - 1) * static_cast<double>(count)), random);
    points.straight.insert(points.straight.end(), others.straight.begin(), others.straight.end());
    points.bent.insert(points.bent.end(), others.bent.begin(), others.bent.end());
  };
  if (damage == "hole") {
    more(1.25);
    cut_hole(points, std::min(count, points.size()), random);
  } else if (damage == "half") {
    more(1.7);
    cut_half(points, random);
  } else if (damage == "density") {
    more(2.2);
    thin_out(points, random);
  } else if (damage.starts_with("noise-")) {
    const double share = damage == "noise-0.5" ? 0.005 : damage == "noise-1" ? 0.01 : 0.02;
    add_noise(points, share * sample.diagonal / pose.scale / std::sqrt(3), shape.plane(), random);
  }

  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  shuffle(order, random);
  order.resize(std::min<std::size_t>(order.size(), count));
  const auto rows = static_cast<Index>(order.size());
  sample.points.resize(rows, 3);
  sample.images.resize(has_mirror ? rows : 0, 3);
  sample.partners.assign(rows, -1);
  std::vector<Index> place(points.size(), -1);
  for (Index row = 0; row < rows; ++row) place[order[row]] = row;
  for (Index row = 0; row < rows; ++row) {
    const Index from = order[row];
    sample.points.row(row) = pose(points.bent[from]).transpose();
    if (!has_mirror) continue;
    const Vector3 image = shape.plane().bent(over_mirror(points.straight[from]));
    sample.images.row(row) = pose(image).transpose();
    const Index half = points.size() / 2;
    if (damage == "exact") sample.partners[row] = place[from < half ? from + half : from - half];
  }
  sample.kind = has_mirror ? shape.plane().kind() : "none";
  if (has_mirror) sample.mirror = shape.plane().mirror(pose.scale, pose.rotation, pose.translation);
  return sample;
}

}  // namespace symsurf
