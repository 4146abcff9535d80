#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <cstdint>
#include <vector>

#include "partition.h"

namespace symsurf {

/// A point set redistributed over its processes by space: one slab each, of about as many points.
/// Slabs across a mirror hold most points with their partners.
class Slabs {
 public:
  /// Along a unit vector or against it, whichever moves fewer points. `centre` and `diagonal`: of
  /// all points. Collective.
  Slabs(PointsView own, const Partition& partition, const Vector3& along, const Vector3& centre,
        double diagonal, const Context& context);

  Slabs(const Slabs&) = delete;
  Slabs& operator=(const Slabs&) = delete;

  /// Of this process's slab, in the order of their numbers.
  PointsView points() const { return moved_; }

  /// The index of a point of the slab among those of all processes before redistribution.
  Index number(Index i) const { return numbers_[i]; }

  /// A lower bound of the distance from x to the points of that process's slab.
  double distance(const Vector3& x, int process) const;

  const Partition& partition() const { return partition_; }

  /// Sends item(k) of each point k of the slab to the process that had it, as its point i, and
  /// calls take(i, item) there. Collective.
  template <typename T, typename Item, typename Take>
  void send_back(const Item& item, const Take& take) const;

 private:
  double height(const Vector3& x) const { return along_.dot(x - centre_); }
  Index sent(int process) const { return static_cast<Index>(sent_[process].size()); }
  Index received(int process) const { return received_[process + 1] - received_[process]; }
  void cut(PointsView own);
  void redistribute(PointsView own, const Context& context);

  Partition partition_;
  Vector3 along_, centre_;
  double rounding_;           // of a height
  std::vector<double> cuts_;  // the lower ends of all slabs but the first
  Points moved_;
  std::vector<Index> numbers_;
  std::vector<std::vector<std::int32_t>> sent_;  // the points this process had, by their new one
  std::vector<Index> received_;  // where in the slab the points from each process begin; its end
};

template <typename T, typename Item, typename Take>
void Slabs::send_back(const Item& item, const Take& take) const {
  all_to_all<T>(
      partition_.processes(), [&](int process) { return received(process); },
      [&](int process) { return sent(process); },
      [&](int process, Index k) { return item(received_[process] + k); },
      [&](int process, Index k, const T& theirs) { take(sent_[process][k], theirs); });
}

}  // namespace symsurf
