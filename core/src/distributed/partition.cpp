#include "distributed/partition.h"

#include <symsurf/context.h>

#include <numeric>
#include <string>

namespace symsurf {

Partition::Partition(Index own, const Communicator* processes)
    : processes_(processes), total_(own) {
  if (!processes) return;
  const std::vector<Index> counts = concatenate(std::vector<Index>{own});
  const auto mine = counts.begin() + processes->rank();
  first_ = std::accumulate(counts.begin(), mine, Index{0});
  total_ = std::accumulate(mine, counts.end(), first_);
}

void Partition::require(const std::function<void()>& check) const {
  if (!processes_) return check();
  std::string message;
  try {
    check();
  } catch (const InvalidInput& error) {
    message = error.what();
  }
  for (const std::vector<char>& text : gather(std::vector<char>(message.begin(), message.end())))
    if (!text.empty()) throw InvalidInput(std::string(text.begin(), text.end()));
}

}  // namespace symsurf
