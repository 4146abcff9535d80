#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace symsurf {

namespace {

constexpr std::chrono::milliseconds patience{20};

thread_local bool is_beside_others = false;

// While a body runs.
class BesideOthers {
 public:
  explicit BesideOthers(bool is_so) : before_(std::exchange(is_beside_others, is_so)) {}
  ~BesideOthers() { is_beside_others = before_; }

 private:
  bool before_;
};

void run(const Context& context, Index count, Index grain,
         const std::function<void(Index, Index)>& body, bool is_silent) {
  const Index chunks = (count + grain - 1) / grain;
  std::atomic<Index> next{0};
  std::atomic<bool> stop{false};
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable ended;
  const bool is_nested = is_beside_others;
  const Index threads = is_nested ? 1 : std::min<Index>(context.threads(), chunks);
  Index at_work = threads - 1;  // beside the calling thread

  const auto or_failure = [&](const auto& part) {
    try {
      part();
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };
  const auto work = [&](bool is_caller) {
    for (Index chunk; !stop && (chunk = next++) < chunks;) {
      {
        const BesideOthers beside_others(is_nested || threads > 1);
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
      }
      if (!is_caller) continue;
      if (!is_silent && chunk + 1 < chunks)
        context.report(static_cast<double>(chunk + 1) / static_cast<double>(chunks));
      else
        context.check();
    }
  };
  const auto help = [&] {
    or_failure([&] { work(false); });
    const std::scoped_lock lock(mutex);
    if (--at_work == 0) ended.notify_one();
  };
  const auto wait = [&] {
    std::unique_lock lock(mutex);
    while (at_work > 0) {
      ended.wait_for(lock, patience);
      lock.unlock();
      context.check();
      lock.lock();
    }
  };

  std::vector<std::thread> helpers;
  helpers.reserve(threads);
  try {
    while (static_cast<Index>(helpers.size()) + 1 < threads) helpers.emplace_back(help);
  } catch (const std::exception&) {
    // The system gives no more: those that there are share the work.
    const std::scoped_lock lock(mutex);
    at_work -= threads - 1 - static_cast<Index>(helpers.size());
  }
  or_failure([&] {
    work(true);
    wait();
  });
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
  if (!is_silent) context.report(1);  // whichever thread had the last chunk
}

}  // namespace

bool runs_beside_others() { return is_beside_others; }

void parallel_for(const Context& context, Index count, Index grain,
                  const std::function<void(Index, Index)>& body) {
  run(context, count, grain, body, false);
}

void silent_parallel_for(const Context& context, Index count, Index grain,
                         const std::function<void(Index, Index)>& body) {
  run(context, count, grain, body, true);
}

}  // namespace symsurf
