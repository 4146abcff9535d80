#pragma once

#include <symsurf/types.h>

#include <functional>
#include <memory>

namespace symsurf {

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
