#include "symmetries/recurring/connected_lines.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace symsurf {

ConnectedLines::ConnectedLines(const FeatureLines& graph, const LineMatch& own)
    : graph_(graph), local_(graph.lines.size(), -1) {
  for (const auto& [line, image] : own.lines) {
    local_[line] = static_cast<std::int32_t>(lines_.size());
    lines_.push_back(line);
  }
}

LocalMatch ConnectedLines::local(const LineMatch& match) const {
  LocalMatch local{match.map, std::vector<std::int32_t>(size(), -1)};
  for (const auto& [line, image] : match.lines) {
    local.images[local_[line]] = static_cast<std::int32_t>(image);
    local.length += graph_.lines[line].length;
  }
  return local;
}

LocalMatch ConnectedLines::after(const LocalMatch& second, const LocalMatch& first) const {
  LocalMatch both{second.map * first.map, std::vector<std::int32_t>(size(), -1)};
  for (std::size_t line = 0; line < size(); ++line) {
    const std::int32_t image = first.images[line], own = image < 0 ? -1 : local_[image];
    if (own >= 0) both.images[line] = second.images[own];
  }
  return both;
}

template <typename Visit>
void ConnectedLines::for_each_next(std::int32_t local, const Visit& visit) const {
  for (const Index corner : {line(local).start, line(local).end})
    for (const Index next : graph_.at[corner])
      if (local_[next] >= 0) visit(local_[next]);
}

LocalLines ConnectedLines::common(const std::vector<const LocalMatch*>& matches) const {
  LocalLines found;
  std::vector<char> seen(size(), 0);
  const auto visit = [&](std::int32_t line) {
    if (seen[line]) return;
    seen[line] = 1;
    if (std::all_of(matches.begin(), matches.end(),
                    [&](const LocalMatch* match) { return match->images[line] >= 0; }))
      found.push_back(line);
  };
  visit(0);
  for (std::size_t k = 0; k < found.size(); ++k) for_each_next(found[k], visit);
  return found;
}

LocalLines ConnectedLines::disjoint(const std::vector<const LocalMatch*>& matches,
                                    std::int32_t start, const Vector3& point) const {
  using Step = std::pair<double, std::int32_t>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  std::vector<char> seen(size(), 0), claimed(graph_.lines.size(), 0);
  const auto visit = [&](std::int32_t line) {
    if (seen[line]) return;
    seen[line] = 1;
    steps.push({(middle(line) - point).norm(), line});
  };
  LocalLines part;
  visit(start);
  while (!steps.empty()) {
    const std::int32_t line = steps.top().second;
    steps.pop();
    std::size_t fresh = 0;
    for (const LocalMatch* match : matches) {
      const std::int32_t image = match->images[line];
      if (image < 0 || claimed[image]) break;
      claimed[image] = 1;
      ++fresh;
    }
    if (fresh < matches.size()) {
      for (std::size_t k = 0; k < fresh; ++k) claimed[matches[k]->images[line]] = 0;
      continue;
    }
    part.push_back(line);
    for_each_next(line, visit);
  }
  return part;
}

}  // namespace symsurf
