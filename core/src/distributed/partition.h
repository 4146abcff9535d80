#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "distributed/collectives.h"

namespace symsurf {

/// The part of a point set that one process holds, and reductions over the parts of all.
/// In one process the part is the whole, and a reduction returns its argument. Reductions are
/// collective, as in MPI, and take the parts in the order of the ranks: all get the same bits.
class Partition {
 public:
  Partition() = default;
  /// Null for a single process. Collective.
  explicit Partition(Index own, const Communicator* processes = nullptr);

  /// The partition of another point set over the same processes. Collective.
  Partition resized(Index own) const { return Partition(own, processes_); }

  Index first() const { return first_; }  ///< number of points on the processes before this one
  Index total() const { return total_; }  ///< number of points on all processes

  /// The first own point to take where every `stride`-th of all is taken.
  Index first_of_every(Index stride) const { return (stride - first_ % stride) % stride; }

  /// What every process has (all-gather).
  template <typename T>
  std::vector<std::vector<T>> gather(const std::vector<T>& own) const {
    if (!processes_) return {own};
    return all_gather(*processes_, own);
  }

  /// The same in one vector (flat all-gather).
  template <typename T>
  std::vector<T> concatenate(const std::vector<T>& own) const {
    std::vector<T> all;
    for (const std::vector<T>& part : gather(own)) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  /// What merge(parts) makes of the parts of all (all-reduce).
  template <typename T, typename Merge>
  std::vector<T> reduce(std::vector<T> own, const Merge& merge) const {
    return processes_ ? merge(gather(own)) : std::move(own);
  }

  /// The sum over all processes (all-reduce).
  template <typename T>
  T sum(const T& own) const {
    if (!processes_) return own;
    const std::vector<T> all = concatenate(std::vector<T>{own});
    T sum = all.front();
    for (std::size_t i = 1; i < all.size(); ++i) sum += all[i];
    return sum;
  }

  /// The same element by element.
  template <typename T>
  Eigen::ArrayX<T> sum(const Eigen::ArrayX<T>& own) const {
    if (!processes_) return own;
    Eigen::ArrayX<T> sum = Eigen::ArrayX<T>::Zero(own.size());
    for (const std::vector<T>& part : gather(std::vector<T>(own.begin(), own.end())))
      sum += Eigen::Map<const Eigen::ArrayX<T>>(part.data(), own.size());
    return sum;
  }

  /// Throws on all processes the InvalidInput of the first on which `check` throws one.
  void require(const std::function<void()>& check) const;

  /// Of the distributed algorithms: null in one process.
  const Communicator* processes() const { return processes_; }

 private:
  const Communicator* processes_ = nullptr;
  Index first_ = 0, total_ = 0;
};

}  // namespace symsurf
