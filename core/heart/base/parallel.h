#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace symsurf {

/// Calls body(begin, end) on consecutive chunks of `grain` items. The chunks do not depend on the
/// number of threads, so neither do results made chunk by chunk. Reports and cancels through the
/// context, on the calling thread, after each of its chunks: a body that takes long calls
/// Context::check() as well. An exception of the body is rethrown here. Within a body that shares
/// the threads a further call runs where it is.
void parallel_for(const Context& context, Index count, Index grain,
                  const std::function<void(Index begin, Index end)>& body);

/// The same without reports, for short parts of what reports as a whole.
void silent_parallel_for(const Context& context, Index count, Index grain,
                         const std::function<void(Index begin, Index end)>& body);

/// Whether this thread runs a body beside others. Context::report() is check() then: of what is
/// done at the same time nothing can be told in turn.
bool runs_beside_others();

/// Calls body(i) for i of 0 up to count in turn, asking after every `stretch` whether to go on. On
/// any thread.
template <typename Body>
void interruptible_for(const Context& context, Index count, const Body& body,
                       Index stretch = 1 << 14) {
  for (Index begin = 0; begin < count; begin += stretch) {
    context.check();
    const Index end = begin + std::min(stretch, count - begin);
    for (Index i = begin; i < end; ++i) body(i);
  }
}

/// Joins body(begin, end) of all chunks in their order: the same bits for any number of threads.
template <typename T, typename Body>
T parallel_sum(const Context& context, Index count, Index grain, T zero, const Body& body) {
  std::vector<T> parts((count + grain - 1) / grain, zero);
  parallel_for(context, count, grain,
               [&](Index begin, Index end) { parts[begin / grain] = body(begin, end); });
  T sum = zero;
  for (const T& part : parts) sum += part;
  return sum;
}

}  // namespace symsurf
