#include "strips.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "../parallel.h"
#include "../vectorised.h"

namespace symsurf {

namespace {

constexpr double crowd = 4;  // places in a square as high as a strip
constexpr int cells = 1 << 16;

}  // namespace

void Strips::sort(const Places& places, const std::vector<std::int32_t>& names,
                  const Context& context) {
  const Index size = places.size();
  const auto [least_u, most_u] = std::minmax_element(places.u.begin(), places.u.end());
  const auto [least_v, most_v] = std::minmax_element(places.v.begin(), places.v.end());
  count_ = std::max<Index>(1, static_cast<Index>(std::sqrt(static_cast<double>(size) / crowd)));
  low_v_ = *least_v;
  height_ = (*most_v - low_v_) / static_cast<float>(count_);
  const float low_u = *least_u, width = (*most_u - low_u) / cells;
  margin_ = width + place_rounding;

  // First by u, then by strip, which keeps the order of u.
  cells_.resize(size);
  start_.assign(cells, 0);
  begin_.assign(count_ + 1, 0);
  interruptible_for(context, size, [&](Index k) {
    const float cell = width > 0 ? (places.u[k] - low_u) / width : 0;
    cells_[k] = static_cast<std::int32_t>(std::min(cell, static_cast<float>(cells - 1)));
    ++start_[cells_[k]];
    ++begin_[strip(places.v[k]) + 1];
  });
  std::exclusive_scan(start_.begin(), start_.end(), start_.begin(), 0);
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  by_cell_.resize(size);
  interruptible_for(context, size,
                    [&](Index k) { by_cell_[start_[cells_[k]]++] = static_cast<std::int32_t>(k); });
  names_.resize(size);
  sorted_.resize(size + lanes);
  cursor_.assign(begin_.begin(), begin_.end() - 1);
  interruptible_for(context, size, [&](Index c) {
    const std::int32_t k = by_cell_[c], at = cursor_[strip(places.v[k])]++;
    names_[at] = names[k];
    sorted_.u[at] = places.u[k];
    sorted_.v[at] = places.v[k];
  });
  std::fill(sorted_.u.begin() + size, sorted_.u.end(), std::numeric_limits<float>::infinity());
  cursor_.assign(begin_.begin(), begin_.end() - 1);
}

Index Strips::strip(float v) const {
  if (!(height_ > 0)) return 0;
  return static_cast<Index>(
      std::clamp((v - low_v_) / height_, 0.0f, static_cast<float>(count_ - 1)));
}

std::int32_t Strips::run_before(Index strip, float least) {
  const std::int32_t begin = begin_[strip], end = begin_[strip + 1];
  std::int32_t& at = cursor_[strip];
  while (at + lanes < end && sorted_.u[at + lanes] < least) at += lanes;
  while (at > begin && sorted_.u[at] >= least) at = std::max(begin, at - lanes);
  return at;
}

SYMSURF_VECTORISED std::int32_t Strips::first_near(const Places* sorted, std::int32_t at,
                                                   std::int32_t end, float u, float v, float limit,
                                                   float most) {
  const float *us = sorted->u.data(), *vs = sorted->v.data();
  for (; at < end && us[at] <= most; at += lanes) {
    const Floats du = *reinterpret_cast<const Floats*>(us + at) - u,
                 dv = *reinterpret_cast<const Floats*>(vs + at) - v;
    const auto is_near = du * du + dv * dv <= limit;
    const auto* words = reinterpret_cast<const std::uint64_t*>(&is_near);
    if (words[0] | words[1] | words[2] | words[3]) return at;
  }
  return end;
}

}  // namespace symsurf
