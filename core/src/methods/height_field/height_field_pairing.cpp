#include "methods/height_field/height_field_pairing.h"

#include <Eigen/Core>
#include <algorithm>

#include "base/symmetric_eigen.h"

namespace symsurf {

std::vector<ChordPair> nested_pairs(const WorkingCloud& cloud, const Vector3& direction,
                                    double tolerance) {
  const Eigen::VectorXd heights = cloud.points * direction;
  const Points flat = cloud.points - heights * direction.transpose();
  const PointTree tree(flat);
  std::vector<ChordPair> pairs;
  std::vector<Index> line;
  for (Index i = 0; i < cloud.size(); ++i) {
    line.clear();
    tree.within(flat.row(i).transpose(), tolerance, [&](Index j, double) { line.push_back(j); });
    if (*std::min_element(line.begin(), line.end()) != i) continue;  // each line once
    std::sort(line.begin(), line.end(), [&](Index a, Index b) {
      return heights[a] != heights[b] ? heights[a] < heights[b] : a < b;
    });
    for (std::size_t low = 0, high = line.size() - 1; low < high; ++low, --high)
      pairs.emplace_back(line[low], line[high]);
  }
  return pairs;
}

Vector3 common_direction(const WorkingCloud& cloud, const std::vector<ChordPair>& pairs) {
  Matrix3 scatter = Matrix3::Zero();
  for (const auto& [a, b] : pairs) {
    const Vector3 chord = cloud.point(b) - cloud.point(a);
    scatter += chord * chord.transpose();
  }
  return eigen_of(scatter).vectors.col(2);
}

}  // namespace symsurf
