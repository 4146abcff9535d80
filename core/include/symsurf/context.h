#pragma once

// What every long call takes from its caller, and how it fails.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace symsurf {

/// The points, the normals or the file cannot be used; the message says why and what is needed.
class InvalidInput : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// An unknown method or parameter, or a value out of its range; the message names both.
class InvalidParameter : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The caller's progress callback asked to stop.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled by the caller") {}
};

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

class Communicator;

/// What a long call needs from its caller: where to report, when to stop, how many threads, and the
/// other processes, if any.
class Context {
 public:
  /// Gets the fraction done in [0, 1], on the calling thread only; returning false cancels.
  using Progress = std::function<bool(double fraction)>;

  Context();
  /// threads: 0 means as many as the machine has. Throws InvalidParameter when negative.
  explicit Context(Progress progress, int threads = 0);

  int threads() const { return threads_; }

  /// Throws Cancelled when the caller wants to stop. Cheap enough for inner loops.
  void report(double fraction) const;

  /// The same where there is no news: long loops call it, so that nobody waits for the next report.
  /// On any thread; those that the calling thread has started stop with it. The calling thread is
  /// the one that made the context, or that reports.
  void check() const;

  /// The same context for a point set that processes share out; null, or one process: all of it is
  /// here. The communicator must outlive the context.
  Context sharing(const Communicator* processes) const;
  const Communicator* communicator() const { return communicator_; }

  /// The same context for a part of the work: its 0..1 is from..to here.
  Context stage(double from, double to) const;

 private:
  struct Report;

  bool is_due() const;
  void notify(double fraction) const;

  Progress progress_;
  int threads_ = 1;
  double from_ = 0, to_ = 1;
  const Communicator* communicator_ = nullptr;
  std::shared_ptr<Report> last_;
};

}  // namespace symsurf
