// SPDX-License-Identifier: GPL-3.0-or-later
#include "operation_filter.h"

#include <symsurf/detect.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "changed_layer.h"
#include "mirror_layer.h"
#include "operation_mirror.h"
#include "parameter_dialog.h"
#include "result_layers.h"
#include "returned_values.h"
#include "vertex_marks.h"

namespace symsurf::meshlab {

namespace {

// Of the time that both take, finding the mirror takes so much.
constexpr double finding = 0.7;

}  // namespace

// "Mirror alignment" is apply_mirror_alignment.
std::string OperationFilter::python_name() const {
  std::string name = operation_.title;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char letter) {
    return letter == ' ' ? '_' : static_cast<char>(std::tolower(letter));
  });
  return (changes_shape() ? "apply_" : "compute_") + name;
}

std::string OperationFilter::info() const {
  std::string text = operation_.summary +
                     "<br>Uses the mirror of the <i>Mirror layer</i>. If this is the current layer "
                     "itself, or with <i>Find mirror</i>, the mirror is found first, as by "
                     "<i>Mirror auto</i>, and becomes a new layer.";
  if (operation_.moves_points)
    text += "<br>Moves the vertices of the current layer, and the layers of its mirror with them.";
  if (operation_.makes_shape) text += "<br>New vertices get their attributes from the former ones.";
  if (operation_.carries_values)
    text +=
        "<br>Vertices and faces stay; colours, quality and attributes of the vertices are copied. "
        "Vertices without a counterpart are selected.";
  for (const PointArray& array : operation_.face_arrays) text += "<br>Selects faces: " + array.doc;
  if (operation_.adds_points)
    text +=
        "<br>The vertices and faces of the current layer stay; those that are added are selected.";
  if (!operation_.arrays.empty()) text += "<br>Attributes of the vertices:";
  for (const PointArray& array : operation_.arrays)
    text += "<br><i>" + array.name + "</i>: " + array.doc;
  return text;
}

FilterPlugin::FilterClass OperationFilter::menus() const {
  if (operation_.carries_values)
    return FilterPlugin::FilterClass(FilterPlugin::Quality | FilterPlugin::VertexColoring);
  if (operation_.adds_points) return FilterPlugin::Remeshing;
  if (operation_.moves_points)
    return FilterPlugin::FilterClass(FilterPlugin::Normal | FilterPlugin::Smoothing);
  return FilterPlugin::Quality;
}

// With MM_VERTNUMBER among them MeshLab offers no preview, which could not take layers back.
int OperationFilter::changes() const {
  int changed = MeshModel::MM_VERTNUMBER;
  if (!changes_shape()) return changed | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;
  if (operation_.carries_values)
    return changed | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR |
           MeshModel::MM_VERTFLAGSELECT;
  changed |= MeshModel::MM_VERTCOORD | MeshModel::MM_VERTNORMAL | MeshModel::MM_FACENORMAL |
             MeshModel::MM_VERTFLAGSELECT;
  if (operation_.adds_points || operation_.makes_shape)
    changed |= MeshModel::MM_FACENUMBER | MeshModel::MM_FACEFLAGSELECT;
  return changed;
}

bool OperationFilter::takes_landmarks() const {
  return std::any_of(operation_.parameters.begin(), operation_.parameters.end(),
                     [](const Parameter& each) { return each.name == "pairing"; });
}

// What a host of layers, selections and qualities asks beside the operation's own parameters.
std::vector<Parameter> OperationFilter::own_parameters() const {
  std::vector<Parameter> described{Parameter::boolean(
      "find_mirror", false, "Find the mirror first, whatever layer is chosen for it.")};
  described.push_back(require_found_parameter());
  if (operation_.takes_mask) {
    described.push_back(Parameter::boolean(
        "only_selected", false, "Move only selected vertices and the corners of selected faces."));
    described.push_back(Parameter::boolean(
        "weigh_by_quality", false,
        "Move each vertex by its quality, 0 to 1, as a share of the full displacement."));
  }
  if (takes_landmarks())
    described.push_back(Parameter::real("landmarks_deviation", 0, 0, 1, "diagonal",
                                        "Standard deviation of placing the landmarks."));
  described.push_back(threads_parameter());
  return described;
}

RichParameterList OperationFilter::parameters(const MeshDocument& document) const {
  RichParameterList dialog;
  const MeshModel* layer = document.mm();
  const double diagonal = layer_diagonal(layer);
  const MeshModel* mirror = layer ? last_mirror_layer(document, *layer) : nullptr;
  if (!mirror) mirror = layer;
  add_mirror_choice(dialog, document, mirror ? mirror->id() : 0,
                    "A layer made by one of the mirror filters, or any layer whose vertices lie on "
                    "a plane or a sphere. The current layer itself: its mirror is found first.");
  if (operation_.takes_other) add_other_choice(dialog, document);
  if (takes_landmarks()) add_landmarks_choice(dialog, document);
  add_parameters(dialog, operation_.parameters, diagonal);
  add_parameters(dialog, own_parameters(), diagonal);
  return dialog;
}

Outcome OperationFilter::apply(const RichParameterList& parameters, MeshDocument& document,
                               const Context::Progress& progress) const {
  MeshModel& layer = current_layer(document);
  const double diagonal = layer_diagonal(&layer);
  const ParameterValues own(operation_.name, own_parameters(),
                            read_parameters(parameters, own_parameters(), diagonal));
  // Read in full before a mirror is searched for, which may take long.
  const Values values =
      ParameterValues(operation_.name, operation_.parameters,
                      read_parameters(parameters, operation_.parameters, diagonal))
          .all();
  MeshModel& holder = chosen_mirror_layer(parameters, document);
  const LayerCloud cloud = read_cloud(layer, false, false, true);
  OperationInput input{cloud.points, cloud.faces};
  if (operation_.takes_mask)
    input.mask =
        read_mask(layer, cloud, own.boolean("only_selected"), own.boolean("weigh_by_quality"));

  if (takes_landmarks()) {
    input.landmark_pairs = chosen_landmarks(parameters, document, layer);
    if (input.landmark_pairs.rows() > 0)
      input.landmark_pairs.col(6).setConstant(own.real("landmarks_deviation") * diagonal);
  }

  std::optional<LayerCloud> other;
  if (operation_.takes_other)
    if (const MeshModel& second = chosen_other_layer(parameters, document); &second != &layer)
      other = read_cloud(second, false, false, true);
  if (other) {
    input.other = other->points;
    input.other_faces = other->faces;
  }

  const Context context(progress, static_cast<int>(own.integer("threads")));
  const bool is_needed = !other && needs_mirror(operation_.name, values);
  const bool is_found_first = is_needed && (own.boolean("find_mirror") || &holder == &layer);
  std::optional<OperationMirror> mirror;
  if (is_found_first)
    mirror.emplace(cloud, own.boolean("require_found"), context.stage(0, finding));
  else if (is_needed)
    mirror.emplace(layer, holder, values);
  const OperationResult result = operate(operation_.name, input, mirror ? &**mirror : nullptr,
                                         values, context.stage(is_found_first ? finding : 0, 1));

  Outcome outcome{returned_values(result.statistics), logged_values(result.statistics)};
  if (mirror) {
    outcome.log.insert(outcome.log.begin(), mirror->log().begin(), mirror->log().end());
    outcome.values["mirror_layer"] = mirror->place(document, layer, result).id();
  }
  // Rows of the result are vertices then.
  vcg::tri::Allocator<CMeshO>::CompactEveryVector(layer.cm);
  if (changes_shape())
    change_layer(layer, result, {result, cloud.points, mirror ? &**mirror : nullptr, context});
  else
    show_as_quality(layer, result);
  add_attributes(layer, result);
  return outcome;
}

}  // namespace symsurf::meshlab
