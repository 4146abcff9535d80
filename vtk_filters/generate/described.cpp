#include "described.h"

#include <symsurf/method.h>

#include <cctype>
#include <stdexcept>

namespace symsurf::generate {

namespace {

std::string camel_case(const std::string& name) {
  std::string text;
  bool up = true;
  for (const char c : name) {
    if (c != '_') text += up ? static_cast<char>(std::toupper(c)) : c;
    up = c == '_';
  }
  return text;
}

Described mirror_detection() {
  Described d{"vtkMirrorDetection", "Method", "How the mirror is sought.", {}};
  for (const Method& method : methods())
    d.choices.push_back({method.name, method.summary, method.parameters});
  return d;
}

}  // namespace

Described described(const std::string& vtk_class) {
  std::string names;
  for (const Described& candidate : {mirror_detection()}) {
    if (candidate.vtk_class == vtk_class) return candidate;
    names += " " + candidate.vtk_class;
  }
  throw std::invalid_argument("there is no description of '" + vtk_class + "'; there are" + names);
}

std::string property_name(const Choice& choice, const Parameter& parameter) {
  return camel_case(choice.name) + camel_case(parameter.name);
}

std::string documentation(const Parameter& parameter) {
  std::string text = parameter.doc + " Allowed: " + parameter.range();
  if (parameter.unit == "diagonal")
    text += " times the diagonal of the bounding box";
  else if (!parameter.unit.empty())
    text += " " + parameter.unit;
  if (parameter.type == ParameterType::Direction || parameter.type == ParameterType::Position)
    text += "; (0, 0, 0) means not given";
  return text + ".";
}

}  // namespace symsurf::generate
