// SPDX-License-Identifier: GPL-3.0-or-later
#include "reflection_filter.h"

#include <symsurf/context.h>
#include <vcg/complex/algorithms/clean.h>

#include "cloud_conversion.h"
#include "directions.h"
#include "mirror_layer.h"

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

// The layer of the mirror last found, which is the one most people mean.
int default_mirror_layer(const MeshDocument& document) {
  int id = document.mm() ? document.mm()->id() : 0;
  for (auto it = document.meshBegin(); it != document.meshEnd(); ++it)
    if (is_mirror_layer(*it)) id = it->id();
  return id;
}

// From one layer's coordinates to the mirror's.
Matrix44m from_layer(const MeshModel& mirror, const MeshModel& layer) {
  return vcg::Inverse(mirror.cm.Tr) * layer.cm.Tr;
}

// What has directions, in the mirror's coordinates, reflected over it.
Directions reflected(CMeshO& mesh, const Matrix44m& between, const Mirror& over,
                     const Points& points, const Context& context) {
  OperationResult into;  // a rigid motion is told as an alignment is
  Eigen::MatrixXd matrix(4, 4);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(i, j) = between.ElementAt(i, j);
  into.statistics["matrix"] = matrix;
  into.points = points;
  Directions directions(mesh);
  directions.carry({into, points, nullptr});
  directions.carry({over, points, context});
  return directions;
}

// The points where MeshLab shows them beside the mirror: from one layer's coordinates to another's.
Points in_coordinates_of(const MeshModel& mirror, const MeshModel& layer, const Points& points) {
  if (mirror.cm.Tr == layer.cm.Tr) return points;
  const Matrix44m between = from_layer(mirror, layer);
  Points moved(points.rows(), 3);
  for (Index i = 0; i < points.rows(); ++i) {
    const Point3m p = between * Point3m(points(i, 0), points(i, 1), points(i, 2));
    moved.row(i) << p[0], p[1], p[2];
  }
  return moved;
}

// Removes what has no image, with the faces and edges that hang on it.
void remove_vertices(CMeshO& mesh, const std::vector<char>& doomed) {
  const auto is_doomed = [&](const CVertexO* v) { return doomed[vcg::tri::Index(mesh, v)] != 0; };
  for (CFaceO& face : mesh.face)
    if (is_doomed(face.cV(0)) || is_doomed(face.cV(1)) || is_doomed(face.cV(2)))
      Allocator::DeleteFace(mesh, face);
  for (CEdgeO& edge : mesh.edge)
    if (is_doomed(edge.cV(0)) || is_doomed(edge.cV(1))) Allocator::DeleteEdge(mesh, edge);
  for (std::size_t i = 0; i < doomed.size(); ++i)
    if (doomed[i]) Allocator::DeleteVertex(mesh, mesh.vert[i]);
  Allocator::CompactEveryVector(mesh);
}

}  // namespace

std::string ReflectionFilter::info() const {
  return "Reflects the current layer over a mirror that was found before, into a new layer."
         "<br>Each vertex x becomes x + 2 (foot - x), where foot is the point of the mirror that x "
         "maps through; vertices without an image, and their faces, are left out. The orientation "
         "of faces is reversed, so that their fronts stay outside; a cloud's normals and "
         "attributes of "
         "three numbers are reflected.";
}

FilterPlugin::FilterClass ReflectionFilter::menus() const {
  return FilterPlugin::FilterClass(FilterPlugin::Normal | FilterPlugin::Layer);
}

RichParameterList ReflectionFilter::parameters(const MeshDocument& document) const {
  RichParameterList dialog;
  add_mirror_choice(dialog, document, default_mirror_layer(document),
                    "A layer made by one of the mirror filters, or any layer whose vertices lie on "
                    "a plane or a sphere.");
  return dialog;
}

Outcome ReflectionFilter::apply(const RichParameterList& parameters, MeshDocument& document,
                                const Context::Progress& progress) const {
  const Context context(progress);
  MeshModel& layer = current_layer(document);
  const MeshModel& mirror = chosen_mirror_layer(parameters, document);
  const std::shared_ptr<const Mirror> over = mirror_in(mirror);
  const Points points = in_coordinates_of(mirror, layer, read_cloud(layer, false, false).points);
  const Points images = over->reflect(points, context);
  std::vector<char> doomed(images.rows());
  Index left = 0;
  for (Index i = 0; i < images.rows(); ++i) {
    doomed[i] = !images.row(i).allFinite();
    left += !doomed[i];
  }
  if (left == 0) throw InvalidInput("no vertex of the layer has an image over this mirror");

  // The copy has no deleted vertices, so that its rows are those of the packed points.
  MeshModel& image = *document.addNewMesh(layer.cm, "Reflection");
  image.cm.Tr = mirror.cm.Tr;
  for (Index i = 0; i < images.rows(); ++i)
    image.cm.vert[i].P() = Point3m(images(i, 0), images(i, 1), images(i, 2));
  reflected(image.cm, from_layer(mirror, layer), *over, points, context).set(image.cm);
  if (left < images.rows()) remove_vertices(image.cm, doomed);
  vcg::tri::Clean<CMeshO>::FlipMesh(image.cm);
  for (const auto& [name, texture] : layer.getTextures()) image.addTexture(name, texture);
  image.updateBoxAndNormals();
  return {{{"reflection_layer", image.id()}, {"vertices", static_cast<int>(left)}},
          {std::to_string(left) + " of " + std::to_string(images.rows()) + " vertices mirrored"}};
}

}  // namespace symsurf::meshlab
