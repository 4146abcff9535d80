#pragma once

#include <symsurf/communicator.h>
#include <symsurf/context.h>
#include <symsurf/types.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

namespace symsurf {

// Plain data to and from the other processes; without a communicator this process is all there are.

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
std::vector<std::vector<T>> gathered(const Context& context, const std::vector<T>& own) {
  if (!context.communicator()) return {own};
  std::vector<std::vector<T>> all;
  for (const Communicator::Bytes& bytes : context.communicator()->gather(bytes_of(own)))
    all.push_back(items_of<T>(bytes));
  return all;
}

/// All of it, in the order of the ranks.
template <typename T>
std::vector<T> concatenated(const Context& context, const std::vector<T>& own) {
  std::vector<T> all;
  for (const std::vector<T>& part : gathered(context, own))
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The sum in the order of the ranks: the same bits everywhere.
template <typename T>
T summed(const Context& context, const T& own) {
  if (!context.communicator()) return own;
  const std::vector<T> all = concatenated(context, std::vector<T>{own});
  T sum = all.front();
  for (std::size_t i = 1; i < all.size(); ++i) sum += all[i];
  return sum;
}

/// The same, element by element.
template <typename T>
Eigen::ArrayX<T> summed(const Context& context, const Eigen::ArrayX<T>& own) {
  if (!context.communicator()) return own;
  Eigen::ArrayX<T> sum = Eigen::ArrayX<T>::Zero(own.size());
  for (const std::vector<T>& part : gathered(context, std::vector<T>(own.begin(), own.end())))
    sum += Eigen::Map<const Eigen::ArrayX<T>>(part.data(), own.size());
  return sum;
}

/// Calls meet(other) for each other process, the processes paired off: whoever is mine, I am his.
template <typename Meet>
void meet_each(const Communicator& processes, const Meet& meet) {
  const int size = processes.size(), rank = processes.rank();
  for (int round = 0; round < size; ++round) {
    const int other = (round - rank + size) % size;
    if (other != rank) meet(other);
  }
}

/// Gives item(k) for k of 0 up to `given` to another process, and calls take(k, item) for as many
/// as `taken` that it gives: a chunk at a time, so that memory does not grow with them.
template <typename T, typename Item, typename Take>
void swap_items(const Communicator& processes, int other, Index given, Index taken,
                const Item& item, const Take& take) {
  constexpr Index chunk = 1 << 14;
  for (Index at = 0; at < std::max(given, taken); at += chunk) {
    std::vector<T> mine;
    mine.reserve(std::clamp<Index>(given - at, 0, chunk));
    for (Index k = at; k < std::min(at + chunk, given); ++k) mine.push_back(item(k));
    const std::vector<T> theirs = items_of<T>(processes.swap(other, bytes_of(mine)));
    for (std::size_t k = 0; k < theirs.size(); ++k) take(at + static_cast<Index>(k), theirs[k]);
  }
}

/// Gives every process item(process, k) for k of 0 up to given(process), and calls take(process, k,
/// item) for as many as taken(process) that it gives. This one is among them.
template <typename T, typename Given, typename Taken, typename Item, typename Take>
void exchange(const Communicator& processes, const Given& given, const Taken& taken,
              const Item& item, const Take& take) {
  const int rank = processes.rank();
  for (Index k = 0; k < given(rank); ++k) take(rank, k, item(rank, k));
  meet_each(processes, [&](int other) {
    swap_items<T>(
        processes, other, given(other), taken(other), [&](Index k) { return item(other, k); },
        [&](Index k, const T& theirs) { take(other, k, theirs); });
  });
}

/// How many points the processes before this one have, and how many all have.
struct Share {
  Index first = 0, total = 0;
};

inline Share share_of(const Context& context, Index own) {
  if (!context.communicator()) return {0, own};
  const std::vector<Index> counts = concatenated(context, std::vector<Index>{own});
  const auto mine = counts.begin() + context.communicator()->rank();
  return {std::accumulate(counts.begin(), mine, Index{0}),
          std::accumulate(counts.begin(), counts.end(), Index{0})};
}

/// The first of a process's points to take where every `step`-th of all is taken.
inline Index first_of_every(Index step, Index before) { return (step - before % step) % step; }

}  // namespace symsurf
