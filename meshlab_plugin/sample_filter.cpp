// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_filter.h"

#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <algorithm>

#include "cloud_conversion.h"
#include "parameter_dialog.h"
#include "result_layers.h"
#include "returned_values.h"

namespace symsurf::meshlab {

namespace {

// A parameter in the one dialog, and the generators that have it.
struct Entry {
  Parameter shown;
  std::map<std::string, std::string> name_in;  // generator -> the parameter's name there
};

bool alike(const Parameter& a, const Parameter& b) {
  return a.name == b.name && a.type == b.type && a.default_value == b.default_value &&
         a.range() == b.range();
}

// What generators describe alike is asked for once; what only shares its name gets the generator's
// in front.
std::vector<Entry> all_entries() {
  std::vector<Entry> entries;
  for (const Generator& generator : generators())
    for (const Parameter& parameter : generator.parameters) {
      auto same = std::find_if(entries.begin(), entries.end(),
                               [&](const Entry& e) { return alike(e.shown, parameter); });
      if (same == entries.end()) {
        same = entries.insert(entries.end(), Entry{parameter, {}});
        const bool taken = std::any_of(
            entries.begin(), same, [&](const Entry& e) { return e.shown.name == parameter.name; });
        if (taken) same->shown.name = generator.name + "_" + parameter.name;
      }
      same->name_in[generator.name] = parameter.name;
    }
  for (Entry& entry : entries) {
    std::string names;
    for (const auto& [generator, name] : entry.name_in)
      names += (names.empty() ? "" : ", ") + generator;
    entry.shown.doc = "For " + names + ": " + entry.shown.doc;
  }
  return entries;
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = all_entries();
  return all;
}

std::vector<Parameter> described() {
  std::vector<std::string> names;
  for (const Generator& generator : generators()) names.push_back(generator.name);
  std::vector<Parameter> parameters{
      Parameter::choice("generator", names.front(), names, "How the sample is made."),
      Parameter::boolean("use_current_layer", false,
                         "Mirror the current layer's vertices and not a sampled surface.")};
  for (const Entry& entry : entries()) parameters.push_back(entry.shown);
  return parameters;
}

Values for_generator(const std::string& generator, const ParameterValues& given) {
  Values values;
  for (const Entry& entry : entries())
    if (const auto it = entry.name_in.find(generator); it != entry.name_in.end())
      values[it->second] = given.all().at(entry.shown.name);
  return values;
}

const Generator& chosen_generator(const std::string& name) {
  return *std::find_if(generators().begin(), generators().end(),
                       [&](const Generator& g) { return g.name == name; });
}

}  // namespace

std::string SampleFilter::info() const {
  std::string text = "Makes points whose mirror is known, to try the mirror filters on.";
  for (const Generator& generator : generators())
    text += "<br><b>" + generator.name + "</b>: " + generator.summary;
  return text +
         "<br>The sample becomes the current layer, its points and then their images, with the "
         "attribute <i>partner</i>; the true mirror becomes a layer of its own.";
}

RichParameterList SampleFilter::parameters(const MeshDocument& document) const {
  RichParameterList dialog;
  add_parameters(dialog, described(), layer_diagonal(document.mm()));
  return dialog;
}

Outcome SampleFilter::apply(const RichParameterList& parameters, MeshDocument& document,
                            const Context::Progress& progress) const {
  const Context context(progress);
  const ParameterValues given(
      python_name(), described(),
      read_parameters(parameters, described(), layer_diagonal(document.mm())));
  const Generator& generator = chosen_generator(given.choice("generator"));
  LayerCloud cloud;
  if (given.boolean("use_current_layer")) {
    if (!generator.mirrors_points)
      throw InvalidParameter("use_current_layer is true; the generator '" + generator.name +
                             "' makes its points itself");
    cloud = read_cloud(current_layer(document), false, false);
  }
  context.report(0);
  const Sample sample =
      generate(generator.name, for_generator(generator.name, given), cloud.points);
  const Mesh mesh = sample.truth->mesh(sample.points);
  context.report(1);

  MeshModel& layer = add_sample_layer(document, sample);
  document.setCurrentMesh(layer.id());
  MeshModel& mirror = ResultLayers(document, layer, python_name()).add_mirror(sample.truth, mesh);
  Outcome outcome;
  for (const auto& [name, value] : sample.truth->numbers()) {
    outcome.log.push_back(name + ": " + to_string(value));
    if (const auto variant = to_variant(value)) outcome.values.emplace(name, *variant);
  }
  outcome.values["mirror_layer"] = mirror.id();
  outcome.values["sample_layer"] = layer.id();
  outcome.values["skipped"] = static_cast<int>(sample.skipped);
  return outcome;
}

}  // namespace symsurf::meshlab
