#include "symmetries/point_group/deviation.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace symsurf {

Deviation::Deviation(PointsView points, TrianglesView faces, const Context& context)
    : points_(points), tree_(points, context) {
  if (!faces.empty()) surface_.emplace(points, faces, context);
  std::vector<bool> is_vertex(points.size(), faces.empty());
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) is_vertex[faces[f][c]] = true;
  for (const Index i : tree_.order())
    if (is_vertex[i] && points[i].allFinite()) vertices_.push_back(i);
}

double Deviation::squared_distance(const Vector3& x) const {
  return surface_ ? (*surface_)(x).squared_distance : tree_.nearest(x).squared_distance;
}

std::vector<double> Deviation::of(const std::vector<Matrix4>& maps, Index looked,
                                  const Context& context) const {
  const auto count = static_cast<Index>(vertices_.size()), all = static_cast<Index>(maps.size());
  const Index stride = std::max<Index>(1, count * all / looked);
  std::vector<double> deviations(maps.size(), 0);
  parallel_for(context, all, 1, [&](Index begin, Index end) {
    for (Index m = begin; m < end; ++m) {
      if (maps[m].isIdentity(0)) continue;
      double greatest = 0;
      for (Index k = 0; k < count; k += stride) {
        context.check();
        const Vector3 image = (maps[m] * points_[vertices_[k]].homogeneous()).head<3>();
        greatest = std::max(greatest, squared_distance(image));
      }
      deviations[m] = std::sqrt(greatest);
    }
  });
  return deviations;
}

}  // namespace symsurf
