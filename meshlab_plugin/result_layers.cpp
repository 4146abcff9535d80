// SPDX-License-Identifier: GPL-3.0-or-later
#include "result_layers.h"

#include <symsurf/mirror_through.h>

#include <algorithm>

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

// The mirror, and the vertices drawn for it: when they are moved it is no longer theirs.
struct DrawnMirror {
  std::shared_ptr<const Mirror> mirror;
  Points vertices;
};

constexpr const char* mirror_layer_name = "Mirror";
constexpr const char* mirror_attribute = "symsurf mirror";
constexpr int marked = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;

// Residuals below this share of the diagonal are rounding, which is not worth a colour.
constexpr double least_ramp = 1e-6;

Point3m point(const Points& points, Index row) {
  return Point3m(points(row, 0), points(row, 1), points(row, 2));
}

MeshModel& add_layer(MeshDocument& document, const Matrix44m& transform, const QString& name,
                     const Points& points) {
  MeshModel& layer = *document.addNewMesh("", name, false);
  layer.cm.Tr = transform;
  auto vertex = Allocator::AddVertices(layer.cm, points.rows());
  for (Index i = 0; i < points.rows(); ++i, ++vertex) vertex->P() = point(points, i);
  return layer;
}

void colour_by_residual(MeshModel& layer, const Eigen::VectorXd& residuals) {
  const double largest = residuals.size() > 0 ? residuals.maxCoeff() : 0;
  const double top = std::max(largest, least_ramp * layer_diagonal(&layer));
  vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(layer.cm, 0, top);
  layer.updateDataMask(marked);
}

bool is_as_drawn(const CMeshO& mesh, const Points& vertices) {
  if (mesh.vn != vertices.rows() || mesh.vert.size() != static_cast<std::size_t>(mesh.vn))
    return false;
  for (Index i = 0; i < vertices.rows(); ++i)
    if (mesh.vert[i].cP() != point(vertices, i)) return false;
  return true;
}

MeshModel& add_drawn_mirror(MeshDocument& document, const MeshModel& input, const QString& name,
                            std::shared_ptr<const Mirror> mirror, const Mesh& mesh) {
  MeshModel& layer = add_layer(document, input.cm.Tr, name, mesh.vertices);
  auto face = Allocator::AddFaces(layer.cm, mesh.triangles.rows());
  for (Index i = 0; i < mesh.triangles.rows(); ++i, ++face)
    for (int corner = 0; corner < 3; ++corner)
      face->V(corner) = &layer.cm.vert[mesh.triangles(i, corner)];
  Allocator::AddPerMeshAttribute<DrawnMirror>(layer.cm, mirror_attribute)() = {std::move(mirror),
                                                                               mesh.vertices};
  layer.updateBoxAndNormals();
  return layer;
}

double sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

MeshModel& add_mirror_layer(MeshDocument& document, const MeshModel& input,
                            std::shared_ptr<const Mirror> mirror, const Mesh& mesh) {
  return add_drawn_mirror(document, input, mirror_layer_name, std::move(mirror), mesh);
}

MeshModel& add_candidate_layer(MeshDocument& document, const MeshModel& input, std::size_t rank,
                               const Result& candidate, const Mesh& mesh) {
  const QString name =
      QString("Candidate mirror %1, score %2").arg(rank).arg(candidate.score, 0, 'f', 2);
  return add_drawn_mirror(document, input, name, candidate.mirror, mesh);
}

std::shared_ptr<const Mirror> mirror_of(const MeshModel& layer) {
  auto drawn = Allocator::FindPerMeshAttribute<DrawnMirror>(layer.cm, mirror_attribute);
  if (Allocator::IsValidHandle(layer.cm, drawn) && is_as_drawn(layer.cm, drawn().vertices))
    return drawn().mirror;
  if (layer.cm.vn == 0) return nullptr;
  return mirror_through(read_cloud(layer, false, false).points);
}

bool is_mirror_layer(const MeshModel& layer) {
  return layer.label().startsWith(mirror_layer_name) && layer.cm.fn > 0;
}

MeshModel& add_surface_points_layer(MeshDocument& document, const MeshModel& input,
                                    const Result& result) {
  MeshModel& layer = add_layer(document, input.cm.Tr, "Surface points", result.surface_points);
  for (Index i = 0; i < result.residuals.size(); ++i) layer.cm.vert[i].Q() = result.residuals[i];
  layer.updateBoxAndNormals();
  colour_by_residual(layer, result.residuals);
  return layer;
}

MeshModel& add_sample_layer(MeshDocument& document, const Sample& sample) {
  MeshModel& layer = add_layer(document, Matrix44m::Identity(), "Sample", sample.points);
  auto partner = Allocator::GetPerVertexAttribute<Scalarm>(layer.cm, "partner");
  for (Index i = 0; i < sample.points.rows(); ++i) partner[i] = -1;
  for (Index i = 0; i < sample.pairs.rows(); ++i) {
    partner[sample.pairs(i, 0)] = sample.pairs(i, 1);
    partner[sample.pairs(i, 1)] = sample.pairs(i, 0);
  }
  layer.updateBoxAndNormals();
  return layer;
}

void mark_asymmetry(MeshModel& layer, const LayerCloud& cloud, const Result& result,
                    const Eigen::VectorXd& distances) {
  CMeshO& mesh = layer.cm;
  auto partner = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "partner");
  auto side = Allocator::GetPerVertexAttribute<Scalarm>(mesh, "side");
  for (std::size_t i = 0; i < mesh.vert.size(); ++i) {
    mesh.vert[i].Q() = -1;
    partner[i] = -1;
    side[i] = 0;
  }
  for (Index i = 0; i < result.pairs.rows(); ++i) {
    const int vertex = cloud.vertex[result.pairs(i, 0)];
    mesh.vert[vertex].Q() = result.residuals[i];
    partner[vertex] = cloud.vertex[result.pairs(i, 1)];
  }
  for (Index i = 0; i < distances.size(); ++i)
    if (cloud.points.row(i).allFinite()) side[cloud.vertex[i]] = sign(distances[i]);
  colour_by_residual(layer, result.residuals);
  for (CVertexO& vertex : mesh.vert)
    if (vertex.Q() < 0) vertex.C() = vcg::Color4b::Gray;
}

}  // namespace symsurf::meshlab
