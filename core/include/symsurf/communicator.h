#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace symsurf {

/// The processes that share out a point set. A host makes one from what its processes talk by. The
/// calls are collective: all processes make the same ones in the same order.
class Communicator {
 public:
  using Bytes = std::vector<std::byte>;

  virtual ~Communicator() = default;

  virtual int rank() const = 0;  ///< of this process, from 0
  virtual int size() const = 0;  ///< how many there are

  /// What every process gives, by rank; each gets all.
  virtual std::vector<Bytes> gather(std::span<const std::byte> mine) const = 0;

  /// Gives to another process and takes what that one gives.
  virtual Bytes swap(int other, std::span<const std::byte> mine) const = 0;
};

}  // namespace symsurf
