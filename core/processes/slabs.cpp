#include <symsurf/context.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "processes.h"

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

Slabs::Slabs(PointsView own, const Partition& partition, const Vector3& along,
             const Vector3& centre, double diagonal, const Context& context)
    : partition_(partition), along_(along), centre_(centre), rounding_(1e-12 * diagonal) {
  cut(own);
  redistribute(own, context);
}

double Slabs::distance(const Vector3& x, int process) const {
  const double at = height(x);
  const std::size_t slab = static_cast<std::size_t>(process);
  const double below = slab > 0 ? cuts_[slab - 1] - at : 0;
  const double above = slab < cuts_.size() ? at - cuts_[slab] : 0;
  return std::max(0.0, std::max(below, above) - rounding_);
}

// At quantiles of a sample, so that each process keeps about as many points as it had. Slabs ascend
// with the ranks, or descend where that moves fewer points.
void Slabs::cut(PointsView own) {
  constexpr Index sample_size = 8192;
  const Index stride = std::max<Index>(1, partition_.total() / sample_size);
  std::vector<double> heights;
  for (Index i = partition_.first_of_every(stride); i < own.size(); i += stride)
    if (own[i].allFinite()) heights.push_back(height(own[i]));
  const auto sampled = all_gather(partition_.processes(), heights);
  heights.clear();
  double rising = 0;
  for (std::size_t process = 0; process < sampled.size(); ++process) {
    const std::vector<double>& part = sampled[process];
    rising += static_cast<double>(process) * std::accumulate(part.begin(), part.end(), 0.0);
    heights.insert(heights.end(), part.begin(), part.end());
  }
  if (rising < 0) {
    along_ = -along_;
    for (double& height : heights) height = -height;
  }
  std::sort(heights.begin(), heights.end());
  std::size_t before = 0;
  for (std::size_t process = 0; process + 1 < sampled.size(); ++process) {
    before += sampled[process].size();
    cuts_.push_back(heights[std::min(before, heights.size() - 1)]);
  }
}

void Slabs::redistribute(PointsView own, const Context& context) {
  const Communicator& processes = partition_.processes();
  sent_.resize(processes.size());
  interruptible_for(context, own.size(), [&](Index i) {
    const auto slab = std::upper_bound(cuts_.begin(), cuts_.end(), height(own[i]));
    sent_[slab - cuts_.begin()].push_back(static_cast<std::int32_t>(i));
  });

  std::vector<Index> counts;
  for (int process = 0; process < processes.size(); ++process) counts.push_back(sent(process));
  received_ = {0};
  for (const std::vector<Index>& theirs : all_gather(partition_.processes(), counts))
    received_.push_back(received_.back() + theirs[processes.rank()]);
  moved_.resize(received_.back(), 3);
  numbers_.resize(received_.back());

  struct Moved {
    Vector3 point;
    Index number;
  };
  all_to_all<Moved>(
      processes, [&](int process) { return sent(process); },
      [&](int process) { return received(process); },
      [&](int process, Index k) {
        const std::int32_t i = sent_[process][k];
        return Moved{own[i], partition_.first() + i};
      },
      [&](int process, Index k, const Moved& moved) {
        moved_.row(received_[process] + k) = moved.point.transpose();
        numbers_[received_[process] + k] = moved.number;
      });
}

}  // namespace symsurf
