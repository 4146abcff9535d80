#pragma once

#include <symsurf/parameter.h>

#include <string>
#include <vector>

// What the front ends of this folder are made from: the core's descriptions, with the names that
// VTK and ParaView give them.

namespace symsurf::front_ends {

/// One thing a filter can be asked for (a method, a generator, a kind of damage).
struct Choice {
  std::string name;
  std::string summary;
  std::vector<Parameter> parameters;
};

/// A VTK class with a property that chooses and the properties of every choice.
struct Described {
  std::string vtk_class;  ///< "vtkMirrorDetection"
  std::string selector;   ///< the property that chooses: "Method"
  std::string selector_doc;
  std::vector<Choice> choices;  ///< the first is the default
};

/// Throws std::invalid_argument, listing the classes there are.
Described described(const std::string& vtk_class);

/// "plane", "pair_distance" -> "PlanePairDistance": the property of one choice's parameter.
std::string property_name(const Choice& choice, const Parameter& parameter);

/// The three numbers of a vector's default value.
std::string components(const Parameter& parameter, const char* separator = " ");

/// The parameter's sentence, its unit and its range.
std::string documentation(const Parameter& parameter);

/// The header and the source of the class's parameters: a Set/Get pair each.
std::string parameters_header(const Described& described);
std::string parameters_source(const Described& described);

/// The server-manager XML of the selector and the properties.
std::string server_manager_properties(const Described& described);

}  // namespace symsurf::front_ends
