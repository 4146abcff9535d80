#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "methods/registry.h"
#include "methods/thesis/estimated_normals.h"
#include "methods/thesis/separation.h"
#include "spatial/kd_tree.h"

namespace symsurf {

namespace {

/// The projection error of the thesis's Algorithm 2 (3.5): the mean squared
/// distance of the partners b from q, the point of X2 whose normal makes the
/// smallest angle with that of x (equal angles: the lowest index).
class NormalError {
 public:
  /// as_lines: the normals' sign does not count.
  NormalError(PointsView points, PointsView normals, bool as_lines, const Context& context)
      : points_(points),
        normals_(normals),
        as_lines_(as_lines),
        order_(PointTree(normals, context).order()) {}

  double operator()(const Separation& separation, const Context& context) const {
    const Groups groups = grouped(separation, context);
    const KdTree<3> tree(groups.first, context);
    Parallel best{-2, groups.members.front()};
    double sum = 0;
    interruptible_for(context, points_.size(), [&](Index p) {
      const std::int32_t i = order_[p];
      if (separation.partner[i] < 0) return;
      const Vector3 normal = normals_[i];
      best.cosine = cosine(normal, best.index);  // of the one before: a guess
      const auto offer = [&](std::uint32_t group) {
        for (std::int32_t k = groups.begin[group]; k < groups.begin[group + 1]; ++k) {
          const Parallel found{cosine(normal, groups.members[k]), groups.members[k]};
          if (found < best) best = found;
          if (found.cosine == 1) break;  // the others of the group have higher indices
        }
        return reach(best);
      };
      tree.search(normal, reach(best), offer);
      if (as_lines_) tree.search(-normal, reach(best), offer);
      sum += (points_[separation.partner[i]] - points_[best.index]).squaredNorm();
    });
    return sum / static_cast<double>(separation.upper);
  }

 private:
  struct Parallel {
    double cosine;
    std::int32_t index;

    bool operator<(const Parallel& other) const {
      return cosine != other.cosine ? cosine > other.cosine : index < other.index;
    }
  };

  // Normals of X2 in groups as good as equal. On a flat face all are, and
  // whichever point asks would have to look at each of them.
  struct Groups {
    std::vector<Vector3> first;         // of each group one normal; the others are no
                                        // farther from it than `radius`
    std::vector<std::int32_t> begin;    // of each group, in members
    std::vector<std::int32_t> members;  // indices, ascending in a group; of equal normals the first
  };
  static constexpr double radius = 1e-8;

  Groups grouped(const Separation& separation, const Context& context) const {
    Groups groups;
    const auto close_group = [&] {
      if (groups.begin.empty()) return;
      const auto begin = groups.members.begin() + groups.begin.back();
      std::sort(begin, groups.members.end());
      groups.members.erase(
          std::unique(begin, groups.members.end(),
                      [&](Index i, Index j) { return normals_[i] == normals_[j]; }),
          groups.members.end());
    };
    interruptible_for(context, points_.size(), [&](Index p) {
      const std::int32_t i = order_[p];
      if (separation.partner[i] >= 0) return;
      if (groups.first.empty() || (normals_[i] - groups.first.back()).norm() > radius) {
        close_group();
        groups.begin.push_back(static_cast<std::int32_t>(groups.members.size()));
        groups.first.push_back(normals_[i]);
      }
      groups.members.push_back(i);
    });
    close_group();
    groups.begin.push_back(static_cast<std::int32_t>(groups.members.size()));
    return groups;
  }

  // Within rounding of 1 it is 1: all these angles are 0.
  double cosine(const Vector3& normal, std::int32_t i) const {
    const double c = normal.dot(normals_[i]), size = as_lines_ ? std::abs(c) : c;
    return size > 1 - 1e-15 ? 1 : size;
  }

  // The square of how far from a unit normal the first ones of groups may lie
  // whose members have a greater cosine, or the same; 4e-15 for its rounding.
  static double reach(const Parallel& best) {
    const double distance = std::sqrt(2 - 2 * best.cosine + 4e-15) + radius;
    return distance * distance;
  }

  PointsView points_, normals_;
  bool as_lines_;
  std::vector<std::int32_t> order_;  // of the normals, parallel ones together
};

Result run_separation_normals(const Cloud& cloud, const ParameterValues& values,
                              const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.02));
  const Points normals = given_or_estimated_normals(cloud, tree, values, context.stage(0.02, 0.1));
  const NormalError error(cloud.points, normals, !signed_normals(cloud, values),
                          context.stage(0.1, 0.12));
  Result result =
      best_separation(cloud, tree, values.integer("steps"), error, context.stage(0.12, 1));
  result.method = "separation_normals";
  return result;
}

}  // namespace

MethodImplementation separation_normals_method() {
  MethodImplementation method;
  method.name = "separation_normals";
  method.title = "Symmetry by separation and normals (thesis, Algorithm 2)";
  method.summary =
      "As separation, but scores a plane by how near the partner is to the "
      "point with the most "
      "similar normal; the score depends on the unit of the input.";
  method.parameters = normal_parameters();
  method.parameters.insert(method.parameters.begin(), direction_steps());
  method.preprocessing = Preprocessing::none();
  method.run = run_separation_normals;
  return method;
}

}  // namespace symsurf
