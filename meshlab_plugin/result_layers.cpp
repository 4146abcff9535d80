// SPDX-License-Identifier: GPL-3.0-or-later
#include "result_layers.h"

#include "cloud_conversion.h"
#include "mirror_layer.h"
#include "vertex_marks.h"

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

// Which filter left a layer, for which other, under what name.
struct Origin {
  int input = -1;
  std::string filter;
  QString label;
};

constexpr const char* origin_attribute = "symsurf origin";

const Origin* origin_of(const MeshModel& layer) {
  auto origin = Allocator::FindPerMeshAttribute<Origin>(layer.cm, origin_attribute);
  return Allocator::IsValidHandle(layer.cm, origin) ? &origin() : nullptr;
}

void set_vertices(CMeshO& mesh, const Points& points) {
  auto vertex = Allocator::AddVertices(mesh, points.rows());
  for (Index i = 0; i < points.rows(); ++i, ++vertex) vertex->P() = to_point(points, i);
}

}  // namespace

ResultLayers::ResultLayers(MeshDocument& document, const MeshModel& input, std::string filter)
    : document_(document), input_(input), filter_(std::move(filter)) {
  std::vector<int> earlier;
  for (auto it = document.meshBegin(); it != document.meshEnd(); ++it) {
    const Origin* origin = origin_of(*it);
    if (origin && origin->input == input.id() && origin->filter == filter_ &&
        origin->label == it->label())
      earlier.push_back(it->id());
  }
  for (const int id : earlier) document.delMesh(id);
  if (!earlier.empty()) document.setCurrentMesh(input.id());
}

MeshModel& ResultLayers::add(const QString& name) {
  MeshModel& layer = *document_.addNewMesh("", name, false);
  layer.cm.Tr = input_.cm.Tr;
  Allocator::AddPerMeshAttribute<Origin>(layer.cm, origin_attribute)() = {input_.id(), filter_,
                                                                          layer.label()};
  return layer;
}

MeshModel& ResultLayers::add_mirror(std::shared_ptr<const Mirror> mirror, const Mesh& mesh) {
  MeshModel& layer = add(mirror_layer_name);
  draw_mirror(layer, std::move(mirror), mesh);
  return layer;
}

MeshModel& ResultLayers::add_candidate(std::size_t rank, const Result& candidate,
                                       const Mesh& mesh) {
  MeshModel& layer =
      add(QString("Candidate mirror %1, score %2").arg(rank).arg(candidate.score, 0, 'f', 2));
  draw_mirror(layer, candidate.mirror, mesh);
  return layer;
}

MeshModel& ResultLayers::add_plane(std::size_t number, const Plane& plane) {
  MeshModel& layer = add(QString("Symmetry plane %1").arg(number));
  draw_mirror(layer, std::make_shared<Plane>(plane), plane.mesh());
  return layer;
}

MeshModel& ResultLayers::add_axes(const AnalysisResult& result) {
  MeshModel& layer = add("Symmetry axes");
  Points ends(2 * static_cast<Index>(result.axes.size()), 3);
  Index row = 0;
  for (const SymmetryAxis& axis : result.axes)
    for (const Vector3& end : axis.segment(*result.footprint)) ends.row(row++) = end.transpose();
  set_vertices(layer.cm, ends);
  auto edge = Allocator::AddEdges(layer.cm, result.axes.size());
  for (std::size_t i = 0; i < result.axes.size(); ++i, ++edge) {
    edge->V(0) = &layer.cm.vert[2 * i];
    edge->V(1) = &layer.cm.vert[2 * i + 1];
  }
  layer.updateBoxAndNormals();
  return layer;
}

MeshModel& ResultLayers::add_surface_points(const Result& result) {
  MeshModel& layer = add("Surface points");
  set_vertices(layer.cm, result.surface_points);
  for (Index i = 0; i < result.residuals.size(); ++i) layer.cm.vert[i].Q() = result.residuals[i];
  layer.updateBoxAndNormals();
  colour_by_residual(layer, result.residuals);
  if (result.mirror) document_.setVisible(layer.id(), false);
  return layer;
}

bool is_result_of(const MeshModel& layer, const MeshModel& input) {
  const Origin* origin = origin_of(layer);
  return origin && origin->input == input.id();
}

const MeshModel* last_mirror_layer(const MeshDocument& document, const MeshModel& input) {
  const MeshModel* last = nullptr;
  for (auto it = document.meshBegin(); it != document.meshEnd(); ++it)
    if (is_mirror_layer(*it) && is_result_of(*it, input)) last = &*it;
  return last;
}

void move_results(MeshDocument& document, const MeshModel& input, const Matrix4& rigid) {
  for (auto it = document.meshBegin(); it != document.meshEnd(); ++it)
    if (is_result_of(*it, input) && it->cm.Tr == input.cm.Tr) move_layer(*it, rigid);
}

MeshModel& add_sample_layer(MeshDocument& document, const Sample& sample) {
  MeshModel& layer = *document.addNewMesh("", "Sample", false);
  set_vertices(layer.cm, sample.points);
  auto partner = Allocator::GetPerVertexAttribute<Scalarm>(layer.cm, "partner");
  for (Index i = 0; i < sample.points.rows(); ++i) partner[i] = -1;
  for (Index i = 0; i < sample.pairs.rows(); ++i) {
    partner[sample.pairs(i, 0)] = sample.pairs(i, 1);
    partner[sample.pairs(i, 1)] = sample.pairs(i, 0);
  }
  layer.updateBoxAndNormals();
  return layer;
}

}  // namespace symsurf::meshlab
