#pragma once

#include <symsurf/context.h>
#include <symsurf/types.h>

#include <cstdint>
#include <vector>

namespace symsurf {

/// Places in a plane, -1 to 1.
struct PlanePlaces {
  std::vector<float> u, v;

  Index size() const { return static_cast<Index>(u.size()); }
  void resize(Index count) {
    u.resize(count);
    v.resize(count);
  }
};

/// Sorts places in a plane along the Hilbert curve, which has no jumps; keeps its room from call to
/// call.
class PlaneCurve {
 public:
  void sort(const PlanePlaces& places, const Context& context);

  /// The place that is the k-th along the curve.
  std::int32_t operator[](Index k) const { return order_[k]; }

 private:
  std::vector<std::uint64_t> keys_;
  std::vector<std::int32_t> order_;
};

}  // namespace symsurf
