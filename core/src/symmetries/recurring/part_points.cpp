#include "symmetries/recurring/part_points.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "base/parallel.h"
#include "base/symmetric_eigen.h"
#include "mesh/closest_point_on_mesh.h"
#include "spatial/point_tree.h"

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
                           const ClosestPointOnMesh& closest, double tolerance) {
  constexpr double on_it = 0.1;  // of the tolerance
  std::vector<Vector3> points;
  for (const Index line : lines) {
    const FeatureLine& own = graph.lines[line];
    points.insert(points.end(), own.samples.begin(), own.samples.end());
    for (const Vector3& wing : own.wings) {
      const Vector3 x = own.middle() + beside * own.length * wing;
      if (closest(x, on_it * tolerance * on_it * tolerance).face >= 0) points.push_back(x);
    }
  }
  return points;
}

}  // namespace

PartPoints part_points(const Cloud& cloud, const FeatureLines& graph,
                       const std::vector<RecurringPart>& parts, double tolerance,
                       const Context& context) {
  struct Owner {
    Index part, instance;
  };
  std::vector<Vector3> on_lines;
  std::vector<Owner> owners;
  std::vector<PartBox> boxes;
  PartPoints found;
  const Index count = cloud.points.size();
  found.part.assign(count, -1);
  found.instance.assign(count, -1);
  std::vector<char> is_on_line(count, 0);
  const ClosestPointOnMesh closest(cloud.points, cloud.faces, context.stage(0, 0.4));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    boxes.emplace_back(parts[p].lines, graph, tolerance);
    const std::vector<Vector3> surface = about(parts[p].lines, graph, closest, tolerance);
    std::vector<double> scores;
    for (std::size_t i = 0; i < parts[p].instances.size(); ++i) {
      const RecurringPart::Instance& instance = parts[p].instances[i];
      double sum = 0;
      for (const Vector3& x : surface) {
        const double limit = 4 * tolerance * tolerance;
        const ClosestPoint nearest = closest(instance.map * x, limit);
        if (nearest.face >= 0) sum += biweight(std::sqrt(nearest.squared_distance / limit));
      }
      scores.push_back(sum / static_cast<double>(surface.size()));
      for (const Index line : instance.lines) {
        const FeatureLine& own = graph.lines[line];
        for (const Index point : own.points) {
          if (!is_on_line[point]) {
            found.part[point] = static_cast<Index>(p);
            found.instance[point] = static_cast<Index>(i);
            is_on_line[point] = 1;
          }
        }
        for (const Vector3& x : own.samples) {
          on_lines.push_back(x);
          owners.push_back({static_cast<Index>(p), static_cast<Index>(i)});
        }
      }
    }
    found.scores.push_back(std::move(scores));
  }
  if (parts.empty()) return found;
  const PointTree tree(rows_of(on_lines), context.stage(0.4, 0.5));
  constexpr Index grain = 1024;
  parallel_for(context.stage(0.5, 1), count, grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (is_on_line[i]) continue;
      const Owner owner = owners[tree.nearest(cloud.points[i]).index];
      const Eigen::Isometry3d& map = parts[owner.part].instances[owner.instance].map;
      if (!boxes[owner.part].holds(map.inverse() * cloud.points[i])) continue;
      found.part[i] = owner.part;
      found.instance[i] = owner.instance;
    }
  });
  for (const RecurringPart& part : parts) {
    found.members.emplace_back();
    for (const RecurringPart::Instance& instance : part.instances) {
      std::vector<Index>& members = found.members.back().emplace_back();
      for (const Index line : instance.lines)
        members.insert(members.end(), graph.lines[line].points.begin(),
                       graph.lines[line].points.end());
    }
  }
  for (Index i = 0; i < count; ++i)
    if (found.part[i] >= 0) found.members[found.part[i]][found.instance[i]].push_back(i);
  for (std::vector<std::vector<Index>>& part : found.members)
    for (std::vector<Index>& members : part) {
      std::sort(members.begin(), members.end());
      members.erase(std::unique(members.begin(), members.end()), members.end());
    }
  return found;
}

}  // namespace symsurf
