#include "score/verdict.h"

#include <algorithm>

namespace symsurf {

namespace {

// So many of them, spread over their order.
template <typename Holds>
bool hold_all(PointsView points, const Holds& holds) {
  constexpr Index most = 1000;
  const Index count = std::min(most, points.size());
  for (Index k = 0; k < count; ++k)
    if (!holds(points[k * points.size() / count])) return false;
  return true;
}

}  // namespace

MeshSymmetry::MeshSymmetry(const Cloud& mesh, const Context& context)
    : mesh_(mesh), tree_(mesh.tree(context)), surface_(mesh.points, mesh.faces, context) {}

bool MeshSymmetry::operator()(const Mirror& mirror, PointsView samples) const {
  // Of the diagonal.
  constexpr double exactly = 1e-6;  // single precision
  constexpr double nearly = 0.01;   // a sphere of 12 quads around, divided by either diagonal
  const auto squared = [&](double share) {
    return share * share * mesh_.diagonal * mesh_.diagonal;
  };
  return hold_all(mesh_.points,
                  [&](const Vector3& x) {
                    return tree_.nearest(mirror.reflect(x), squared(exactly)).index >= 0;
                  }) &&
         hold_all(samples, [&](const Vector3& x) {
           return surface_(mirror.reflect(x), squared(nearly)).face >= 0;
         });
}

}  // namespace symsurf
