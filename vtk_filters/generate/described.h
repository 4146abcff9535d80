#pragma once

#include <symsurf/operations.h>
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
  std::string vtk_class;   ///< "vtkMirrorDetection"
  std::string superclass;  ///< of its parameters, or of itself where it has none
  std::string selector;    ///< the property that chooses: "Method"; none for a class of one choice
  std::string selector_doc;
  std::string group;            ///< heading of its own parameters in ParaView's panel: "Search"
  std::vector<Choice> choices;  ///< the first is the default
  /// Of the filter that runs it: the whole class is made, not only its parameters.
  const Operation* operation = nullptr;
};

/// Throws std::invalid_argument, listing the classes there are.
Described described(const std::string& vtk_class);

/// "plane", "pair_distance" -> "PlanePairDistance": the property of one choice's parameter.
/// A choice without a name adds nothing: "max_angle" -> "MaxAngle".
std::string property_name(const Choice& choice, const Parameter& parameter);

/// The choices, each with its sentence.
std::string selector_documentation(const Described& described, const std::string& separator);

/// What a filter says about the array that names its mask.
std::string mask_documentation();

/// The three numbers of a vector's default value.
std::string components(const Parameter& parameter, const char* separator = " ");

/// The parameter's sentence, its unit and its range.
std::string documentation(const Parameter& parameter);

/// The header and the source of the class's parameters: a Set/Get pair each.
std::string parameters_header(const Described& described);
std::string parameters_source(const Described& described);

/// The header and the source of an operation's filter.
std::string operation_header(const Described& described);
std::string operation_source(const Described& described);

/// A template of server-manager XML with its marks filled in. @PARAMETERS@ gives way to the
/// properties with its whole line, @INPUT@ to the shape and what chooses the points of an image,
/// @FOUND_MIRROR@ to how a mirror is found first, @OTHER@ to the second of two shapes, and
/// @OUTPUTS@ and @COLOURS@ to an operation's;
/// @NAME@, @LABEL@ and @SUMMARY@ are its own.
std::string server_manager_xml(const Described& described, std::string text);

}  // namespace symsurf::front_ends
