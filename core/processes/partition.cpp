#include "partition.h"

#include <symsurf/context.h>

#include <string>
#include <vector>

namespace symsurf {

Partition::Partition(Index own, const Communicator& processes) : processes_(processes) {
  const auto counts = all_gather(processes, std::vector{own});
  for (int rank = 0; rank < processes.size(); ++rank) {
    if (rank < processes.rank()) first_ += counts[rank].front();
    total_ += counts[rank].front();
  }
}

void Partition::require(const std::function<void()>& check) const {
  std::string message;
  try {
    check();
  } catch (const InvalidInput& error) {
    message = error.what();
  }
  for (const std::vector<char>& text :
       all_gather(processes_, std::vector(message.begin(), message.end())))
    if (!text.empty()) throw InvalidInput(std::string(text.begin(), text.end()));
}

}  // namespace symsurf
