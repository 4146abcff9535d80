#include "methods/thesis/line_queries.h"

#include <Eigen/Geometry>

#include "methods/thesis/near_limits.h"

namespace symsurf {

namespace {

constexpr int block = LineQueries::block;
constexpr float infinity = std::numeric_limits<float>::infinity();

// Of the p-th of a run from the eight lines.
inline __attribute__((always_inline)) Floats squared_from(const BoxTree::Run& run, int p,
                                                          const LineQueries::Lines& lines) {
  Floats sum{};
  for (int k = 0; k < 2; ++k) {
    const Floats* axis = reinterpret_cast<const Floats*>(&lines.axis[k]);
    const Floats d = axis[0] * run.place[0][p] + axis[1] * run.place[1][p] +
                     axis[2] * run.place[2][p] - *reinterpret_cast<const Floats*>(&lines.at[k]);
    sum += d * d;
  }
  const auto counts = *reinterpret_cast<const Ints*>(&lines.left_out) != run.index[p];
  return counts ? sum : Floats{} + infinity;
}

SYMSURF_VECTORISED bool lower(const BoxTree::Run* run, const LineQueries::Lines* lines, float slack,
                              BlockQueries::Limits* limits) {
  Floats least = Floats{} + infinity;
  for (int p = 0; p < block; ++p) {
    const Floats squared = squared_from(*run, p, *lines);
    least = squared < least ? squared : least;
  }
  return lower_to(least, slack, *limits);
}

SYMSURF_VECTORISED void find_near(const BoxTree::Run* run, const LineQueries::Lines* lines,
                                  const BlockQueries::Limits* limits, BlockQueries::Bits* bits) {
  const Floats& limit = *reinterpret_cast<const Floats*>(limits);
  Ints found{};
  for (int p = 0; p < block; ++p) found |= (squared_from(*run, p, *lines) <= limit) & (1 << p);
  *reinterpret_cast<Ints*>(bits) = found;
}

// A box lies no nearer to a line than its shadow on two axes across the line.
SYMSURF_VECTORISED void bound_boxes(const BoxTree::Boxes* boxes, const LineQueries::Lines* lines,
                                    const BlockQueries::Limits* limits, float slack,
                                    BoxTree::Bounds* squared) {
  const Floats *low = reinterpret_cast<const Floats*>(&boxes->low),
               *high = reinterpret_cast<const Floats*>(&boxes->high);
  const Floats zero{};
  Floats centre[3], half[3];
  for (int axis = 0; axis < 3; ++axis) {
    centre[axis] = 0.5f * (high[axis] + low[axis]);
    half[axis] = 0.5f * (high[axis] - low[axis]);
  }
  Floats least = zero + infinity;
  for (int q = 0; q < block; ++q) {
    Floats sum = zero;
    for (int k = 0; k < 2; ++k) {
      const float x = lines->axis[k][0][q], y = lines->axis[k][1][q], z = lines->axis[k][2][q];
      const Floats gap = centre[0] * x + centre[1] * y + centre[2] * z - lines->at[k][q];
      const Floats reach = half[0] * std::abs(x) + half[1] * std::abs(y) + half[2] * std::abs(z);
      const Floats beyond = (gap > zero ? gap : -gap) - reach - slack;
      const Floats outside = beyond > zero ? beyond : zero;
      sum += outside * outside;
    }
    const Floats reached = sum <= (*limits)[q] ? sum : zero + infinity;
    least = reached < least ? reached : least;
  }
  *reinterpret_cast<Floats*>(squared) = least;
}

}  // namespace

void LineQueries::set(int which, const Vector3& x, const Vector3& unit, std::int32_t index) {
  const Vector3 e1 = unit.unitOrthogonal(), e2 = unit.cross(e1);
  const std::array<const Vector3*, 2> across{&e1, &e2};
  for (int k = 0; k < 2; ++k) {
    for (int axis = 0; axis < 3; ++axis)
      lines_.axis[k][axis][which] = static_cast<float>((*across[k])[axis]);
    lines_.at[k][which] = static_cast<float>(across[k]->dot(x));
  }
  lines_.left_out[which] = index;
}

void LineQueries::bound(const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) const {
  bound_boxes(&boxes, &lines_, &limits_, rounding_, &squared);
}

bool LineQueries::lower_limits(const BoxTree::Run& run) {
  return lower(&run, &lines_, 2 * rounding_, &limits_);
}

BlockQueries::Bits LineQueries::near(const BoxTree::Run& run) const {
  Bits bits;
  find_near(&run, &lines_, &limits_, &bits);
  return bits;
}

}  // namespace symsurf
