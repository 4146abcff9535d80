#include "operations/cap.h"

#include <symsurf/mirrors.h>

#include <algorithm>
#include <map>

#include "base/math.h"
#include "cloud/distinct_points.h"
#include "cloud/isotropic_remeshing.h"
#include "cloud/polygon_triangulation.h"
#include "cloud/triangle_mesh.h"

namespace symsurf {

namespace {

// The curves of the cut, against the winding of the faces there, copies of points taken for one.
// Those that do not close are counted and left out.
std::vector<Polygon> closed_curves(const Half& half, Index& open, const Context& context) {
  const DistinctPoints distinct = distinct_points(half.points, context);
  const auto first = [&](Index i) -> Index { return distinct.first[distinct.number[i]]; };
  std::multimap<Index, Index> next;
  std::map<Index, Index> ends;  // edges that arrive, less those that leave
  for (const auto& [a, b] : cut_edges(half)) {
    if (first(a) == first(b)) continue;
    next.emplace(first(b), first(a));
    ++ends[first(a)];
    --ends[first(b)];
  }
  const auto follow = [&](Index start) {
    Polygon curve{start};
    for (auto edge = next.find(start); edge != next.end(); edge = next.find(curve.back())) {
      curve.push_back(edge->second);
      next.erase(edge);
      if (curve.back() == start) break;
    }
    return curve;
  };
  for (const auto& [point, arriving] : ends)
    for (Index k = arriving; k < 0; ++k) {
      follow(point);
      ++open;
    }
  std::vector<Polygon> curves;
  while (!next.empty()) {
    Polygon curve = follow(next.begin()->first);
    curve.pop_back();
    if (curve.size() > 2) curves.push_back(std::move(curve));
  }
  return curves;
}

// Where the points lie in the plane that the mirror is laid flat into.
Points2 laid_flat(const Points& points, const Mirror& mirror, const Context& context) {
  const Points flat = bend(points, mirror, Bend::Straighten, context);
  return flat * orthogonal_to(straight_mirror(mirror, points).normal());
}

}  // namespace

Cap cap_of(const Half& half, const Mirror& mirror, const Context& context) {
  Cap cap;
  cap.faces.resize(0, 3);
  std::vector<Polygon> curves = closed_curves(half, cap.open, context.stage(0, 0));
  std::vector<Index> rim;  // of the cap's points the half's
  for (Polygon& curve : curves)
    for (Index& i : curve) {
      rim.push_back(i);
      i = static_cast<Index>(rim.size()) - 1;
    }
  if (rim.empty()) return cap;
  const Points corners = half.points(rim, Eigen::indexing::all);
  Points2 flat = laid_flat(corners, mirror, context.stage(0, 0.2));
  double area = 0;
  for (const Polygon& curve : curves) area += signed_area(flat, curve);
  if (area < 0) flat.col(0) *= -1;  // outer curves run counterclockwise
  const Triangles filled = polygon_triangulation(flat, curves);

  Remeshing remeshing;
  remeshing.edge_length =
      edge_length_of(surface_area(half.points, half.faces), static_cast<double>(half.faces.rows()));
  remeshing.keeps_boundary = true;
  remeshing.onto = [&](const Vector3& x) { return mirror.foot(x); };
  const Remeshed made = isotropic_remeshing(corners, filled, remeshing, context.stage(0.2, 1));
  // Points of the rim come first, in their order: none of them goes.
  const auto count = static_cast<Index>(rim.size());
  cap.points = made.points.bottomRows(made.points.rows() - count);
  cap.faces = made.faces;
  for (Index& corner : cap.faces.reshaped())
    corner = corner < count ? rim[corner] : half.points.rows() + corner - count;
  return cap;
}

}  // namespace symsurf
