#include "methods/thesis/most_parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/k_best.h"

namespace symsurf {

namespace {

// More than the rounding of any distance between places on the unit sphere.
constexpr float rounding = 5e-7f;

// The square of how far to look on the unit sphere for a greater cosine.
float limit_of(double cosine) {
  const float reach = static_cast<float>(std::sqrt(2 - 2 * cosine + 4e-15)) + rounding;
  return reach * reach;
}

struct Parallel {
  double cosine;
  std::int32_t index;

  /// The smaller angle first, ties by index.
  bool operator<(const Parallel& other) const {
    return cosine != other.cosine ? cosine > other.cosine : index < other.index;
  }
};

}  // namespace

double cosine_between(const Vector3& a, const Vector3& b, bool as_lines) {
  constexpr double rounding = 1e-15;
  const double c = as_lines ? std::abs(a.dot(b)) : a.dot(b);
  return c > 1 - rounding ? 1 : c;
}

MostParallel::MostParallel(PointsView normals, bool as_lines)
    : normals_(normals), as_lines_(as_lines), queries_(rounding, 3) {}

void MostParallel::add(std::int32_t index) {
  const Eigen::Vector3f place = normals_[index].cast<float>();
  tree_.add(place.x(), place.y(), place.z(), index);
}

void MostParallel::build(const Context& context) {
  tree_.build(context);
  best_.fill(tree_.runs().front().index.front());
}

std::int32_t MostParallel::guess() const {
  return std::max(static_cast<std::int32_t>(tree_.runs().size()) - 1, 0);
}

void MostParallel::find(const std::array<std::int32_t, block>& indices, std::int32_t guess) {
  std::array<Vector3, block> normal;
  PlaceQueries::Places places;
  PlaceQueries::Limits limits;
  for (int q = 0; q < block; ++q) {
    normal[q] = normals_[indices[q]];
    for (int axis = 0; axis < 3; ++axis) places[axis][q] = static_cast<float>(normal[q][axis]);
    // The last answers are good ones to begin with: consecutive queries lie close together.
    cosine_[q] = cosine_between(normal[q], normals_[best_[q]], as_lines_);
    limits[q] = limit_of(cosine_[q]);
  }
  queries_.begin(places, limits);
  queries_.lower_limits(tree_.runs()[guess]);
  const auto consider = [&](int q, std::int32_t index) {
    const double c = cosine_between(normal[q], normals_[index], as_lines_);
    if (c < cosine_[q] || (c == cosine_[q] && index > best_[q])) return;
    best_[q] = index;
    cosine_[q] = c;
  };
  // Among parallel normals only a lower index is better.
  const auto last = [&] {
    const bool all_parallel =
        std::all_of(cosine_.begin(), cosine_.end(), [](double c) { return c == 1; });
    return all_parallel ? *std::max_element(best_.begin(), best_.end()) : any_index();
  };
  visit_nearest(tree_, queries_, consider, last);
  if (!as_lines_) return;
  queries_.turn_round();
  visit_nearest(tree_, queries_, consider, last);
}

void MostParallel::list(std::int32_t index, std::size_t count,
                        std::vector<std::int32_t>& indices) const {
  const Vector3 normal = normals_[index];
  PlaceQueries::Places places;
  for (int axis = 0; axis < 3; ++axis) places[axis].fill(static_cast<float>(normal[axis]));
  PlaceQueries queries(rounding, 3);
  queries.begin(places, BlockQueries::anywhere());
  std::vector<Parallel> found;
  const auto is_known = [&](std::int32_t i) {
    return std::any_of(found.begin(), found.end(), [&](const Parallel& p) { return p.index == i; });
  };
  float limit = std::numeric_limits<float>::infinity();
  const auto consider = [&](std::int32_t i) {
    const Parallel parallel{cosine_between(normal, normals_[i], as_lines_), i};
    if (found.size() == count && !(parallel < found.back())) return;
    if (i == index || is_known(i)) return;
    keep_best(found, count, parallel);
    if (found.size() == count) limit = limit_of(found.back().cosine);
  };
  for (const std::int32_t i : indices) consider(i);
  const auto search = [&] {
    tree_.descend(
        [&](const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) {
          queries.bound(boxes, squared);
          if (found.size() < count || found.back().cosine < 1) return;
          for (Index i = 0; i < block; ++i)
            if (boxes.first[i] > found.back().index)
              squared[i] = std::numeric_limits<float>::infinity();
        },
        limit,
        [&](const BoxTree::Run& run) {
          for (const std::int32_t i : run.index) consider(i);
        });
  };
  search();
  if (as_lines_) {
    queries.turn_round();
    search();
  }
  indices.clear();
  for (const Parallel& parallel : found) indices.push_back(parallel.index);
}

}  // namespace symsurf
