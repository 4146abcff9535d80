#include "methods/thesis/place_queries.h"

#include "methods/thesis/near_limits.h"

namespace symsurf {

namespace {

constexpr int block = PlaceQueries::block;
constexpr float infinity = std::numeric_limits<float>::infinity();

const Floats* floats(const BoxTree::Coordinates& x) { return reinterpret_cast<const Floats*>(&x); }

// Of the p-th of a run from eight places.
template <int axes>
inline __attribute__((always_inline)) Floats squared_from(const BoxTree::Run& run, int p,
                                                          const Floats* places) {
  Floats sum{};
  for (int axis = 0; axis < axes; ++axis) {
    const Floats d = places[axis] - run.place[axis][p];
    sum += d * d;
  }
  return sum;
}

template <int axes>
inline __attribute__((always_inline)) Floats least_of(const BoxTree::Run& run,
                                                      const Floats* places) {
  Floats least = Floats{} + infinity;
  for (int p = 0; p < block; ++p) {
    const Floats squared = squared_from<axes>(run, p, places);
    least = squared < least ? squared : least;
  }
  return least;
}

// Of eight boxes, each from the nearest place that looks so far.
template <int axes>
inline __attribute__((always_inline)) Floats bounds_of(const BoxTree::Boxes& boxes,
                                                       const BoxTree::Coordinates& places,
                                                       const PlaceQueries::Limits& limits) {
  const Floats *low = floats(boxes.low), *high = floats(boxes.high);
  const Floats zero{};
  Floats least = zero + infinity;
  for (int q = 0; q < block; ++q) {
    Floats sum = zero;
    for (int axis = 0; axis < axes; ++axis) {
      const float x = places[axis][q];
      const Floats below = low[axis] - x, above = x - high[axis];
      const Floats outside = below > above ? below : above;
      const Floats gap = outside > zero ? outside : zero;
      sum += gap * gap;
    }
    const Floats reached = sum <= limits[q] ? sum : zero + infinity;
    least = reached < least ? reached : least;
  }
  return least;
}

SYMSURF_VECTORISED void bound_boxes(const BoxTree::Boxes* boxes, const BoxTree::Coordinates* places,
                                    const PlaceQueries::Limits* limits, int axes,
                                    BoxTree::Bounds* squared) {
  *reinterpret_cast<Floats*>(squared) =
      axes == 2 ? bounds_of<2>(*boxes, *places, *limits) : bounds_of<3>(*boxes, *places, *limits);
}

SYMSURF_VECTORISED bool lower(const BoxTree::Run* run, const BoxTree::Coordinates* places,
                              float slack, int axes, PlaceQueries::Limits* limits) {
  const Floats* at = floats(*places);
  return lower_to(axes == 2 ? least_of<2>(*run, at) : least_of<3>(*run, at), slack, *limits);
}

SYMSURF_VECTORISED void find_near(const BoxTree::Run* run, const BoxTree::Coordinates* places,
                                  const PlaceQueries::Limits* limits, int axes,
                                  std::array<std::int32_t, block>* bits) {
  const Floats& limit = *reinterpret_cast<const Floats*>(limits);
  Ints found{};
  for (int p = 0; p < block; ++p) {
    const Floats squared = axes == 2 ? squared_from<2>(*run, p, floats(*places))
                                     : squared_from<3>(*run, p, floats(*places));
    found |= (squared <= limit) & (1 << p);
  }
  *reinterpret_cast<Ints*>(bits) = found;
}

}  // namespace

void PlaceQueries::begin(const Places& places, const Limits& squared) {
  BlockQueries::begin(squared);
  places_ = places;
}

void PlaceQueries::turn_round() {
  for (auto& x : places_)
    for (float& value : x) value = -value;
}

bool PlaceQueries::lower_limits(const BoxTree::Run& run) {
  return lower(&run, &places_, slack_, axes_, &limits_);
}

void PlaceQueries::bound(const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) const {
  bound_boxes(&boxes, &places_, &limits_, axes_, &squared);
}

PlaceQueries::Bits PlaceQueries::near(const BoxTree::Run& run) const {
  Bits bits;
  find_near(&run, &places_, &limits_, axes_, &bits);
  return bits;
}

}  // namespace symsurf
