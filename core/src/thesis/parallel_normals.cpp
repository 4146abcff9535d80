#include "parallel_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "../box_tree.h"
#include "../k_best.h"
#include "../parallel.h"
#include "../vectorised.h"

namespace symsurf {

namespace {

constexpr int fan = BoxTree::fan;
constexpr Index listed = 16;

using Run = std::array<double, 3 * fan>;

// Cosines above 1 are rounding: all these angles are 0.
SYMSURF_VECTORISED void cosines_with(const double* run, const double* normal, bool as_lines,
                                     double* __restrict cosine) {
  const double nx = normal[0], ny = normal[1], nz = normal[2];
  for (int i = 0; i < fan; ++i) {
    const double c = nx * run[i] + ny * run[fan + i] + nz * run[2 * fan + i];
    const double magnitude = c < 0 && as_lines ? -c : c;
    cosine[i] = magnitude < 1 ? magnitude : 1;
  }
}

// Of boxes from a point of the unit sphere, or from it and the point opposite.
SYMSURF_VECTORISED void bound_from_point(const BoxTree::Boxes* boxes, const float* at,
                                         bool as_lines, float slack, BoxTree::Bounds* squared) {
  const Floats *low = reinterpret_cast<const Floats*>(&boxes->low),
               *high = reinterpret_cast<const Floats*>(&boxes->high);
  const Floats zero{};
  Floats here = zero, opposite = zero;
  for (int axis = 0; axis < 3; ++axis) {
    const Floats l = low[axis] - slack, h = high[axis] + slack;
    const float q = at[axis];
    const Floats below = l - q, above = q - h, under = l + q, over = -q - h;
    Floats a = below > above ? below : above, b = under > over ? under : over;
    a = a > zero ? a : zero;
    b = b > zero ? b : zero;
    here += a * a;
    opposite += b * b;
  }
  if (as_lines) here = opposite < here ? opposite : here;
  *reinterpret_cast<Floats*>(squared) = here;
}

struct Parallel {
  double cosine;
  std::int32_t index;

  /// The smaller angle first, ties by index.
  bool operator<(const Parallel& other) const {
    return cosine != other.cosine ? cosine > other.cosine : index < other.index;
  }
};

/// Some of the normals, for searches among them.
class NormalSearch {
 public:
  template <typename Belongs>
  NormalSearch(PointsView normals, const std::vector<std::int32_t>& order, bool as_lines,
               const Context& context, const Belongs& belongs)
      : NormalSearch(normals, chosen(order, belongs), as_lines, context) {}

  /// The k most parallel, best first, without the point `itself`. `near` is a guess at the place
  /// of the best, and becomes it.
  void most_parallel(const Vector3& normal, std::size_t k, Index itself, Index& near,
                     std::vector<Parallel>& found) const {
    found.clear();
    double limit = std::numeric_limits<double>::infinity();
    std::array<double, fan> cosine;
    const auto scan = [&](Index begin, Index end) {
      cosines_with(runs_[begin / fan].data(), normal.data(), as_lines_, cosine.data());
      for (Index p = begin; p < end; ++p) {
        if (indices_[p] == itself) continue;
        if (!keep_best(found, k, Parallel{cosine[p - begin], indices_[p]})) continue;
        if (found.front().index == indices_[p]) near = p;
        if (found.size() == k) limit = 2 - 2 * found.back().cosine + 4e-15;
      }
    };
    const Index guess = near / fan * fan;
    scan(guess, std::min<Index>(guess + fan, static_cast<Index>(indices_.size())));

    const std::array<float, 3> at{static_cast<float>(normal[0]), static_cast<float>(normal[1]),
                                  static_cast<float>(normal[2])};
    const float slack = 2 * boxes_.slack();
    const auto bound = [&](const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) {
      bound_from_point(&boxes, at.data(), as_lines_, slack, &squared);
      // Among parallel normals only a lower index is better: flat patches cost no more.
      if (found.size() == k && found.back().cosine == 1)
        for (int i = 0; i < fan; ++i)
          if (boxes.first[i] > found.back().index)
            squared[i] = std::numeric_limits<float>::infinity();
    };
    boxes_.descend(bound, limit, [&](Index begin, Index end) {
      if (begin != guess) scan(begin, end);
    });
  }

 private:
  NormalSearch(PointsView normals, std::vector<std::int32_t> indices, bool as_lines,
               const Context& context)
      : as_lines_(as_lines),
        indices_(std::move(indices)),
        runs_((indices_.size() + fan - 1) / fan),
        boxes_(places(normals, indices_), indices_, context) {
    interruptible_for(context, static_cast<Index>(indices_.size()), [&](Index p) {
      for (int axis = 0; axis < 3; ++axis)
        runs_[p / fan][axis * fan + p % fan] = normals[indices_[p]][axis];
    });
  }

  template <typename Belongs>
  static std::vector<std::int32_t> chosen(const std::vector<std::int32_t>& order,
                                          const Belongs& belongs) {
    std::vector<std::int32_t> indices;
    std::copy_if(order.begin(), order.end(), std::back_inserter(indices), belongs);
    return indices;
  }
  static std::vector<Vector3> places(PointsView normals, const std::vector<std::int32_t>& indices) {
    std::vector<Vector3> found(indices.size());
    for (std::size_t p = 0; p < indices.size(); ++p) found[p] = normals[indices[p]];
    return found;
  }

  bool as_lines_;
  std::vector<std::int32_t> indices_;
  std::vector<Run> runs_;
  BoxTree boxes_;
};

std::vector<std::int32_t> curve_order(PointsView normals, const Context& context) {
  std::vector<Vector3> places(normals.size());
  for (Index i = 0; i < normals.size(); ++i) places[i] = normals[i];
  return z_order(places, context);
}

}  // namespace

ParallelNormals::ParallelNormals(PointsView points, PointsView normals, bool as_lines,
                                 const Context& context)
    : points_(points),
      normals_(normals),
      context_(context),
      as_lines_(as_lines),
      order_(curve_order(normals, context)),
      most_parallel_(order_.size() * listed, -1) {
  constexpr Index grain = 2048;
  const NormalSearch search(normals_, order_, as_lines_, context,
                            [](std::int32_t) { return true; });
  parallel_for(context, static_cast<Index>(order_.size()), grain, [&](Index begin, Index end) {
    std::vector<Parallel> found;
    Index near = begin;
    for (Index p = begin; p < end; ++p) {
      search.most_parallel(normals_[order_[p]], listed, order_[p], near, found);
      std::transform(found.begin(), found.end(), most_parallel_.begin() + p * listed,
                     [](const Parallel& parallel) { return parallel.index; });
    }
  });
}

double ParallelNormals::projection_error(const Separation& separation) const {
  std::vector<std::int32_t> partner(points_.size(), -1);
  for (std::size_t k = 0; k < separation.upper.size(); ++k)
    partner[separation.upper[k]] = separation.partner[k];

  const auto is_lower = [&](std::int32_t i) { return !separation.is_upper[i]; };
  const NormalSearch lower(normals_, order_, as_lines_, context_, is_lower);
  double sum = 0;
  std::vector<Parallel> found;
  Index near = 0;
  interruptible_for(context_, static_cast<Index>(order_.size()), [&](Index p) {
    const std::int32_t i = order_[p];
    if (partner[i] < 0) return;
    const auto begin = most_parallel_.begin() + p * listed;
    const auto q =
        std::find_if(begin, begin + listed, [&](std::int32_t j) { return j < 0 || is_lower(j); });
    const bool is_listed = q != begin + listed && *q >= 0;
    if (!is_listed) lower.most_parallel(normals_[i], 1, i, near, found);
    sum += (points_[partner[i]] - points_[is_listed ? *q : found.front().index]).squaredNorm();
  });
  return sum / static_cast<double>(separation.upper.size());
}

}  // namespace symsurf
