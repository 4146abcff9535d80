// SPDX-License-Identifier: GPL-3.0-or-later
#include "changed_layer.h"

#include <algorithm>

#include "cloud_conversion.h"

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
    mesh.vert[i].N() = Point3m(0, 0, 0);  // the mirrored one's, where faces do not give it another
    copy_attributes(mesh.vert_attr, i, source);
  }
}

// What lies between the corners of the source that a point lies between, where it has them.
CFaceO::TexCoordType texture_between(const CMeshO& mesh, const CFaceO& source,
                                     const OperationResult& result, Index point) {
  CFaceO::TexCoordType found;
  const bool is_other = result.point_parents.rows() > 0;
  vcg::Point2f sum(0, 0);
  for (int k = 0; k < (is_other ? 3 : 1); ++k) {
    const Index parent = is_other ? result.point_parents(point, k) : result.point_sources[point];
    const double share = is_other ? result.point_shares(point, k) : 1;
    for (int corner = 0; corner < 3; ++corner)
      if (static_cast<Index>(vcg::tri::Index(mesh, source.cV(corner))) == parent) {
        found.n() = source.cWT(corner).n();
        sum += source.cWT(corner).P() * static_cast<float>(share);
        break;
      }
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
      if (has_wedges) face.WT(corner) = texture_between(mesh, source, result, point);
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
}

// Those of a mesh its faces give anew. A cloud's are turned with it, or lost: all zero says so to
// MeshLab.
void move_normals(CMeshO& mesh, const OperationResult& result) {
  const auto found = result.statistics.find("matrix");
  if (found == result.statistics.end()) {
    for (CVertexO& vertex : mesh.vert) vertex.N() = Point3m(0, 0, 0);
    return;
  }
  const auto& matrix = std::get<Eigen::MatrixXd>(found->second);
  for (CVertexO& vertex : mesh.vert) {
    const Vector3 normal(vertex.cN()[0], vertex.cN()[1], vertex.cN()[2]);
    const Vector3 turned = matrix.topLeftCorner<3, 3>() * normal;
    vertex.N() = Point3m(turned.x(), turned.y(), turned.z());
  }
}

}  // namespace

void change_layer(MeshModel& layer, const OperationResult& result) {
  CMeshO& mesh = layer.cm;
  const bool is_moved = operation(result.operation).moves_points;
  if (is_moved && mesh.fn == 0) move_normals(mesh, result);
  if (result.point_parents.rows() > 0)
    put_others(layer, result);
  else if (!result.point_sources.empty())
    add_what_is_new(layer, result);
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
