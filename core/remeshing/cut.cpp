#include <symsurf/mirrors.h>

#include <algorithm>
#include <map>

#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "cloud/triangulation.h"
#include "isotropic_remeshing.h"
#include "operations/meshes.h"
#include "remeshing.h"

namespace symsurf {

namespace {

// The curves of the cut, against the winding of the faces there, copies of points taken for one.
// Those that do not close are counted and left out.
std::vector<Polygon> closed_curves(const Half& half, Index& open, const Context& context) {
  const DistinctPoints distinct = distinct_points(half.points, context);
  const Triangles welded =
      half.faces.unaryExpr([&](Index i) -> Index { return distinct.first[distinct.number[i]]; });
  std::multimap<Index, Index> next;
  std::map<Index, Index> ends;  // edges that arrive, less those that leave
  for (const auto& [a, b] : cut_edges(welded, half.on_mirror)) {
    next.emplace(b, a);
    ++ends[a];
    --ends[b];
  }
  std::vector<Polygon> curves;
  const auto follow = [&](Index start) {
    Polygon path{start};
    for (auto edge = next.find(start); edge != next.end(); edge = next.find(path.back())) {
      path.push_back(edge->second);
      next.erase(edge);
      const auto back = std::find(path.begin(), path.end() - 1, path.back());
      if (path.end() - back > 3) curves.emplace_back(back, path.end() - 1);
      path.erase(back + 1, path.end());
    }
  };
  for (const auto& [point, arriving] : ends)
    for (Index k = arriving; k < 0; ++k) {
      follow(point);
      ++open;
    }
  while (!next.empty()) follow(next.begin()->first);
  return curves;
}

// Where the points lie in the plane that the mirror is laid flat into.
Points2 laid_flat(const Points& points, const Mirror& mirror, const Context& context) {
  const Points flat = bend(points, mirror, Bend::Straighten, context);
  return flat * orthogonal_to(straight_mirror(mirror, points).normal());
}

// Faces within a mirror that close a half where it is cut.
struct Cap {
  Points points;    // within the cut, behind those of the half
  Triangles faces;  // of points of the half and of these
  Index open = 0;   // curves of the cut that do not close: the shape ends at them
};

// Of the points at the cut alone, or of triangles about as large as the faces of the half. Closed
// curves within others bound holes.
Cap cap_of(const Half& half, const Mirror& mirror, bool is_even, const Context& context) {
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
  cap.faces = polygon_triangulation(flat, curves);
  // Points of the rim come first, in their order: none of them goes.
  const auto count = static_cast<Index>(rim.size());
  if (is_even) {
    Remeshing remeshing;
    remeshing.edge_length = edge_length_of(surface_area(half.points, half.faces),
                                           static_cast<double>(half.faces.rows()));
    remeshing.keeps_boundary = true;
    remeshing.onto = [&](const Vector3& x) { return mirror.foot(x); };
    Remeshed made = isotropic_remeshing(corners, cap.faces, remeshing, context.stage(0.2, 1));
    cap.points = made.points.bottomRows(made.points.rows() - count);
    cap.faces = std::move(made.faces);
  }
  for (Index& corner : cap.faces.reshaped())
    corner = corner < count ? rim[corner] : half.points.rows() + corner - count;
  std::vector<Index> proper;  // not those between curves that touch each other
  for (Index f = 0; f < cap.faces.rows(); ++f)
    if (!is_degenerate(cap.faces.row(f).data())) proper.push_back(f);
  cap.faces = cap.faces(proper, Eigen::indexing::all).eval();
  return cap;
}

// Points and faces of the cap, with what the points and faces beside them have.
void add_cap(const Cap& cap, Half& half) {
  const Index points = half.points.rows(), faces = half.faces.rows();
  std::vector<Index> face_at(points, 0);
  for (Index f = 0; f < faces; ++f)
    for (const Index i : half.faces.row(f)) face_at[i] = f;
  std::vector<Index> source(points + cap.points.rows(), -1);
  for (Index i = 0; i < points; ++i) source[i] = i;
  // From the rim inwards.
  for (bool any = true; any;) {
    any = false;
    for (const auto& face : cap.faces.rowwise())
      for (int k = 0; k < 3; ++k)
        if (const Index from = source[face[(k + 1) % 3]]; source[face[k]] < 0 && from >= 0) {
          source[face[k]] = from;
          any = true;
        }
  }
  half.points.conservativeResize(points + cap.points.rows(), 3);
  half.points.bottomRows(cap.points.rows()) = cap.points;
  half.parents.conservativeResize(half.points.rows(), 3);
  half.shares.conservativeResize(half.points.rows(), 3);
  for (Index i = points; i < half.points.rows(); ++i) {
    half.parents.row(i) = half.parents.row(source[i]);
    half.shares.row(i) = half.shares.row(source[i]);
    half.on_mirror.push_back(true);
  }
  half.faces.conservativeResize(faces + cap.faces.rows(), 3);
  half.faces.bottomRows(cap.faces.rows()) = cap.faces;
  for (const auto& face : cap.faces.rowwise())
    half.face_sources.push_back(half.face_sources[face_at[source[face[0]]]]);
}

void run_cut(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
             const Context& context, OperationResult& result) {
  Half half =
      half_of(input.points, input.faces, mirror, keeps_positive(values), context.stage(0, 0.4));
  const Index faces = half.faces.rows();
  if (values.boolean("capped") && faces > 0) {
    // A plain one leaves a mirror that bends.
    const bool is_even = values.boolean("even_cap") || mirror.kind() != "plane";
    const Cap cap = cap_of(half, mirror, is_even, context.stage(0.4, 1));
    add_cap(cap, half);
    result.statistics["open_curves"] = cap.open;
  }
  Eigen::VectorXd on_mirror(half.points.rows());
  for (Index i = 0; i < on_mirror.size(); ++i) on_mirror[i] = half.on_mirror[i];
  Eigen::VectorXd is_cap = Eigen::VectorXd::Zero(half.faces.rows());
  is_cap.tail(half.faces.rows() - faces).setOnes();
  result.statistics["cap_faces"] = half.faces.rows() - faces;
  result.arrays = {{"on_mirror", on_mirror}};
  result.face_arrays = {{"cap", is_cap}};
  set_shape(std::move(half), result);
}

}  // namespace

OperationImplementation cut_operation() {
  OperationImplementation operation;
  operation.name = "cut";
  operation.title = "Mirror cut";
  operation.summary = "Cuts the shape along the mirror and keeps one side: half a model.";
  operation.parameters = {
      kept_side(),
      Parameter::boolean(
          "capped", true,
          "Close the cut of a mesh by faces in the mirror: a closed mesh stays closed."),
      Parameter::boolean(
          "even_cap", false,
          "Close the cut by triangles as large as those of the shape, as always over a curved "
          "mirror; slower than triangles between the points at the cut.")};
  operation.arrays = {{"on_mirror", ParameterType::Boolean, 1,
                       "Whether the point lies on the mirror: at the cut or within it."}};
  operation.face_arrays = {
      {"cap", ParameterType::Boolean, 1, "Whether the face lies within the mirror and closes it."}};
  operation.moves_points = true;
  operation.makes_shape = true;
  operation.run = run_cut;
  return operation;
}

}  // namespace symsurf
