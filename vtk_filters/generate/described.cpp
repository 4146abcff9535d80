#include "described.h"

#include <symsurf/analyses.h>
#include <symsurf/detect.h>
#include <symsurf/synthetic.h>

#include <stdexcept>

#include "../operation_names.h"

namespace symsurf::front_ends {

namespace {

// Methods, generators, kinds of damage and analyses are described alike.
template <typename Descriptions>
std::vector<Choice> choices_from(const Descriptions& descriptions) {
  std::vector<Choice> choices;
  for (const auto& d : descriptions) choices.push_back({d.name, d.summary, d.parameters});
  return choices;
}

// "Mirror alignment" -> "Alignment".
std::string own_group(const Operation& operation) {
  return vtk_name(operation.title.substr(operation.title.rfind(' ') + 1));
}

std::vector<Described> all_described() {
  std::vector<Described> all{
      {"vtkMirrorDetection", "vtkSharedShapeAlgorithm", "Method", "How the mirror is sought.",
       "Search", choices_from(methods())},
      {"vtkMirrorSampleSource", "vtkShapeAlgorithm", "Generator", "How the points are made.",
       "Sample", choices_from(generators())},
      {"vtkPointDamage", "vtkShapeAlgorithm", "Damage", "What is done to the points.", "Damage",
       choices_from(damages())},
      {"vtkMirrorReflection", "vtkShapeAlgorithm", "", "", "", {}},
      {"vtkSymmetryAnalysis", "vtkSharedShapeAlgorithm", "Analysis", "Which symmetries are sought.",
       "Analysis", choices_from(analyses())},
  };
  for (const Operation& operation : operations())
    all.push_back({"vtk" + filter_name(operation),
                   "vtkMirrorOperation",
                   "",
                   "",
                   own_group(operation),
                   {{"", operation.summary, operation.parameters}},
                   &operation});
  return all;
}

}  // namespace

Described described(const std::string& vtk_class) {
  std::string names;
  for (const Described& candidate : all_described()) {
    if (candidate.vtk_class == vtk_class) return candidate;
    names += " " + candidate.vtk_class;
  }
  throw std::invalid_argument("there is no description of '" + vtk_class + "'; there are" + names);
}

std::string property_name(const Choice& choice, const Parameter& parameter) {
  return vtk_name(choice.name) + vtk_name(parameter.name);
}

std::string selector_documentation(const Described& d, const std::string& separator) {
  std::string text = d.selector_doc;
  for (const Choice& choice : d.choices) text += separator + choice.name + ": " + choice.summary;
  return text;
}

std::string mask_documentation() {
  return "The name of a point array, a value in [0, 1] each: how far the point may move. Empty, or "
         "None: all points may.";
}

std::string components(const Parameter& parameter, const char* separator) {
  const auto& vector = std::get<Vector3>(parameter.default_value);
  std::string text = to_string(Value(vector[0]));
  for (int i = 1; i < 3; ++i) text += separator + to_string(Value(vector[i]));
  return text;
}

std::string documentation(const Parameter& parameter) {
  std::string text = parameter.doc + " Allowed: " + parameter.range();
  if (parameter.unit == "diagonal")
    text += " times the diagonal of the bounding box";
  else if (!parameter.unit.empty())
    text += " " + parameter.unit;
  if (parameter.type == ParameterType::Direction && components(parameter) == "0 0 0")
    text += "; (0, 0, 0) means not given";
  return text + ".";
}

}  // namespace symsurf::front_ends
