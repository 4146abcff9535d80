#pragma once

#include <symsurf/communicator.h>
#include <symsurf/method.h>

#include <cstdint>
#include <vector>

#include "base/gathered.h"

namespace symsurf {

/// A cloud that processes share out, handed round: each gets the points of one slab of space, about
/// as many as it had. Where slabs are cut across a mirror, points mostly have their partners in
/// their own slab. A process that is alone has all points in one slab, where they lie.
class Slabs {
 public:
  /// One after another along a unit vector, or against it. Collective.
  Slabs(const Cloud& cloud, const Vector3& along, const Context& context);

  Slabs(const Slabs&) = delete;
  Slabs& operator=(const Slabs&) = delete;

  /// Of this process's slab, in the order of their numbers.
  PointsView points() const { return points_; }

  /// Of a point of the slab, through all processes as they had them.
  Index number(Index i) const { return numbers_.empty() ? i : numbers_[i]; }

  /// No point of that process's slab is nearer to x.
  double distance(const Vector3& x, int process) const;

  /// Calls take(i, item(k)) for each point i that this process had, from where it is now, as point
  /// k of a slab. Collective, for processes that share out the cloud.
  template <typename T, typename Item, typename Take>
  void hand_back(const Communicator& processes, const Item& item, const Take& take) const;

 private:
  double height(const Vector3& x) const { return along_.dot(x - origin_); }
  Index given(int process) const { return static_cast<Index>(given_[process].size()); }
  Index taken(int process) const { return taken_[process + 1] - taken_[process]; }
  void cut(const Cloud& cloud, const Context& context);
  void hand_round(const Cloud& cloud, const Context& context);

  Vector3 along_, origin_;
  double rounding_;           // of a height
  std::vector<double> cuts_;  // the lower ends of all slabs but the first
  PointsView points_;
  Points moved_;
  std::vector<Index> numbers_;
  std::vector<std::vector<std::int32_t>> given_;  // the points this process had, by who has them
  std::vector<Index> taken_;  // where in the slab those that each process had begin; its end
};

template <typename T, typename Item, typename Take>
void Slabs::hand_back(const Communicator& processes, const Item& item, const Take& take) const {
  exchange<T>(
      processes, [&](int process) { return taken(process); },
      [&](int process) { return given(process); },
      [&](int process, Index k) { return item(taken_[process] + k); },
      [&](int process, Index k, const T& theirs) { take(given_[process][k], theirs); });
}

}  // namespace symsurf
