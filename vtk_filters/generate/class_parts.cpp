#include "class_parts.h"

namespace symsurf::front_ends {

namespace {

std::string comment(const std::string& text) {
  return "  ///@{\n  /**\n   * " + text + "\n   */\n";
}

std::string macros(ParameterType type, const std::string& name) {
  const std::string of_type = "Macro(" + name + ", ";
  switch (type) {
    case ParameterType::Boolean:
      return "  vtkSet" + of_type + "bool);\n  vtkGet" + of_type + "bool);\n  vtkBoolean" +
             of_type + "bool);\n";
    case ParameterType::Integer:
      return "  vtkSet" + of_type + "int);\n  vtkGet" + of_type + "int);\n";
    case ParameterType::Real:
      return "  vtkSet" + of_type + "double);\n  vtkGet" + of_type + "double);\n";
    case ParameterType::Choice:
      return "  vtkSetStdStringFromCharMacro(" + name + ");\n  vtkGetCharFromStdStringMacro(" +
             name + ");\n";
    case ParameterType::Direction:
    case ParameterType::Position:
      return "  vtkSetVector3" + of_type + "double);\n  vtkGetVector3" + of_type + "double);\n";
  }
  return {};
}

std::string member(const Parameter& parameter, const std::string& name) {
  const std::string value = to_string(parameter.default_value);
  switch (parameter.type) {
    case ParameterType::Boolean:
      return "  bool " + name + " = " + value + ";\n";
    case ParameterType::Integer:
      return "  int " + name + " = " + value + ";\n";
    case ParameterType::Real:
      return "  double " + name + " = " + value + ";\n";
    case ParameterType::Choice:
      return text_member(name, value);
    case ParameterType::Direction:
    case ParameterType::Position:
      return "  double " + name + "[3] = {" + components(parameter, ", ") + "};\n";
  }
  return {};
}

// How the core gets the value: through the public Get, whichever type that has.
std::string value_of(const Parameter& parameter, const std::string& filter,
                     const std::string& name) {
  const std::string get = filter + "->Get" + name + "()";
  switch (parameter.type) {
    case ParameterType::Boolean:
    case ParameterType::Real:
      return get;
    case ParameterType::Integer:
      return "symsurf::Index(" + get + ")";
    case ParameterType::Choice:
      return "std::string(" + get + ")";
    case ParameterType::Direction:
    case ParameterType::Position:
      return "symsurf::Vector3(" + get + ")";
  }
  return {};
}

std::string printed_value(const Parameter& parameter, const std::string& name) {
  if (parameter.default_value.index() != Value(Vector3()).index()) return "this->" + name;
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i ? " << \" \" << this->" : "this->") + name + "[" + std::to_string(i) + "]";
  return text;
}

template <typename Part>
std::string of_each_parameter(const Described& d, const Part& part) {
  std::string text;
  for (const Choice& choice : d.choices)
    for (const Parameter& parameter : choice.parameters)
      text += part(parameter, property_name(choice, parameter));
  return text;
}

}  // namespace

std::string notice() { return "// Made at build time from the descriptions in the core.\n"; }

std::string quoted(const std::string& text) { return '"' + text + '"'; }

std::string text_accessors(const std::string& name, const std::string& doc) {
  return comment(doc) + macros(ParameterType::Choice, name) + "  ///@}\n\n";
}

std::string text_member(const std::string& name, const std::string& value) {
  return "  std::string " + name + " = " + quoted(value) + ";\n";
}

std::string accessors(const Described& d) {
  return of_each_parameter(d, [](const Parameter& parameter, const std::string& name) {
    return comment(documentation(parameter)) + macros(parameter.type, name) + "  ///@}\n\n";
  });
}

std::string members(const Described& d) { return of_each_parameter(d, member); }

std::string printed_text(const std::string& name) {
  return "  os << indent << \"" + name + ": \" << this->" + name + " << \"\\n\";\n";
}

std::string printed(const Described& d) {
  return of_each_parameter(d, [](const Parameter& parameter, const std::string& name) {
    return "  os << indent << \"" + name + ": \" << " + printed_value(parameter, name) +
           " << \"\\n\";\n";
  });
}

std::string values_of(const Choice& choice, const std::string& filter) {
  std::string text;
  for (const Parameter& parameter : choice.parameters)
    text += "      { " + quoted(parameter.name) + ", " +
            value_of(parameter, filter, property_name(choice, parameter)) + " },\n";
  return text;
}

}  // namespace symsurf::front_ends
