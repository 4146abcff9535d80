#include <sstream>

#include "described.h"

// A class of macros, as VTK programmers write them: one member, one Set and one Get a parameter.

namespace symsurf::front_ends {

namespace {

const char* const notice = "// Made at build time from the descriptions in the core.\n";

std::string class_name(const Described& d) { return d.vtk_class + "Parameters"; }

std::string quoted(const std::string& text) { return '"' + text + '"'; }

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
      return "  std::string " + name + " = " + quoted(value) + ";\n";
    case ParameterType::Direction:
    case ParameterType::Position:
      return "  double " + name + "[3] = {" + components(parameter, ", ") + "};\n";
  }
  return {};
}

// How the core gets the value: through the public Get, whichever type that has.
std::string value_of(const Parameter& parameter, const std::string& name) {
  const std::string get = "filter->Get" + name + "()";
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

template <typename Visit>
void for_each_parameter(const Described& d, const Visit& visit) {
  for (const Choice& choice : d.choices)
    for (const Parameter& parameter : choice.parameters)
      visit(parameter, property_name(choice, parameter));
}

std::string selector_documentation(const Described& d) {
  std::string text = d.selector_doc;
  for (const Choice& choice : d.choices) text += "\n   * - " + choice.name + ": " + choice.summary;
  return text;
}

}  // namespace

std::string parameters_header(const Described& d) {
  const std::string name = class_name(d);
  std::ostringstream out;
  out << notice << "#ifndef " << name << "_h\n#define " << name << "_h\n\n"
      << "#include \"vtkPolyDataAlgorithm.h\"\n"
      << "#include \"vtkSymsurfFiltersModule.h\" // for the export macro\n\n"
      << "#include <string> // for the members\n\n"
      << "/**\n * @class " << name << "\n * @brief The parameters of " << d.vtk_class << ".\n */\n"
      << "class VTKSYMSURFFILTERS_EXPORT " << name << " : public vtkPolyDataAlgorithm {\n public:\n"
      << "  vtkTypeMacro(" << name << ", vtkPolyDataAlgorithm);\n"
      << "  void PrintSelf(ostream& os, vtkIndent indent) override;\n\n"
      << comment(selector_documentation(d)) << macros(ParameterType::Choice, d.selector)
      << "  ///@}\n\n";
  for_each_parameter(d, [&](const Parameter& parameter, const std::string& property) {
    out << comment(documentation(parameter)) << macros(parameter.type, property) << "  ///@}\n\n";
  });
  out << " protected:\n  " << name << "() = default;\n  ~" << name << "() override = default;\n\n"
      << "  std::string " << d.selector << " = " << quoted(d.choices.front().name) << ";\n";
  for_each_parameter(d, [&](const Parameter& parameter, const std::string& property) {
    out << member(parameter, property);
  });
  out << "\n private:\n  " << name << "(const " << name << "&) = delete;\n  void operator=(const "
      << name << "&) = delete;\n};\n\n#endif\n";
  return out.str();
}

std::string parameters_source(const Described& d) {
  const std::string name = class_name(d);
  std::ostringstream out;
  out << notice << "#include \"" << name << ".h\"\n#include \"chosen_parameters.h\"\n\n"
      << "void " << name << "::PrintSelf(ostream& os, vtkIndent indent) {\n"
      << "  this->Superclass::PrintSelf(os, indent);\n"
      << "  os << indent << \"" << d.selector << ": \" << this->" << d.selector << " << \"\\n\";\n";
  for_each_parameter(d, [&](const Parameter& parameter, const std::string& property) {
    out << "  os << indent << \"" << property << ": \" << ";
    if (parameter.default_value.index() == Value(Vector3()).index())
      for (int i = 0; i < 3; ++i)
        out << (i ? " << \" \" << " : "") << "this->" << property << "[" << i << "]";
    else
      out << "this->" << property;
    out << " << \"\\n\";\n";
  });
  out << "}\n\nsymsurf::Values chosen_parameters(" << name << "* filter) {\n"
      << "  const std::string chosen = filter->Get" << d.selector << "();\n";
  for (const Choice& choice : d.choices) {
    if (choice.parameters.empty()) continue;
    out << "  if (chosen == " << quoted(choice.name) << ")\n    return {\n";
    for (const Parameter& parameter : choice.parameters)
      out << "      { " << quoted(parameter.name) << ", "
          << value_of(parameter, property_name(choice, parameter)) << " },\n";
    out << "    };\n";
  }
  out << "  return {};\n}\n";
  return out.str();
}

}  // namespace symsurf::front_ends
