#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "recurring/recurring_parts.h"

namespace symsurf {

namespace {

// Lines that one is compared with, and what all comparisons may cost: a pair of lines that few are
// connected with costs 1, of those that many are more. To walk over so few lines costs as much.
constexpr std::size_t most_alike = 20000, most_cost = 40000, many = 100, few = 25;

class PartSearch {
 public:
  PartSearch(const FeatureLines& graph, double tolerance)
      : graph_(graph),
        tolerance_(tolerance),
        taken_(graph.lines.size(), 0),
        tried_(graph.lines.size(), 0),
        matching_(graph, tolerance, taken_) {
    for (std::size_t k = 0; k < graph.lines.size(); ++k) {
      const FeatureLine& line = graph.lines[k];
      if (line.start != line.end) by_length_.push_back(static_cast<Index>(k));
    }
    std::stable_sort(by_length_.begin(), by_length_.end(), [&](Index a, Index b) {
      return graph.lines[a].length < graph.lines[b].length;
    });
    count_connected();
    // What is long and recurs often begins.
    std::vector<double> potential(graph.lines.size(), 0);
    for (const Index line : by_length_)
      potential[line] = graph.lines[line].length * static_cast<double>(as_long(line).size());
    seeds_ = by_length_;
    constexpr double rounding = 1e-6;
    std::stable_sort(seeds_.begin(), seeds_.end(), [&](Index a, Index b) {
      return std::round(potential[a] / rounding / tolerance) >
             std::round(potential[b] / rounding / tolerance);
    });
  }

  std::vector<RecurringPart> run(Index count, const Context& context) {
    std::vector<RecurringPart> parts;
    while (static_cast<Index>(parts.size()) < count) {
      seed(context);
      const auto best = best_part(candidates_);
      if (best == candidates_.end()) break;
      parts.push_back(*best);
      if (graph_.noise > 0) complete(parts.back(), context);
      for (const RecurringPart::Instance& instance : parts.back().instances)
        for (const Index line : instance.lines) taken_[line] = 1;
      drop_taken();
    }
    return parts;
  }

 private:
  // Those of by_length_ that are about as long as this one.
  std::span<const Index> as_long(Index line) const {
    const double length = graph_.lines[line].length;
    const auto length_of = [&](Index other) { return graph_.lines[other].length; };
    const auto from = std::ranges::lower_bound(by_length_, length - 2 * tolerance_, {}, length_of),
               to = std::ranges::upper_bound(by_length_, length + 2 * tolerance_, {}, length_of);
    return {from, to};
  }

  // Lines that may be images of this one.
  std::vector<Index> alike(Index line) const {
    std::vector<Index> found;
    for (const Index other : as_long(line))
      if (found.size() < most_alike && !taken_[other] &&
          graph_.lines[other].wings.size() == graph_.lines[line].wings.size())
        found.push_back(other);
    return found;
  }

  // Of each line how many are connected with it.
  void count_connected() {
    connected_.assign(graph_.lines.size(), 0);
    for (const Index seed : by_length_) {
      if (connected_[seed] > 0) continue;
      std::vector<Index> all{seed};
      connected_[seed] = 1;
      for (std::size_t k = 0; k < all.size(); ++k)
        for (const Index corner : {graph_.lines[all[k]].start, graph_.lines[all[k]].end})
          for (const Index next : graph_.at[corner])
            if (connected_[next] == 0) {
              connected_[next] = 1;
              all.push_back(next);
            }
      for (const Index line : all) connected_[line] = all.size();
    }
  }

  // Begins with each line that is in no candidate yet.
  void seed(const Context& context) {
    for (const Index line : seeds_) {
      if (taken_[line] || tried_[line]) continue;
      context.check();
      tried_[line] = 1;
      const std::vector<Index> others = alike(line);
      const std::size_t around = std::min(connected_[line], many);
      const std::size_t cost = others.size() * (1 + around / few) + connected_[line] / few;
      if (others.size() < 2 || cost_ + cost > most_cost) continue;
      cost_ += cost;
      RecurringPart part = seed_part(line, others, graph_, matching_, context);
      if (part.instances.empty()) continue;
      mark(part, 1);
      candidates_.push_back(std::move(part));
    }
  }

  // Instances that lack lines for their noise: the part's lines are taken to any that are left.
  void complete(RecurringPart& part, const Context& context) {
    std::vector<char> is_own(graph_.lines.size(), 0), claimed(graph_.lines.size(), 0);
    for (const RecurringPart::Instance& instance : part.instances)
      for (const Index line : instance.lines) claimed[line] = 1;
    for (const Index line : part.lines) is_own[line] = 1;
    for (const Index line : part.lines)
      for (const Index other : alike(line))
        for (const LineMatching::Pose pose : LineMatching::poses) {
          if (claimed[other]) break;
          context.check();
          const auto match = matching_.grown(line, other, pose);
          if (!match) continue;
          RecurringPart::Instance instance{match->map, {}};
          double length = 0;
          for (const auto& [from, onto] : match->lines)
            if (is_own[from] && !claimed[onto]) {
              instance.lines.push_back(onto);
              length += graph_.lines[from].length;
            }
          if (length < least_share * part.length) continue;
          for (const Index image : instance.lines) claimed[image] = 1;
          part.instances.push_back(std::move(instance));
        }
  }

  void mark(const RecurringPart& part, char tried) {
    for (const RecurringPart::Instance& instance : part.instances)
      for (const Index line : instance.lines) tried_[line] = tried;
  }

  // Candidates that have lost lines go; what they had may begin again.
  void drop_taken() {
    const auto has_lost = [&](const RecurringPart& part) {
      return std::any_of(part.instances.begin(), part.instances.end(),
                         [&](const RecurringPart::Instance& instance) {
                           return std::any_of(instance.lines.begin(), instance.lines.end(),
                                              [&](Index line) { return taken_[line]; });
                         });
    };
    const auto lost =
        std::stable_partition(candidates_.begin(), candidates_.end(),
                              [&](const RecurringPart& part) { return !has_lost(part); });
    for (auto part = lost; part != candidates_.end(); ++part) mark(*part, 0);
    candidates_.erase(lost, candidates_.end());
    for (const RecurringPart& part : candidates_) mark(part, 1);
  }

  const FeatureLines& graph_;
  double tolerance_;
  std::vector<char> taken_, tried_;
  LineMatching matching_;
  std::vector<Index> by_length_, seeds_;
  std::vector<RecurringPart> candidates_;
  std::vector<std::size_t> connected_;
  std::size_t cost_ = 0;
};

}  // namespace

std::vector<RecurringPart> part_search(const FeatureLines& graph, double tolerance, Index count,
                                       const Context& context) {
  std::vector<RecurringPart> parts = PartSearch(graph, tolerance).run(count, context);
  for (RecurringPart& part : closed_line_parts(graph, tolerance, context))
    parts.push_back(std::move(part));
  parts = united(std::move(parts), graph, tolerance);
  std::stable_sort(parts.begin(), parts.end(), [](const RecurringPart& a, const RecurringPart& b) {
    return a.saved() > b.saved();
  });
  if (static_cast<Index>(parts.size()) > count) parts.resize(static_cast<std::size_t>(count));
  return parts;
}

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
  // Noise leaves fragments of what is in a part.
  const bool is_fragment = graph.noise > 0 && other.length < part.length;
  if (!is_fragment && (other.instances.size() % part.instances.size() != 0 ||
                       together < most_of_saved * (part.saved() + other.saved())))
    return false;
  std::vector<Vector3> centres;
  for (const RecurringPart::Instance& instance : part.instances)
    centres.push_back(centre_of(instance.lines, graph));
  const double own_radius = radius_of(part.lines, graph),
               reach = nearby * std::max(own_radius, radius_of(other.lines, graph));
  std::vector<std::vector<Index>> groups(centres.size());
  for (const RecurringPart::Instance& instance : other.instances) {
    const Vector3 centre = centre_of(instance.lines, graph);
    const auto nearest =
        std::min_element(centres.begin(), centres.end(), [&](const Vector3& a, const Vector3& b) {
          return (a - centre).squaredNorm() < (b - centre).squaredNorm();
        });
    if ((*nearest - centre).norm() > (is_fragment ? own_radius : reach)) return false;
    std::vector<Index>& group = groups[nearest - centres.begin()];
    group.insert(group.end(), instance.lines.begin(), instance.lines.end());
  }
  if (is_fragment) {
    for (std::size_t k = 0; k < groups.size(); ++k)
      part.instances[k].lines.insert(part.instances[k].lines.end(), groups[k].begin(),
                                     groups[k].end());
    return true;
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
  // Fewer instances take in more, greater ones lesser, which may be fragments where there is noise.
  std::stable_sort(parts.begin(), parts.end(), [&](const RecurringPart& a, const RecurringPart& b) {
    if (graph.noise == 0 && a.instances.size() != b.instances.size())
      return a.instances.size() < b.instances.size();
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

namespace {

// Of the length of a line: how far beside it the surface is compared.
constexpr double beside = 0.1;

// The smallest of the boxes around the lines of a part that lie along one of them and a face
// beside it, or along the principal axes.
class PartBox {
 public:
  PartBox(const std::vector<Index>& lines, const FeatureLines& graph, double margin) {
    std::vector<Vector3> points;
    for (const Index line : lines) {
      const FeatureLine& own = graph.lines[line];
      points.insert(points.end(), own.samples.begin(), own.samples.end());
      if (own.has_ends()) points.push_back(graph.corners[own.end]);
    }
    Points rows = rows_of(points);
    const Eigen::RowVector3d centre = rows.colwise().mean();
    rows.rowwise() -= centre;
    double least = infinity;
    const auto try_axes = [&](const Matrix3& axes) {
      Eigen::AlignedBox3d box;
      for (const Vector3& x : points) box.extend(axes.transpose() * x);
      box.min().array() -= margin;
      box.max().array() += margin;
      constexpr double less = 1 - 1e-6;
      if (box.volume() >= less * least) return;
      least = box.volume();
      axes_ = axes;
      box_ = box;
    };
    try_axes(eigen_of_scatter(rows).vectors);
    constexpr std::size_t most = 50;
    for (std::size_t k = 0; k < std::min(lines.size(), most); ++k) {
      const FeatureLine& own = graph.lines[lines[k]];
      if (!own.has_ends() || own.start == own.end) continue;
      Matrix3 axes;
      axes.col(0) = (graph.corners[own.end] - graph.corners[own.start]).normalized();
      axes.col(2) = axes.col(0).cross(own.wings.front()).normalized();
      axes.col(1) = axes.col(2).cross(axes.col(0));
      if (axes.isUnitary(1e-6)) try_axes(axes);
    }
  }

  bool holds(const Vector3& x) const { return box_.contains(Vector3(axes_.transpose() * x)); }

 private:
  Matrix3 axes_;
  Eigen::AlignedBox3d box_;
};

// Points of the surface on the lines and close beside them, where it goes on so far.
std::vector<Vector3> about(const std::vector<Index>& lines, const FeatureLines& graph,
                           const SquaredDistance& to_surface, double tolerance) {
  constexpr double on_it = 0.1;  // of the tolerance
  std::vector<Vector3> points;
  for (const Index line : lines) {
    const FeatureLine& own = graph.lines[line];
    points.insert(points.end(), own.samples.begin(), own.samples.end());
    for (const Vector3& wing : own.wings) {
      const Vector3 x = own.middle() + beside * own.length * wing;
      if (to_surface(x) <= on_it * tolerance * on_it * tolerance) points.push_back(x);
    }
  }
  return points;
}

// How well each instance of a part fits the surface: see PartPoints.
std::vector<double> scores_of(const RecurringPart& part, const FeatureLines& graph,
                              const SquaredDistance& to_surface, double tolerance) {
  const std::vector<Vector3> surface = about(part.lines, graph, to_surface, tolerance);
  const double limit = 4 * tolerance * tolerance;
  std::vector<double> scores;
  for (const RecurringPart::Instance& instance : part.instances) {
    double sum = 0;
    for (const Vector3& x : surface) {
      const double squared = to_surface(instance.map * x);
      if (squared < limit) sum += biweight(std::sqrt(squared / limit));
    }
    scores.push_back(sum / static_cast<double>(surface.size()));
  }
  return scores;
}

// Calls visit(part, instance, line) for the lines of all instances, in their order.
template <typename Visit>
void for_each_line(const std::vector<RecurringPart>& parts, const FeatureLines& graph,
                   const Visit& visit) {
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (std::size_t i = 0; i < parts[p].instances.size(); ++i)
      for (const Index line : parts[p].instances[i].lines)
        visit(static_cast<Index>(p), static_cast<Index>(i), graph.lines[line]);
}

// The points on the lines of instances belong to them, a shared corner to the first.
void assign_lines(const std::vector<RecurringPart>& parts, const FeatureLines& graph,
                  PartPoints& found) {
  for_each_line(parts, graph, [&](Index part, Index instance, const FeatureLine& line) {
    for (const Index point : line.points) {
      if (found.part[point] >= 0) continue;
      found.part[point] = part;
      found.instance[point] = instance;
    }
  });
}

// Any other point belongs to the instance with the nearest line, within the box of that one.
void assign_surface(PointsView points, const std::vector<RecurringPart>& parts,
                    const FeatureLines& graph, double margin, PartPoints& found,
                    const Context& context) {
  struct Owner {
    Index part, instance;
  };
  std::vector<Vector3> samples;
  std::vector<Owner> owners;
  for_each_line(parts, graph, [&](Index part, Index instance, const FeatureLine& line) {
    samples.insert(samples.end(), line.samples.begin(), line.samples.end());
    owners.resize(samples.size(), {part, instance});
  });
  std::vector<PartBox> boxes;
  for (const RecurringPart& part : parts) boxes.emplace_back(part.lines, graph, margin);
  const PointTree tree(rows_of(samples), context.stage(0, 0.2));
  constexpr Index grain = 1024;
  parallel_for(context.stage(0.2, 1), points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (found.part[i] >= 0) continue;
      const Owner owner = owners[tree.nearest(points[i]).index];
      const Eigen::Isometry3d& map = parts[owner.part].instances[owner.instance].map;
      if (!boxes[owner.part].holds(map.inverse() * points[i])) continue;
      found.part[i] = owner.part;
      found.instance[i] = owner.instance;
    }
  });
}

// The points of each instance, ascending, with all that are on its lines.
void collect_members(const std::vector<RecurringPart>& parts, const FeatureLines& graph,
                     PartPoints& found) {
  for (const RecurringPart& part : parts) found.members.emplace_back(part.instances.size());
  for_each_line(parts, graph, [&](Index part, Index instance, const FeatureLine& line) {
    std::vector<Index>& members = found.members[part][instance];
    members.insert(members.end(), line.points.begin(), line.points.end());
  });
  for (std::size_t i = 0; i < found.part.size(); ++i)
    if (found.part[i] >= 0)
      found.members[found.part[i]][found.instance[i]].push_back(static_cast<Index>(i));
  for (std::vector<std::vector<Index>>& part : found.members)
    for (std::vector<Index>& members : part) {
      std::sort(members.begin(), members.end());
      members.erase(std::unique(members.begin(), members.end()), members.end());
    }
}

}  // namespace

PartPoints part_points(PointsView points, const FeatureLines& graph,
                       const std::vector<RecurringPart>& parts, double tolerance,
                       const SquaredDistance& to_surface, const Context& context) {
  PartPoints found;
  found.part.assign(points.size(), -1);
  found.instance.assign(points.size(), -1);
  if (parts.empty()) return found;
  for (const RecurringPart& part : parts)
    found.scores.push_back(scores_of(part, graph, to_surface, tolerance));
  assign_lines(parts, graph, found);
  assign_surface(points, parts, graph, tolerance, found, context);
  collect_members(parts, graph, found);
  return found;
}

}  // namespace symsurf
