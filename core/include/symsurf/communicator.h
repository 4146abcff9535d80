#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace symsurf {

/// The processes that share a point set, and two calls of MPI. A host makes one from its message
/// passing. The calls are collective: all processes make the same ones in the same order.
class Communicator {
 public:
  using Bytes = std::vector<std::byte>;

  virtual ~Communicator() = default;

  virtual int rank() const = 0;  ///< of this process, from 0
  virtual int size() const = 0;  ///< number of processes

  /// What every process passes, by rank.
  virtual std::vector<Bytes> all_gather(std::span<const std::byte> own) const = 0;

  /// Sends bytes to another process and returns those that it sends.
  virtual Bytes send_recv(int other, std::span<const std::byte> bytes) const = 0;
};

}  // namespace symsurf
