// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis_filter.h"

#include "cloud_conversion.h"
#include "mirror_layer.h"
#include "parameter_dialog.h"
#include "result_layers.h"
#include "returned_values.h"
#include "vertex_marks.h"

namespace symsurf::meshlab {

namespace {

// What every analysis takes beside its own parameters: the rest of analyse()'s arguments.
const std::vector<Parameter>& analysis_arguments() {
  static const std::vector<Parameter> described{
      only_selected_parameter(),
      Parameter::boolean("use_faces", true,
                         "Use the faces of the layer, if it has any; otherwise only its vertices."),
      threads_parameter(),
  };
  return described;
}

// The figures that MeshLab passes on, and the matrix of each transformation.
Values figures(const AnalysisResult& result) {
  Values all = result.statistics;
  all["planes"] = static_cast<Index>(result.planes.size());
  all["axes"] = static_cast<Index>(result.axes.size());
  all["transformations"] = static_cast<Index>(result.transformations.size());
  all["seconds"] = result.seconds;
  Index number = 0;
  for (const Transformation& each : result.transformations)
    all["matrix_" + std::to_string(number++)] = Eigen::MatrixXd(each.matrix);
  return all;
}

}  // namespace

std::string AnalysisFilter::info() const {
  std::string text = analysis_.summary;
  if (analysis_.finds_elements)
    text +=
        "<br>Each mirror plane becomes a new layer, which operations can use as a mirror; the axes "
        "of rotation become one layer of edges.";
  if (analysis_.finds_transforms)
    text +=
        "<br>The log lists the transformations that map the shape, or a part of it, onto another "
        "part.";
  if (!analysis_.arrays.empty()) text += "<br>Attributes of the vertices:";
  for (const PointArray& array : analysis_.arrays)
    text += "<br><i>" + array.name + "</i>: " + array.doc;
  return text;
}

FilterPlugin::FilterClass AnalysisFilter::menus() const { return FilterPlugin::PointSet; }

// With MM_VERTNUMBER among them MeshLab offers no preview, which could not take layers back.
int AnalysisFilter::changes() const {
  const int marks = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;
  return MeshModel::MM_VERTNUMBER | (analysis_.shown.empty() ? 0 : marks);
}

RichParameterList AnalysisFilter::parameters(const MeshDocument& document) const {
  RichParameterList dialog;
  const double diagonal = layer_diagonal(document.mm());
  if (analysis_.takes_other) add_other_choice(dialog, document);
  add_parameters(dialog, analysis_.parameters, diagonal);
  add_parameters(dialog, analysis_arguments(), diagonal);
  return dialog;
}

Outcome AnalysisFilter::apply(const RichParameterList& parameters, MeshDocument& document,
                              const Context::Progress& progress) const {
  MeshModel& layer = current_layer(document);
  const double diagonal = layer_diagonal(&layer);
  const ParameterValues given(analysis_.name, analysis_arguments(),
                              read_parameters(parameters, analysis_arguments(), diagonal));
  const LayerCloud cloud =
      read_cloud(layer, given.boolean("only_selected"), false, given.boolean("use_faces"));
  AnalysisOptions options;
  options.parameters = read_parameters(parameters, analysis_.parameters, diagonal);
  options.faces = cloud.faces;
  LayerCloud other;
  if (analysis_.takes_other) {
    other = read_cloud(chosen_other_layer(parameters, document), false, false,
                       given.boolean("use_faces"));
    options.other = other.points;
    options.other_faces = other.faces;
  }
  if (analysis_.takes_colours) options.colours = read_colours(layer, cloud);
  const Context context(progress, static_cast<int>(given.integer("threads")));
  const AnalysisResult result = analyse(analysis_.name, cloud.points, options, context);

  const Values values = figures(result);
  Outcome outcome{returned_values(values), logged_values(values)};
  for (const Transformation& each : result.transformations)
    outcome.log.push_back(each.kind + ", score " + to_string(Value(each.score)));
  mark_analysed(layer, cloud, result);
  ResultLayers layers(document, layer, python_name());
  for (std::size_t i = 0; i < result.planes.size(); ++i) layers.add_plane(i + 1, result.planes[i]);
  if (!result.axes.empty()) layers.add_axes(result);
  return outcome;
}

}  // namespace symsurf::meshlab
