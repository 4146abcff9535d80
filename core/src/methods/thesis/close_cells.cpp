#include "methods/thesis/close_cells.h"

#include <bit>

#include "base/parallel.h"

namespace symsurf {

CloseCells::CloseCells(PointsView points, double reach, const Context& context)
    : low_(points.matrix().colwise().minCoeff()), reach_(reach), cell_(4 * reach) {
  constexpr std::uint64_t bits_per_point = 32;
  const auto size = std::bit_ceil(
      std::max<std::uint64_t>(64, bits_per_point * static_cast<std::uint64_t>(points.size())));
  shift_ = 64 - std::countr_zero(size);
  bits_.assign(size / 64, 0);
  const Vector3 margin = Vector3::Constant(reach * (1 + 1e-6));
  interruptible_for(context, points.size(), [&](Index i) {
    const Cell from = cell_of(points[i] - margin), to = cell_of(points[i] + margin);
    Cell c;
    for (c.x() = from.x(); c.x() <= to.x(); ++c.x())
      for (c.y() = from.y(); c.y() <= to.y(); ++c.y())
        for (c.z() = from.z(); c.z() <= to.z(); ++c.z()) {
          const std::uint64_t bit = hash(c);
          bits_[bit / 64] |= std::uint64_t{1} << bit % 64;
        }
  });
}

}  // namespace symsurf
