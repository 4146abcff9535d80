// SPDX-License-Identifier: GPL-3.0-or-later
#include "mirror_layer.h"

#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>

#include "cloud_conversion.h"

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

// The mirror, and the vertices drawn for it: when they are moved it is no longer theirs.
struct DrawnMirror {
  std::shared_ptr<const Mirror> mirror;
  Points vertices;
  std::shared_ptr<const Mirror> bent;
};

constexpr const char* drawn_mirror = "symsurf mirror";
constexpr const char *const mirror_layer = "mirror_layer", *const other_layer = "other_layer",
                            *const landmarks_layer = "landmarks_layer";

// Light blue: MeshLab's grey is hardly seen before its dark background.
const vcg::Color4b mirror_colour(170, 210, 255, 255);

// How much the scales of a transform along the axes may differ: single precision, some products of
// matrices long.
constexpr double equal_scales = 1e-5;

// Null where there is none, or its vertices are no longer those drawn.
const DrawnMirror* drawn_in(const MeshModel& layer) {
  const CMeshO& mesh = layer.cm;
  auto drawn = Allocator::FindPerMeshAttribute<DrawnMirror>(mesh, drawn_mirror);
  if (!Allocator::IsValidHandle(mesh, drawn)) return nullptr;
  const Points& vertices = drawn().vertices;
  if (mesh.vn != vertices.rows() || mesh.vert.size() != static_cast<std::size_t>(mesh.vn))
    return nullptr;
  for (Index i = 0; i < vertices.rows(); ++i)
    if (mesh.vert[i].cP() != to_point(vertices, i)) return nullptr;
  return &drawn();
}

Eigen::Affine3d affine(const Matrix44m& matrix) {
  Matrix4 entries;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) entries(row, column) = matrix[row][column];
  return Eigen::Affine3d(entries);
}

Points moved(const Eigen::Affine3d& transform, const Points& points) {
  return (points * transform.linear().transpose()).rowwise() + transform.translation().transpose();
}

// With what it is laid out over when a shape is straightened.
std::shared_ptr<const Mirror> moved(const Mirror& mirror, double scale, const Matrix3& rotation,
                                    const Vector3& shift) {
  std::shared_ptr<Mirror> result = mirror.transformed(scale, rotation, shift);
  if (const PointsView footprint = mirror.footprint(); !footprint.empty()) {
    Eigen::Affine3d transform(scale * rotation);
    transform.translation() = shift;
    result->set_footprint(std::make_shared<Points>(moved(transform, footprint.matrix())));
  }
  return result;
}

}  // namespace

void draw_mirror(MeshModel& layer, std::shared_ptr<const Mirror> mirror, const Mesh& mesh,
                 std::shared_ptr<const Mirror> bent) {
  CMeshO& drawn = layer.cm;
  drawn.Clear();
  auto vertex = Allocator::AddVertices(drawn, mesh.vertices.rows());
  for (Index i = 0; i < mesh.vertices.rows(); ++i, ++vertex)
    vertex->P() = to_point(mesh.vertices, i);
  auto face = Allocator::AddFaces(drawn, mesh.triangles.rows());
  for (Index i = 0; i < mesh.triangles.rows(); ++i, ++face)
    for (int corner = 0; corner < 3; ++corner)
      face->V(corner) = &drawn.vert[mesh.triangles(i, corner)];
  Allocator::GetPerMeshAttribute<DrawnMirror>(drawn, drawn_mirror)() = {
      std::move(mirror), mesh.vertices, std::move(bent)};
  layer.updateDataMask(MeshModel::MM_VERTCOLOR);
  for (CVertexO& each : drawn.vert) each.C() = mirror_colour;
  layer.updateBoxAndNormals();
}

std::shared_ptr<const Mirror> mirror_of(const MeshModel& layer) {
  if (const DrawnMirror* drawn = drawn_in(layer)) return drawn->mirror;
  if (layer.cm.vn == 0) return nullptr;
  return mirror_through(read_cloud(layer, false, false).points);
}

std::shared_ptr<const Mirror> mirror_in(const MeshModel& layer) {
  if (auto mirror = mirror_of(layer)) return mirror;
  throw InvalidParameter(
      "the layer '" + layer.label().toStdString() +
      "' holds no mirror: its vertices lie neither on a plane nor on a sphere, and a curved mirror "
      "must be as its filter left it; find the mirror again, or choose another layer");
}

std::shared_ptr<const Mirror> mirror_beside(const MeshModel& layer, const MeshModel& holder) {
  std::shared_ptr<const Mirror> mirror = mirror_in(holder);
  if (holder.cm.Tr == layer.cm.Tr) return mirror;
  const Eigen::Affine3d between = affine(layer.cm.Tr).inverse() * affine(holder.cm.Tr);
  Matrix3 rotation = Matrix3::Zero(), scaling = Matrix3::Zero();
  if (between.matrix().allFinite()) between.computeRotationScaling(&rotation, &scaling);
  const double scale = scaling.trace() / 3;
  if (!(scale > 0) || (scaling - scale * Matrix3::Identity()).norm() > equal_scales * scale)
    throw InvalidParameter(
        "the transforms of the layers '" + layer.label().toStdString() + "' and '" +
        holder.label().toStdString() +
        "' differ by more than a turn, a shift and a scaling; freeze them first");
  return moved(*mirror, scale, rotation, between.translation());
}

std::shared_ptr<const Mirror> bent_mirror_of(const MeshModel& layer) {
  const DrawnMirror* drawn = drawn_in(layer);
  return drawn ? drawn->bent : nullptr;
}

void move_layer(MeshModel& layer, const Matrix4& rigid) {
  const Eigen::Affine3d transform(rigid);
  Points points = read_cloud(layer, false, false).points;
  if (const DrawnMirror* drawn = drawn_in(layer)) {
    const auto along = [&](const std::shared_ptr<const Mirror>& mirror) {
      return mirror ? moved(*mirror, 1, transform.linear(), transform.translation()) : nullptr;
    };
    points = drawn->vertices;
    Allocator::GetPerMeshAttribute<DrawnMirror>(layer.cm, drawn_mirror)() = {
        along(drawn->mirror), moved(transform, points), along(drawn->bent)};
  }
  Allocator::CompactEveryVector(layer.cm);
  points = moved(transform, points);
  for (Index i = 0; i < points.rows(); ++i) layer.cm.vert[i].P() = to_point(points, i);
  layer.updateBoxAndNormals();
}

bool is_mirror_layer(const MeshModel& layer) {
  return layer.label().startsWith(mirror_layer_name) && layer.cm.fn > 0;
}

void add_mirror_choice(RichParameterList& dialog, const MeshDocument& document, int default_layer,
                       const QString& tooltip) {
  dialog.addParam(RichMesh(mirror_layer, default_layer, &document, "Mirror layer", tooltip));
}

void add_landmarks_choice(RichParameterList& dialog, const MeshDocument& document) {
  dialog.addParam(RichMesh(landmarks_layer, document.mm() ? document.mm()->id() : 0, &document,
                           "Landmarks layer",
                           "With homologous pairing: a layer of landmarks, of which each two "
                           "vertices that follow each other mirror each other. The current layer "
                           "itself is none."));
}

void add_other_choice(RichParameterList& dialog, const MeshDocument& document) {
  dialog.addParam(RichMesh(other_layer, document.mm() ? document.mm()->id() : 0, &document,
                           "Other layer",
                           "The second of two shapes of a pair, such as a right bone, in a pose of "
                           "its own. For the operations the current layer itself is none."));
}

namespace {

MeshModel& chosen_layer(const RichParameterList& dialog, MeshDocument& document, const char* name,
                        const char* use) {
  const auto id = static_cast<int>(dialog.getMeshId(name));
  for (auto it = document.meshBegin(); it != document.meshEnd(); ++it)
    if (it->id() == id) return *it;
  throw InvalidParameter("there is no layer " + std::to_string(id) + " to take " + use + " from");
}

}  // namespace

MeshModel& chosen_mirror_layer(const RichParameterList& dialog, MeshDocument& document) {
  return chosen_layer(dialog, document, mirror_layer, "the mirror");
}

Eigen::MatrixXd chosen_landmarks(const RichParameterList& dialog, MeshDocument& document,
                                 const MeshModel& layer) {
  const MeshModel& holder = chosen_layer(dialog, document, landmarks_layer, "the landmarks");
  if (&holder == &layer) return {};
  const Points own = read_cloud(holder, false, false).points;
  if (own.rows() % 2 != 0)
    throw InvalidInput("the layer of landmarks has " + std::to_string(own.rows()) +
                       " vertices; allowed are two for each pair");
  const Points points = moved(affine(layer.cm.Tr).inverse() * affine(holder.cm.Tr), own);
  Eigen::MatrixXd pairs = Eigen::MatrixXd::Zero(points.rows() / 2, 7);
  for (Index k = 0; k < pairs.rows(); ++k)
    pairs.row(k).head(6) << points.row(2 * k), points.row(2 * k + 1);
  return pairs;
}

MeshModel& chosen_other_layer(const RichParameterList& dialog, MeshDocument& document) {
  return chosen_layer(dialog, document, other_layer, "the second shape");
}

}  // namespace symsurf::meshlab
