// SPDX-License-Identifier: GPL-3.0-or-later
#include "result_layers.h"

#include <algorithm>

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;
using MirrorHandle = std::shared_ptr<const Mirror>;

constexpr const char* mirror_attribute = "symsurf mirror";
constexpr int marked = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;

// Residuals below this share of the diagonal are rounding, which is not worth a colour.
constexpr double least_ramp = 1e-6;

MeshModel& add_layer(MeshDocument& document, const Matrix44m& transform, const QString& name,
                     const Points& points) {
  MeshModel& layer = *document.addNewMesh("", name, false);
  layer.cm.Tr = transform;
  auto vertex = Allocator::AddVertices(layer.cm, points.rows());
  for (Index i = 0; i < points.rows(); ++i, ++vertex)
    vertex->P() = Point3m(points(i, 0), points(i, 1), points(i, 2));
  return layer;
}

void colour_by_residual(MeshModel& layer, const Eigen::VectorXd& residuals) {
  const double largest = residuals.size() > 0 ? residuals.maxCoeff() : 0;
  const double top = std::max(largest, least_ramp * layer_diagonal(&layer));
  vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(layer.cm, 0, top);
  layer.updateDataMask(marked);
}

double sign(double x) { return (x > 0) - (x < 0); }

}  // namespace

MeshModel& add_mirror_layer(MeshDocument& document, const MeshModel& input,
                            std::shared_ptr<const Mirror> mirror, const Mesh& mesh) {
  MeshModel& layer = add_layer(document, input.cm.Tr, "Mirror", mesh.vertices);
  auto face = Allocator::AddFaces(layer.cm, mesh.triangles.rows());
  for (Index i = 0; i < mesh.triangles.rows(); ++i, ++face)
    for (int corner = 0; corner < 3; ++corner)
      face->V(corner) = &layer.cm.vert[mesh.triangles(i, corner)];
  Allocator::AddPerMeshAttribute<MirrorHandle>(layer.cm, mirror_attribute)() = std::move(mirror);
  layer.updateBoxAndNormals();
  return layer;
}

std::shared_ptr<const Mirror> mirror_of(const MeshModel& layer) {
  auto handle = Allocator::FindPerMeshAttribute<MirrorHandle>(layer.cm, mirror_attribute);
  return Allocator::IsValidHandle(layer.cm, handle) ? handle() : nullptr;
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

void mark_asymmetry(MeshModel& layer, const LayerCloud& cloud, const Result& result) {
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
  if (result.mirror)
    for (Index i = 0; i < cloud.points.rows(); ++i)
      side[cloud.vertex[i]] =
          sign(result.mirror->signed_distance(Vector3(cloud.points.row(i).transpose())));
  colour_by_residual(layer, result.residuals);
  for (CVertexO& vertex : mesh.vert)
    if (vertex.Q() < 0) vertex.C() = vcg::Color4b::Gray;
}

}  // namespace symsurf::meshlab
