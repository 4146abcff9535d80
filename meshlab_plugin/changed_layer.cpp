// SPDX-License-Identifier: GPL-3.0-or-later
#include "changed_layer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cloud_conversion.h"
#include "directions.h"

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

template <typename Attributes>
void copy_attributes(const Attributes& attributes, std::size_t to, std::size_t from) {
  for (const auto& attribute : attributes) {
    auto* values = static_cast<vcg::SimpleTempDataBase*>(attribute._handle);
    values->CopyValue(to, from, values);
  }
}

// Behind the vertices of the layer those that the sources from `from` on stand for.
void add_vertices(CMeshO& mesh, const std::vector<Index>& sources, std::size_t from) {
  const std::size_t first = mesh.vert.size();
  if (sources.size() > from) Allocator::AddVertices(mesh, sources.size() - from);
  for (std::size_t i = first; i < mesh.vert.size(); ++i) {
    const auto source = static_cast<std::size_t>(sources[i - first + from]);
    mesh.vert[i].ImportData(mesh.vert[source]);
    copy_attributes(mesh.vert_attr, i, source);
  }
}

using TexCoords = std::vector<CFaceO::TexCoordType>;

// Of each vertex those of one of its corners.
TexCoords texture_of_vertices(const CMeshO& mesh) {
  TexCoords found(mesh.vert.size());
  for (auto face = mesh.face.rbegin(); face != mesh.face.rend(); ++face)
    for (int corner = 0; corner < 3; ++corner)
      found[vcg::tri::Index(mesh, face->cV(corner))] = face->cWT(corner);
  return found;
}

// What lies between the corners that a point lies between: those of the source, or of other faces.
CFaceO::TexCoordType texture_between(const CMeshO& mesh, const CFaceO& source,
                                     const TexCoords& of_vertices, const OperationResult& result,
                                     Index point) {
  CFaceO::TexCoordType found;
  const bool is_other = result.is_other_shape();
  vcg::Point2f sum(0, 0);
  for (Index k = 0; k < (is_other ? result.point_parents.cols() : 1); ++k) {
    const Index parent = is_other ? result.point_parents(point, k) : result.point_sources[point];
    const double share = is_other ? result.point_shares(point, k) : 1;
    CFaceO::TexCoordType own = of_vertices[static_cast<std::size_t>(parent)];
    for (int corner = 0; corner < 3; ++corner)
      if (static_cast<Index>(vcg::tri::Index(mesh, source.cV(corner))) == parent)
        own = source.cWT(corner);
    if (k == 0) found.n() = own.n();
    sum += own.P() * static_cast<float>(share);
  }
  found.P() = sum;
  return found;
}

// Faces that the result has from the number `from` on, between vertices that the layer has from
// `first_vertex` on. Their corners may run the other way round than those of their sources.
void add_faces(CMeshO& mesh, const OperationResult& result, std::size_t from,
               std::size_t first_vertex) {
  const std::size_t first = mesh.face.size(), count = result.face_sources.size();
  const bool has_wedges = vcg::tri::HasPerWedgeTexCoord(mesh);
  const TexCoords of_vertices = has_wedges ? texture_of_vertices(mesh) : TexCoords();
  if (count > from) Allocator::AddFaces(mesh, count - from);
  for (std::size_t i = first; i < mesh.face.size(); ++i) {
    const std::size_t row = i - first + from;
    const auto made = static_cast<Index>(row);
    CFaceO& face = mesh.face[i];
    const CFaceO& source = mesh.face[result.face_sources[row]];
    face.ImportData(source);
    for (int corner = 0; corner < 3; ++corner) {
      const Index point = result.faces(made, corner);
      face.V(corner) = &mesh.vert[static_cast<std::size_t>(point) + first_vertex];
      if (has_wedges) face.WT(corner) = texture_between(mesh, source, of_vertices, result, point);
    }
    face.ClearAllF();  // edges inside a polygon, which the added faces are not part of
    copy_attributes(mesh.face_attr, i, result.face_sources[row]);
  }
}

void add_what_is_new(MeshModel& layer, const OperationResult& result) {
  CMeshO& mesh = layer.cm;
  const std::size_t vertices = mesh.vert.size(), faces = mesh.face.size();
  layer.clearDataMask(MeshModel::MM_VERTFACETOPO | MeshModel::MM_FACEFACETOPO);
  add_vertices(mesh, result.point_sources, vertices);
  add_faces(mesh, result, faces, 0);
  for (std::size_t i = 0; i < mesh.vert.size(); ++i)
    i < vertices ? mesh.vert[i].ClearS() : mesh.vert[i].SetS();
  for (std::size_t i = 0; i < mesh.face.size(); ++i)
    i < faces ? mesh.face[i].ClearS() : mesh.face[i].SetS();
}

// Other vertices and faces in place of those of the layer, which they take their attributes from.
void put_others(MeshModel& layer, const OperationResult& result) {
  CMeshO& mesh = layer.cm;
  const std::size_t vertices = mesh.vert.size(), faces = mesh.face.size();
  layer.clearDataMask(MeshModel::MM_VERTFACETOPO | MeshModel::MM_FACEFACETOPO);
  add_vertices(mesh, result.point_sources, 0);
  add_faces(mesh, result, 0, vertices);
  for (std::size_t i = 0; i < faces; ++i) Allocator::DeleteFace(mesh, mesh.face[i]);
  for (std::size_t i = 0; i < vertices; ++i) Allocator::DeleteVertex(mesh, mesh.vert[i]);
  Allocator::CompactEveryVector(mesh);
  for (CFaceO& face : mesh.face) face.ClearS();
  for (const auto& [name, is_so] : result.face_arrays)
    for (Index f = 0; f < is_so.rows(); ++f)
      if (is_so(f, 0) != 0) mesh.face[static_cast<std::size_t>(f)].SetS();
}

// Gives a number of the vertices what lies between those of their parents.
template <typename Of>
void blend(const CMeshO& mesh, const AttributeTransform& by, const Of& of) {
  Eigen::MatrixXd rows(mesh.vert.size(), 1);
  for (Index i = 0; i < rows.rows(); ++i) rows(i) = of(static_cast<std::size_t>(i));
  rows = by(rows, AttributeKind::Scalar);
  for (Index i = 0; i < rows.rows(); ++i)
    of(static_cast<std::size_t>(i)) = static_cast<Scalarm>(rows(i));
}

// Colours, quality and attributes of the vertices; selects those without a counterpart.
void carry_values(CMeshO& mesh, const OperationResult& result, const AttributeTransform& by) {
  Eigen::MatrixXd colours(mesh.vert.size(), 4);
  for (Index i = 0; i < colours.rows(); ++i)
    for (int c = 0; c < 4; ++c) colours(i, c) = mesh.vert[static_cast<std::size_t>(i)].cC()[c];
  colours = by(colours, AttributeKind::Scalar);
  const Eigen::MatrixXd& failed = result.arrays.at("failed");
  for (Index i = 0; i < colours.rows(); ++i) {
    CVertexO& vertex = mesh.vert[static_cast<std::size_t>(i)];
    for (int c = 0; c < 4; ++c)
      vertex.C()[c] = static_cast<unsigned char>(std::lround(colours(i, c)));
    failed(i, 0) != 0 ? vertex.SetS() : vertex.ClearS();
  }
  blend(mesh, by, [&](std::size_t i) -> Scalarm& { return mesh.vert[i].Q(); });
  std::vector<std::string> names;
  Allocator::GetAllPerVertexAttribute<Scalarm>(mesh, names);
  for (const std::string& name : names) {
    auto attribute = Allocator::GetPerVertexAttribute<Scalarm>(mesh, name);
    blend(mesh, by, [&](std::size_t i) -> Scalarm& { return attribute[i]; });
  }
}

}  // namespace

void change_layer(MeshModel& layer, const OperationResult& result, const AttributeTransform& by) {
  CMeshO& mesh = layer.cm;
  const Operation& done = operation(result.operation);
  Directions directions(mesh);
  if (by.turns()) directions.carry(by);
  if (done.carries_values) {
    std::vector<Point3m> normals;  // the points', which stay
    for (const CVertexO& vertex : mesh.vert) normals.push_back(vertex.cN());
    carry_values(mesh, result, by);
    directions.set(mesh);
    for (std::size_t i = 0; i < normals.size(); ++i) mesh.vert[i].N() = normals[i];
    return;
  }
  // All zero says to MeshLab that there are none: of points that moved each by itself nobody knows
  // them. Those of a mesh its faces give anew.
  if (done.takes_mask && mesh.fn == 0 && !by.turns())
    for (CVertexO& vertex : mesh.vert) vertex.N() = Point3m(0, 0, 0);
  if (result.is_other_shape())
    put_others(layer, result);
  else if (!result.point_sources.empty())
    add_what_is_new(layer, result);
  if (by.turns()) directions.set(mesh);
  const auto is_placed = [&](Index i) { return result.points.row(i).allFinite(); };
  const Index count = result.points.rows();
  bool all_placed = true;
  for (Index i = 0; i < count; ++i) {
    all_placed = all_placed && is_placed(i);
    if (is_placed(i)) mesh.vert[i].P() = to_point(result.points, i);
  }
  for (Index i = 0; i < count && !all_placed; ++i)
    is_placed(i) ? mesh.vert[i].ClearS() : mesh.vert[i].SetS();
  layer.updateBoxAndNormals();
}

}  // namespace symsurf::meshlab
