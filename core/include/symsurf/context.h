#pragma once

#include <chrono>
#include <functional>
#include <memory>

namespace symsurf {

/// What a long call needs from its caller: where to report, when to stop, how many threads.
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

  /// The same context for a part of the work: its 0..1 is from..to here.
  Context stage(double from, double to) const;

 private:
  using Clock = std::chrono::steady_clock;

  Progress progress_;
  int threads_ = 1;
  double from_ = 0, to_ = 1;
  std::shared_ptr<Clock::time_point> last_ = std::make_shared<Clock::time_point>();
};

}  // namespace symsurf
