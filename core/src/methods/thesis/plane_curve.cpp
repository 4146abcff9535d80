#include "methods/thesis/plane_curve.h"

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "base/radix_sort.h"

namespace symsurf {

namespace {

constexpr int bits_per_axis = 16;

std::uint32_t cell(float x) {
  constexpr float half = static_cast<float>((1 << bits_per_axis) - 1) / 2;
  return static_cast<std::uint32_t>(std::clamp((x + 1) * half, 0.0f, 2 * half));
}

// Four levels of quadrants in one of four orientations: the curve's key, and the orientation below.
struct Turned {
  std::uint8_t key, state;
};

// By orientation, then four bits of u above four of v.
constexpr auto turned = [] {
  std::array<std::array<Turned, 256>, 4> table{};
  for (int state = 0; state < 4; ++state)
    for (int place = 0; place < 256; ++place) {
      int swapped = state & 1, flipped = state >> 1, key = 0;
      for (int level = 3; level >= 0; --level) {
        const int u = place >> (4 + level) & 1, v = place >> level & 1;
        const int x = (swapped ? v : u) ^ flipped, y = (swapped ? u : v) ^ flipped;
        key = key << 2 | ((3 * x) ^ y);
        if (y == 0) {
          flipped ^= x;
          swapped ^= 1;
        }
      }
      table[state][place] = {static_cast<std::uint8_t>(key),
                             static_cast<std::uint8_t>(flipped << 1 | swapped)};
    }
  return table;
}();

std::uint32_t key_of(std::uint32_t u, std::uint32_t v) {
  std::uint32_t key = 0;
  int state = 0;
  for (int shift = bits_per_axis - 4; shift >= 0; shift -= 4) {
    const Turned& next = turned[state][(u >> shift & 15) << 4 | (v >> shift & 15)];
    key = key << 8 | next.key;
    state = next.state;
  }
  return key;
}

}  // namespace

void PlaneCurve::sort(const PlanePlaces& places, const Context& context) {
  keys_.resize(places.size());
  order_.resize(places.size());
  interruptible_for(context, places.size(), [&](Index k) {
    keys_[k] = key_of(cell(places.u[k]), cell(places.v[k]));
    order_[k] = static_cast<std::int32_t>(k);
  });
  radix_sort(keys_, order_, context);
}

}  // namespace symsurf
