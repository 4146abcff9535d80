#include <algorithm>
#include <optional>

#include "base/math.h"
#include "symmetries/recurring/recurring_part.h"

namespace symsurf {

namespace {

// Of the greater one's radius: how far from its centre another part may lie.
constexpr double nearby = 1.5;

// Of what two parts save: so much their union must save. Panes go into a window, but windows not
// into the two halves of a wall.
constexpr double most_of_saved = 0.9;

// The same in whichever direction the line is followed.
Vector3 middle_of(const FeatureLine& line) {
  const int first = line.has_ends() ? 1 : 0;
  Vector3 sum = Vector3::Zero();
  for (int step = first; step < FeatureLine::steps; ++step) sum += line.samples[step];
  return sum / (FeatureLine::steps - first);
}

Vector3 centre_of(const std::vector<Index>& lines, const FeatureLines& graph) {
  Vector3 sum = Vector3::Zero();
  double length = 0;
  for (const Index line : lines) {
    sum += graph.lines[line].length * middle_of(graph.lines[line]);
    length += graph.lines[line].length;
  }
  return sum / length;
}

double radius_of(const std::vector<Index>& lines, const FeatureLines& graph) {
  const Vector3 centre = centre_of(lines, graph);
  double greatest = 0;
  for (const Index line : lines)
    for (const Vector3& x : graph.lines[line].samples)
      greatest = std::max(greatest, (x - centre).norm());
  return greatest;
}

// The lines in an order in which the map takes the others to them.
std::optional<std::vector<Index>> images(const Eigen::Isometry3d& map,
                                         const std::vector<Index>& lines,
                                         const std::vector<Index>& among, const FeatureLines& graph,
                                         double tolerance) {
  std::vector<Index> found;
  std::vector<char> used(among.size(), 0);
  for (const Index line : lines) {
    const FeatureLine& own = graph.lines[line];
    const Vector3 middle = map * middle_of(own);
    std::size_t nearest = among.size();
    double least = 2 * tolerance;
    for (std::size_t k = 0; k < among.size(); ++k) {
      const FeatureLine& other = graph.lines[among[k]];
      const double distance = (middle_of(other) - middle).norm();
      if (used[k] || std::abs(other.length - own.length) > 2 * tolerance || distance >= least)
        continue;
      least = distance;
      nearest = k;
    }
    if (nearest == among.size()) return {};
    used[nearest] = 1;
    found.push_back(among[nearest]);
  }
  return found;
}

// Whether so many instances of the other part belong to each of this one's, which takes them in.
bool takes_in(RecurringPart& part, const RecurringPart& other, const FeatureLines& graph,
              double tolerance) {
  const auto count = static_cast<double>(part.instances.size()),
             others = static_cast<double>(other.instances.size());
  const double together = (count - 1) * (part.length + others / count * other.length);
  if (other.instances.size() % part.instances.size() != 0 ||
      together < most_of_saved * (part.saved() + other.saved()))
    return false;
  std::vector<Vector3> centres;
  for (const RecurringPart::Instance& instance : part.instances)
    centres.push_back(centre_of(instance.lines, graph));
  const double reach =
      nearby * std::max(radius_of(part.lines, graph), radius_of(other.lines, graph));
  std::vector<std::vector<Index>> groups(centres.size());
  for (const RecurringPart::Instance& instance : other.instances) {
    const Vector3 centre = centre_of(instance.lines, graph);
    const auto nearest =
        std::min_element(centres.begin(), centres.end(), [&](const Vector3& a, const Vector3& b) {
          return (a - centre).squaredNorm() < (b - centre).squaredNorm();
        });
    if ((*nearest - centre).norm() > reach) return false;
    std::vector<Index>& group = groups[nearest - centres.begin()];
    group.insert(group.end(), instance.lines.begin(), instance.lines.end());
  }
  std::vector<std::vector<Index>> ordered;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    if (groups[k].size() != groups[0].size()) return false;
    auto own = images(part.instances[k].map, groups[0], groups[k], graph, tolerance);
    if (!own) return false;
    ordered.push_back(std::move(*own));
  }
  for (std::size_t k = 0; k < ordered.size(); ++k)
    part.instances[k].lines.insert(part.instances[k].lines.end(), ordered[k].begin(),
                                   ordered[k].end());
  part.lines = part.instances[0].lines;
  part.length = 0;
  for (const Index line : part.lines) part.length += graph.lines[line].length;
  return true;
}

}  // namespace

std::vector<RecurringPart> united(std::vector<RecurringPart> parts, const FeatureLines& graph,
                                  double tolerance) {
  // Fewer instances take in more, greater ones lesser.
  std::stable_sort(parts.begin(), parts.end(), [](const RecurringPart& a, const RecurringPart& b) {
    if (a.instances.size() != b.instances.size()) return a.instances.size() < b.instances.size();
    return a.length > b.length;
  });
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (std::size_t other = k + 1; other < parts.size();) {
      if (takes_in(parts[k], parts[other], graph, tolerance)) {
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(other));
        other = k + 1;
      } else {
        ++other;
      }
    }
  return parts;
}

}  // namespace symsurf
