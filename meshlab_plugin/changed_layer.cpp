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

void add_vertices(CMeshO& mesh, const std::vector<Index>& sources) {
  const std::size_t first = mesh.vert.size();
  if (sources.size() > first) Allocator::AddVertices(mesh, sources.size() - first);
  for (std::size_t i = first; i < sources.size(); ++i) {
    mesh.vert[i].ImportData(mesh.vert[sources[i]]);
    mesh.vert[i].N() = Point3m(0, 0, 0);  // the mirrored one's, where faces do not give it another
    copy_attributes(mesh.vert_attr, i, sources[i]);
  }
}

// Of a mirrored face the corners run the other way round: each has the texture of the corner that
// its vertex comes from, where the source has one.
void copy_wedges(CMeshO& mesh, CFaceO& face, const CFaceO& source,
                 const std::vector<Index>& point_sources) {
  for (int corner = 0; corner < 3; ++corner) {
    const auto from =
        static_cast<std::size_t>(point_sources[vcg::tri::Index(mesh, face.cV(corner))]);
    for (int other = 0; other < 3; ++other)
      if (vcg::tri::Index(mesh, source.cV(other)) == from) face.WT(corner) = source.cWT(other);
  }
}

void add_faces(CMeshO& mesh, const OperationResult& result) {
  const std::size_t first = mesh.face.size(), count = result.face_sources.size();
  const bool has_wedges = vcg::tri::HasPerWedgeTexCoord(mesh);
  if (count > first) Allocator::AddFaces(mesh, count - first);
  for (std::size_t i = first; i < count; ++i) {
    CFaceO& face = mesh.face[i];
    const CFaceO& source = mesh.face[result.face_sources[i]];
    face.ImportData(source);
    for (int corner = 0; corner < 3; ++corner)
      face.V(corner) = &mesh.vert[result.faces(static_cast<Index>(i), corner)];
    if (has_wedges) copy_wedges(mesh, face, source, result.point_sources);
    face.ClearAllF();  // edges inside a polygon, which the added faces are not part of
    copy_attributes(mesh.face_attr, i, result.face_sources[i]);
  }
}

void add_what_is_new(MeshModel& layer, const OperationResult& result) {
  CMeshO& mesh = layer.cm;
  const std::size_t vertices = mesh.vert.size(), faces = mesh.face.size();
  layer.clearDataMask(MeshModel::MM_VERTFACETOPO | MeshModel::MM_FACEFACETOPO);
  add_vertices(mesh, result.point_sources);
  add_faces(mesh, result);
  for (std::size_t i = 0; i < mesh.vert.size(); ++i)
    i < vertices ? mesh.vert[i].ClearS() : mesh.vert[i].SetS();
  for (std::size_t i = 0; i < mesh.face.size(); ++i)
    i < faces ? mesh.face[i].ClearS() : mesh.face[i].SetS();
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
  if (!result.point_sources.empty()) add_what_is_new(layer, result);
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
