#include <symsurf/context.h>
#include <symsurf/errors.h>

#include <string>
#include <thread>

namespace symsurf {

namespace {

// Front ends redraw on every report; more often than this nobody can see.
constexpr std::chrono::milliseconds report_interval{20};

int hardware_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

Context::Context() : threads_(hardware_threads()) {}

Context::Context(Progress progress, int threads)
    : progress_(std::move(progress)), threads_(threads == 0 ? hardware_threads() : threads) {
  if (threads < 0)
    throw InvalidParameter("threads is " + std::to_string(threads) +
                           "; allowed are 0 (all the machine has) and above");
}

void Context::report(double fraction) const {
  if (!progress_) return;
  const auto now = Clock::now();
  const bool ends = fraction <= 0 || fraction >= 1;
  if (!ends && now - *last_ < report_interval) return;
  *last_ = now;
  if (!progress_(from_ + fraction * (to_ - from_))) throw Cancelled();
}

Context Context::pairing(Rows rows) const {
  Context part = *this;
  part.rows_ = rows;
  return part;
}

Context Context::stage(double from, double to) const {
  Context part = *this;
  part.from_ = from_ + from * (to_ - from_);
  part.to_ = from_ + to * (to_ - from_);
  return part;
}

}  // namespace symsurf
