#include "cloud/box_tree.h"

#include <bit>
#include <cmath>
#include <limits>

namespace symsurf {

namespace {

// Of coordinates of up to 1, and of what is computed from them: some roundings of single precision.
constexpr double rounding = 4e-7;

}  // namespace

// What the search of a packet reads and writes: plain numbers, as Eigen's alignment differs between
// the processors that it is compiled for.
struct BoxTree::Packet {
  const Node* nodes;
  const float* points;
  float error;  // of coordinates
  alignas(32) float x[lanes], y[lanes], z[lanes];
  alignas(32) float reach[lanes];      // squared; in the end that of the nearest point
  alignas(32) float runner_up[lanes];  // squared distance of the next one, or more
  alignas(32) std::int32_t nearest[lanes];

  struct Anywhere;
  struct Avx2;
};

#if defined(__GNUC__)
#define SYMSURF_WIDE 4
struct BoxTree::Packet::Anywhere {
#include "cloud/packet_search.inl"
};
#undef SYMSURF_WIDE
#if defined(__x86_64__) && !defined(__clang__)
#define SYMSURF_WIDE 8
#pragma GCC push_options
#pragma GCC target("avx2")
struct BoxTree::Packet::Avx2 {
#include "cloud/packet_search.inl"
};
#pragma GCC pop_options
#undef SYMSURF_WIDE
#endif
#endif

BoxTree::BoxTree(std::vector<Vector3> points, const std::vector<std::uint64_t>& keys,
                 const Context& context)
    : points_(std::move(points)) {
  constexpr std::size_t usual_leaf = 12;  // points, at least in the mean
  double extent = 0;
  for (const Vector3& x : points_) extent = std::max(extent, x.cwiseAbs().maxCoeff());
  if (extent > 0) unit_ = std::ldexp(1.0, -std::ilogb(extent) - 1);
  flat_.reserve(3 * points_.size());
  for (const Vector3& x : points_)
    for (int axis = 0; axis < 3; ++axis) flat_.push_back(static_cast<float>(x[axis] * unit_));
  nodes_.reserve(2 * points_.size() / usual_leaf + 1);
  add(0, static_cast<std::uint32_t>(points_.size()), keys, context);
}

std::uint32_t BoxTree::add(std::uint32_t begin, std::uint32_t end,
                           const std::vector<std::uint64_t>& keys, const Context& context) {
  constexpr std::uint32_t leaf = 24;
  constexpr std::uint32_t looked_after = 1 << 16;  // points between two looks at the clock
  constexpr float farthest = std::numeric_limits<float>::infinity();
  if (end - begin > looked_after) context.check();
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, none, 0});
  Node node{{farthest, farthest, farthest}, {-farthest, -farthest, -farthest}, begin, end};
  const auto extend = [&](const float* low, const float* high) {
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::min(node.low[axis], low[axis]);
      node.high[axis] = std::max(node.high[axis], high[axis]);
    }
  };
  if (end - begin <= leaf) {
    for (std::uint32_t i = begin; i < end; ++i) {
      const float* x = &flat_[3 * std::size_t{i}];
      extend(x, x);
    }
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] = std::nextafter(node.low[axis], -farthest);
      node.high[axis] = std::nextafter(node.high[axis], farthest);
    }
  } else {
    // Split at the highest bit in which the first and the last key differ.
    const std::uint64_t first = keys[begin], last = keys[end - 1];
    std::uint32_t middle = begin + (end - begin) / 2;
    if (first != last) {
      const int bit = 63 - std::countl_zero(first ^ last);
      const auto from = keys.begin() + begin;
      middle = static_cast<std::uint32_t>(
          std::lower_bound(from, keys.begin() + end, (last >> bit) << bit) - keys.begin());
    }
    add(begin, middle, keys, context);
    node.begin = none;
    node.end = add(middle, end, keys, context);
    for (const std::uint32_t child : {number + 1, node.end})
      extend(nodes_[child].low, nodes_[child].high);
  }
  nodes_[number] = node;
  return number;
}

std::array<std::int32_t, BoxTree::lanes> BoxTree::nearest(const Vector3* queries, int count,
                                                          double limit) const {
  std::array<std::int32_t, lanes> found;
  found.fill(-2);
#if defined(__GNUC__)
  constexpr double farthest = 1e15;  // units, whose square is a number in single precision
  double greatest = 1;
  for (int i = 0; i < count; ++i)
    greatest = std::max(greatest, queries[i].cwiseAbs().maxCoeff() * unit_);
  if (!(greatest < farthest)) return found;
  const double error = rounding * greatest;
  const auto widened = [&](double squared) {
    const double reach = std::sqrt(squared) * unit_ + error;
    return static_cast<float>(std::min(reach * reach * (1 + 1e-5), 1e37));
  };
  Packet packet;
  packet.nodes = nodes_.data();
  packet.points = flat_.data();
  packet.error = static_cast<float>(error);
  for (int i = 0; i < lanes; ++i) {
    const Vector3 q = unit_ * queries[std::min(i, count - 1)];
    packet.x[i] = static_cast<float>(q.x());
    packet.y[i] = static_cast<float>(q.y());
    packet.z[i] = static_cast<float>(q.z());
    packet.reach[i] = widened(limit);
  }
#if defined(__x86_64__) && !defined(__clang__)
  static const auto search =
      __builtin_cpu_supports("avx2") ? &Packet::Avx2::search_all : &Packet::Anywhere::search_all;
  search(packet);
#else
  Packet::Anywhere::search_all(packet);
#endif
  for (int i = 0; i < count; ++i) {
    found[i] = packet.nearest[i];
    if (found[i] < 0) continue;
    const double squared = (points_[found[i]] - queries[i]).squaredNorm();
    if (packet.runner_up[i] <= widened(squared))
      found[i] = -2;
    else if (!(squared <= limit))
      found[i] = -1;
  }
#endif
  return found;
}

}  // namespace symsurf
