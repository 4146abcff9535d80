#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/points.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "pairing/matching.h"
#include "search/methods.h"

namespace symsurf {

// Point-to-point exchange of plain data between processes, after MPI.

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& items) {
  return std::as_bytes(std::span(items));
}

template <typename T>
std::vector<T> items_of(const Communicator::Bytes& bytes) {
  std::vector<T> items(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(static_cast<void*>(items.data()), bytes.data(), bytes.size());
  return items;
}

/// What every process has, by rank.
template <typename T>
std::vector<std::vector<T>> all_gather(const Communicator& processes, const std::vector<T>& own) {
  std::vector<std::vector<T>> all;
  for (const Communicator::Bytes& bytes : processes.all_gather(bytes_of(own)))
    all.push_back(items_of<T>(bytes));
  return all;
}

/// Sends items to another process and receives those that it sends.
template <typename T>
std::vector<T> send_recv(const Communicator& processes, int other, const std::vector<T>& items) {
  return items_of<T>(processes.send_recv(other, bytes_of(items)));
}

/// Calls exchange(other) for each other process, in rounds that pair all processes off.
template <typename Exchange>
void for_each_pair(const Communicator& processes, const Exchange& exchange) {
  const int size = processes.size(), rank = processes.rank();
  for (int round = 0; round < size; ++round) {
    const int other = (round - rank + size) % size;
    if (other != rank) exchange(other);
  }
}

/// Sends every process, this one too, item(process, k) for k below sent(process), and calls
/// take(process, k, item) for the received(process) items from each. In chunks, to bound memory.
template <typename T, typename Sent, typename Received, typename Item, typename Take>
void all_to_all(const Communicator& processes, const Sent& sent, const Received& received,
                const Item& item, const Take& take) {
  constexpr Index chunk = 1 << 14;
  const int rank = processes.rank();
  for (Index k = 0; k < sent(rank); ++k) take(rank, k, item(rank, k));
  for_each_pair(processes, [&](int other) {
    const Index given = sent(other), most = std::max<Index>(given, received(other));
    for (Index at = 0; at < most; at += chunk) {
      std::vector<T> mine;
      mine.reserve(std::clamp<Index>(given - at, 0, chunk));
      for (Index k = at; k < std::min(at + chunk, given); ++k) mine.push_back(item(other, k));
      const std::vector<T> theirs = send_recv(processes, other, mine);
      for (std::size_t k = 0; k < theirs.size(); ++k)
        take(other, at + static_cast<Index>(k), theirs[k]);
    }
  });
}

/// The part of a point set that one process holds, and sums over the parts of all. These are
/// collective, as in MPI, and take the parts in the order of the ranks: all get the same bits.
class Partition {
 public:
  /// Collective.
  Partition(Index own, const Communicator& processes);

  Index first() const { return first_; }  ///< number of points on the processes before this one
  Index total() const { return total_; }  ///< number of points on all processes
  const Communicator& processes() const { return processes_; }

  /// The first own point to take where every `stride`-th of all is taken.
  Index first_of_every(Index stride) const { return (stride - first_ % stride) % stride; }

  /// The sum over all processes (all-reduce).
  template <typename T>
  T sum(const T& own) const {
    T sum{};
    for (const std::vector<T>& part : all_gather(processes_, std::vector{own})) sum += part.front();
    return sum;
  }

  /// Throws on all processes the InvalidInput of the first on which `check` throws one.
  void require(const std::function<void()>& check) const;

 private:
  const Communicator& processes_;
  Index first_ = 0, total_ = 0;
};

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

/// A result but for its pairs and all that belongs to them, as bytes for other processes.
Communicator::Bytes serialize(const Result& result);

/// The result that serialize() was given: the same numbers, to the bit.
Result deserialize(std::span<const std::byte> bytes);

/// Runs on the points and normals of all processes, in the order of their ranks, on rank 0, the
/// root. Each process gets the result with the pairs of its own points, or the root's error.
/// Collective.
Result run_on_root(PointsView own, PointsView normals, const Communicator& processes,
                   const std::function<Result(PointsView, PointsView)>& run);

/// detect() of points that the processes of the context share out, of which these are this
/// process's. The faces are not seen. Collective.
Result detect_shared(PointsView own, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context);

/// Pairs the points of this process, of which the slabs were made, with those of all, numbered
/// through all processes, where an image is no farther than `limit` (input units) from its partner.
/// `tree`: of this process's slab. An image in or near another slab is sent to its process, so
/// memory grows with the own points only. Collective.
void add_pairs(Result& result, PointsView own, const Slabs& slabs, PointTree&& tree, double limit,
               const Context& context);

}  // namespace symsurf
