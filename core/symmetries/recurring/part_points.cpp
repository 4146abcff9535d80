#include "recurring/part_points.h"

#include <algorithm>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"

namespace symsurf {

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
