#include "parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace symsurf {

void parallel_for(const Context& context, Index count, Index grain,
                  const std::function<void(Index, Index)>& body) {
  const Index chunks = (count + grain - 1) / grain;
  std::atomic<Index> next{0};
  std::atomic<bool> stop{false};
  std::exception_ptr failure;
  std::mutex failure_mutex;

  const auto work = [&](bool reports) {
    try {
      for (Index chunk; !stop && (chunk = next++) < chunks;) {
        body(chunk * grain, std::min(count, (chunk + 1) * grain));
        if (reports && chunk + 1 < chunks)
          context.report(static_cast<double>(chunk + 1) / static_cast<double>(chunks));
      }
    } catch (...) {
      const std::scoped_lock lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };

  std::vector<std::thread> helpers;
  const Index threads = std::min<Index>(context.threads(), chunks);
  for (Index i = 1; i < threads; ++i) helpers.emplace_back(work, false);
  work(true);
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
  context.report(1);  // whichever thread had the last chunk
}

}  // namespace symsurf
