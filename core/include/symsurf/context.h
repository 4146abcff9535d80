#pragma once

#include <symsurf/types.h>

#include <chrono>
#include <functional>
#include <limits>
#include <memory>

namespace symsurf {

/// Rows of the input from begin up to end, not included; all of them unless said otherwise.
struct Rows {
  Index begin = 0, end = std::numeric_limits<Index>::max();

  bool contains(Index row) const { return row >= begin && row < end; }
};

/// What a long call needs from its caller: where to report, when to stop, how many threads, whose
/// pairs.
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

  /// The same context for a caller that wants the pairs of these rows only. Processes that share
  /// out a point set find the same mirror each and the pairs of their own points.
  Context pairing(Rows rows) const;
  const Rows& paired_rows() const { return rows_; }

  /// The same context for a part of the work: its 0..1 is from..to here.
  Context stage(double from, double to) const;

 private:
  using Clock = std::chrono::steady_clock;

  Progress progress_;
  int threads_ = 1;
  double from_ = 0, to_ = 1;
  Rows rows_;
  std::shared_ptr<Clock::time_point> last_ = std::make_shared<Clock::time_point>();
};

}  // namespace symsurf
