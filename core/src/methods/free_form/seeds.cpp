#include "methods/free_form/seeds.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/parallel.h"

namespace symsurf::perpendicular {

namespace {

constexpr Index first_ends = 500;
constexpr std::size_t most_tested = 2500;
const double parallel_enough = std::cos(30 * M_PI / 180);
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

}  // namespace symsurf::perpendicular
