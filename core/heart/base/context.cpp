#include <symsurf/context.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "base/parallel.h"

namespace symsurf {

namespace {

using Clock = std::chrono::steady_clock;

// Front ends redraw on every report; more often than this nobody can see.
constexpr std::chrono::milliseconds report_interval{20};

int hardware_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

struct Context::Report {
  std::atomic<std::thread::id> caller;
  std::atomic<bool> cancelled = false;
  Clock::time_point time;  // this and the fraction are the calling thread's
  double fraction = 0;     // of the whole
};

Context::Context() : Context(nullptr) {}

Context::Context(Progress progress, int threads)
    : progress_(std::move(progress)),
      threads_(threads == 0 ? hardware_threads() : threads),
      last_(std::make_shared<Report>()) {
  if (threads < 0)
    throw InvalidParameter("threads is " + std::to_string(threads) +
                           "; allowed are 0 (all the machine has) and above");
  last_->caller = std::this_thread::get_id();
}

void Context::report(double fraction) const {
  if (runs_beside_others()) return check();
  const bool ends = fraction <= 0 || fraction >= 1;
  if (progress_ && (ends || is_due())) notify(from_ + fraction * (to_ - from_));
}

void Context::check() const {
  if (!progress_) return;
  if (last_->caller.load(std::memory_order_relaxed) == std::this_thread::get_id()) {
    if (is_due()) notify(last_->fraction);
  } else if (last_->cancelled.load(std::memory_order_relaxed)) {
    throw Cancelled();
  }
}

bool Context::is_due() const { return Clock::now() - last_->time >= report_interval; }

void Context::notify(double fraction) const {
  last_->caller = std::this_thread::get_id();
  last_->time = Clock::now();
  last_->fraction = fraction;
  try {
    last_->cancelled = !progress_(fraction);
  } catch (...) {
    last_->cancelled = true;
    throw;
  }
  if (last_->cancelled) throw Cancelled();
}

Context Context::sharing(const Communicator* processes) const {
  Context part = *this;
  part.communicator_ = processes && processes->size() > 1 ? processes : nullptr;
  return part;
}

Context Context::stage(double from, double to) const {
  Context part = *this;
  part.from_ = from_ + from * (to_ - from_);
  part.to_ = from_ + to * (to_ - from_);
  return part;
}

}  // namespace symsurf
