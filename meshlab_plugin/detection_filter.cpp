// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection_filter.h"

#include <symsurf/detect.h>

#include <limits>

#include "cloud_conversion.h"
#include "parameter_dialog.h"
#include "result_layers.h"
#include "returned_values.h"
#include "vertex_marks.h"

namespace symsurf::meshlab {

namespace {

// What every method takes beside its own parameters: the rest of detect()'s arguments.
const std::vector<Parameter>& common_parameters() {
  static const std::vector<Parameter> described{
      only_selected_parameter(),
      Parameter::boolean(
          "use_normals", false,
          "Pass the vertex normals of the layer to the method, in place of estimates."),
      Parameter::boolean(
          "use_faces", true,
          "Search with samples spread evenly over the faces of the layer, if it has any; "
          "otherwise with its vertices."),
      Parameter::boolean("show_candidates", false,
                         "Add a layer for each of the other mirrors that were found."),
      Parameter::integer("seed", 0, 0, std::numeric_limits<int>::max(), "",
                         "Random seed, for randomized methods."),
      threads_parameter(),
  };
  return described;
}

}  // namespace

std::string DetectionFilter::info() const {
  return method_.summary +
         "<br>Adds the mirror and the surface points (midpoints of the pairs) as layers, in place "
         "of those of an earlier run on the current layer. The vertices of the current layer get "
         "the distance from image to partner as quality, coloured from blue (0) to red, and the "
         "attributes <i>partner</i> and <i>side</i>; vertices without a partner are grey. The log "
         "has the verdict and its reason, the score from 0 (no symmetry) to 1 (exact), and the "
         "numbers of the mirror, in the coordinates of the layer.";
}

FilterPlugin::FilterClass DetectionFilter::menus() const {
  return FilterPlugin::FilterClass(FilterPlugin::Quality | FilterPlugin::PointSet);
}

// With MM_VERTNUMBER among them MeshLab offers no preview, which could not take layers back.
int DetectionFilter::changes() const {
  return MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTNUMBER;
}

RichParameterList DetectionFilter::parameters(const MeshDocument& document) const {
  RichParameterList dialog;
  const double diagonal = layer_diagonal(document.mm());
  add_parameters(dialog, method_.parameters, diagonal);
  add_parameters(dialog, common_parameters(), diagonal);
  return dialog;
}

Outcome DetectionFilter::apply(const RichParameterList& parameters, MeshDocument& document,
                               const Context::Progress& progress) const {
  MeshModel& layer = current_layer(document);
  const double diagonal = layer_diagonal(&layer);
  const ParameterValues given(method_.name, common_parameters(),
                              read_parameters(parameters, common_parameters(), diagonal));
  Options options;
  options.method = method_.name;
  options.parameters = read_parameters(parameters, method_.parameters, diagonal);
  options.seed = given.integer("seed");
  const LayerCloud cloud = read_cloud(layer, given.boolean("only_selected"),
                                      given.boolean("use_normals"), given.boolean("use_faces"));
  options.normals = cloud.normals;
  options.faces = cloud.faces;

  const Context context(progress, static_cast<int>(given.integer("threads")));
  const Result result = detect(cloud.points, options, context.stage(0, 0.95));
  Eigen::VectorXd distances;
  if (result.mirror)
    distances = result.mirror->signed_distance(cloud.points, context.stage(0.95, 1));
  const Mesh mesh = result.mirror ? result.mirror->mesh() : Mesh();
  std::vector<Mesh> candidate_meshes;
  if (given.boolean("show_candidates"))
    for (const Result& candidate : result.candidates)
      candidate_meshes.push_back(candidate.mirror->mesh());

  Outcome outcome{returned_values(result), logged_values(result)};
  const auto nonfinite = result.statistics.find("nonfinite_points");
  if (nonfinite != result.statistics.end())
    outcome.log.push_back("warning: " + to_string(nonfinite->second) +
                          " vertices are not finite and were left out; they have no partners");
  mark_residuals(layer, cloud, result, distances);
  ResultLayers layers(document, layer, python_name());
  if (result.mirror) outcome.values["mirror_layer"] = layers.add_mirror(result.mirror, mesh).id();
  if (result.surface_points.rows() > 0)
    outcome.values["surface_points_layer"] = layers.add_surface_points(result).id();
  for (std::size_t i = 0; i < candidate_meshes.size(); ++i)
    layers.add_candidate(i + 1, result.candidates[i], candidate_meshes[i]);
  return outcome;
}

}  // namespace symsurf::meshlab
