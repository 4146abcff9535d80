#include "spatial/slabs.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"

namespace symsurf {

Slabs::Slabs(const Cloud& cloud, const Vector3& along, const Context& context)
    : along_(along),
      origin_(cloud.frame.centroid),
      rounding_(1e-12 * cloud.diagonal),
      points_(cloud.points) {
  if (!context.communicator()) return;
  cut(cloud, context);
  hand_round(cloud, context);
}

double Slabs::distance(const Vector3& x, int process) const {
  const double at = height(x);
  const std::size_t slab = static_cast<std::size_t>(process);
  const double below = slab > 0 ? cuts_[slab - 1] - at : 0;
  const double above = slab < cuts_.size() ? at - cuts_[slab] : 0;
  return std::max(0.0, std::max(below, above) - rounding_);
}

// By a sample of the points, as even over them as over the processes. Upwards as the ranks, or
// downwards where so fewer points change hands.
void Slabs::cut(const Cloud& cloud, const Context& context) {
  constexpr Index sample_size = 8192;
  const Index step = std::max<Index>(1, cloud.total / sample_size);
  std::vector<double> heights;
  for (Index i = first_of_every(step, cloud.first); i < cloud.points.size(); i += step)
    heights.push_back(height(cloud.points[i]));
  const auto sampled = gathered(context, heights);
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

void Slabs::hand_round(const Cloud& cloud, const Context& context) {
  const Communicator& processes = *context.communicator();
  given_.resize(processes.size());
  interruptible_for(context, cloud.points.size(), [&](Index i) {
    const auto slab = std::upper_bound(cuts_.begin(), cuts_.end(), height(cloud.points[i]));
    given_[slab - cuts_.begin()].push_back(static_cast<std::int32_t>(i));
  });

  std::vector<Index> counts;
  for (int process = 0; process < processes.size(); ++process) counts.push_back(given(process));
  taken_ = {0};
  for (const std::vector<Index>& theirs : gathered(context, counts))
    taken_.push_back(taken_.back() + theirs[processes.rank()]);
  moved_.resize(taken_.back(), 3);
  numbers_.resize(taken_.back());
  points_ = PointsView(moved_);

  struct Moved {
    Vector3 point;
    Index number;
  };
  exchange<Moved>(
      processes, [&](int process) { return given(process); },
      [&](int process) { return taken(process); },
      [&](int process, Index k) {
        const std::int32_t i = given_[process][k];
        return Moved{cloud.points[i], cloud.first + i};
      },
      [&](int process, Index k, const Moved& moved) {
        moved_.row(taken_[process] + k) = moved.point.transpose();
        numbers_[taken_[process] + k] = moved.number;
      });
}

}  // namespace symsurf
