// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_conversion.h"

#include <symsurf/context.h>

#include <algorithm>
#include <string>

namespace symsurf::meshlab {

namespace {

// pymeshlab passes percentages on in single precision, which holds 1e-38 to 1e38.
constexpr double largest_length = 1e30;

std::string quoted(const MeshModel& layer) { return "'" + layer.label().toStdString() + "'"; }

std::vector<char> selected_vertices(const CMeshO& mesh) {
  std::vector<char> selected(mesh.vert.size());
  std::transform(mesh.vert.begin(), mesh.vert.end(), selected.begin(),
                 [](const CVertexO& v) { return v.IsS(); });
  for (const CFaceO& face : mesh.face)
    if (!face.IsD() && face.IsS())
      for (int corner = 0; corner < face.VN(); ++corner)
        selected[vcg::tri::Index(mesh, face.cV(corner))] = true;
  return selected;
}

std::vector<int> vertices_to_read(const CMeshO& mesh, bool only_selected) {
  const std::vector<char> selected = only_selected ? selected_vertices(mesh) : std::vector<char>();
  std::vector<int> vertices;
  vertices.reserve(mesh.vn);
  for (std::size_t i = 0; i < mesh.vert.size(); ++i)
    if (!mesh.vert[i].IsD() && (!only_selected || selected[i]))
      vertices.push_back(static_cast<int>(i));
  return vertices;
}

template <typename Get>
Points packed(const CMeshO& mesh, const std::vector<int>& vertices, const Get& get) {
  Points rows(static_cast<Index>(vertices.size()), 3);
  double* row = rows.data();
  for (const int i : vertices)
    for (int axis = 0; axis < 3; ++axis) *row++ = get(mesh.vert[i])[axis];
  return rows;
}

// Those whose corners are all among the vertices, by their rows.
Triangles faces_between(const CMeshO& mesh, const std::vector<int>& vertices) {
  std::vector<Index> row(mesh.vert.size(), -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) row[vertices[k]] = static_cast<Index>(k);
  Triangles faces(mesh.fn, 3);
  Index count = 0;
  for (const CFaceO& face : mesh.face) {
    if (face.IsD()) continue;
    for (int corner = 0; corner < 3; ++corner)
      faces(count, corner) = row[vcg::tri::Index(mesh, face.cV(corner))];
    count += faces.row(count).minCoeff() >= 0;
  }
  faces.conservativeResize(count, 3);
  return faces;
}

}  // namespace

MeshModel& current_layer(MeshDocument& document) {
  if (!document.mm()) throw InvalidInput("there is no layer; open a mesh or a point cloud first");
  return *document.mm();
}

double layer_diagonal(const MeshModel* layer) {
  if (!layer || layer->cm.bbox.IsNull()) return 1;
  const double diagonal = layer->cm.bbox.Diag();
  return diagonal > 1 / largest_length && diagonal < largest_length ? diagonal : 1;
}

LayerCloud read_cloud(const MeshModel& layer, bool only_selected, bool with_normals,
                      bool with_faces) {
  const CMeshO& mesh = layer.cm;
  LayerCloud cloud;
  cloud.vertex = vertices_to_read(mesh, only_selected);
  if (cloud.vertex.empty())
    throw InvalidInput("the layer " + quoted(layer) +
                       (mesh.vn > 0 ? " has nothing selected" : " has no vertices"));
  cloud.points = packed(mesh, cloud.vertex, [](const CVertexO& v) { return v.cP(); });
  if (with_normals) {
    cloud.normals = packed(mesh, cloud.vertex, [](const CVertexO& v) { return v.cN(); });
    if (cloud.normals.isZero(0))
      throw InvalidInput("the normals of the layer " + quoted(layer) +
                         " are all zero; compute them first, or do without");
  }
  if (with_faces) cloud.faces = faces_between(mesh, cloud.vertex);
  return cloud;
}

Points read_colours(const MeshModel& layer, const LayerCloud& cloud) {
  if (!layer.hasDataMask(MeshModel::MM_VERTCOLOR)) return Points(0, 3);
  return packed(layer.cm, cloud.vertex, [](const CVertexO& v) { return v.cC(); });
}

Eigen::VectorXd read_mask(const MeshModel& layer, const LayerCloud& cloud, bool only_selected,
                          bool by_quality) {
  if (!only_selected && !by_quality) return {};
  const CMeshO& mesh = layer.cm;
  const auto count = static_cast<Index>(cloud.vertex.size());
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(count);
  if (only_selected) {
    const std::vector<char> selected = selected_vertices(mesh);
    for (Index i = 0; i < count; ++i) mask[i] = selected[cloud.vertex[i]] ? 1 : 0;
    if (mask.isZero(0)) throw InvalidInput("the layer " + quoted(layer) + " has nothing selected");
  }
  if (by_quality)
    for (Index i = 0; i < count; ++i) mask[i] *= mesh.vert[cloud.vertex[i]].cQ();
  return mask;
}

}  // namespace symsurf::meshlab
