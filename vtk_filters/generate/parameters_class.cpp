#include <sstream>

#include "class_parts.h"

// The superclass of a filter that is written by hand: its parameters.

namespace symsurf::front_ends {

namespace {

std::string class_name(const Described& d) { return d.vtk_class + "Parameters"; }

}  // namespace

std::string parameters_header(const Described& d) {
  const std::string name = class_name(d);
  std::ostringstream out;
  out << notice() << "#ifndef " << name << "_h\n#define " << name << "_h\n\n"
      << "#include \"" << d.superclass << ".h\"\n"
      << "#include \"vtkSymsurfFiltersModule.h\" // for the export macro\n\n"
      << "#include <string> // for the members\n\n"
      << "/**\n * @class " << name << "\n * @brief The parameters of " << d.vtk_class << ".\n */\n"
      << "class VTKSYMSURFFILTERS_EXPORT " << name << " : public " << d.superclass
      << " {\n public:\n"
      << "  vtkTypeMacro(" << name << ", " << d.superclass << ");\n"
      << "  void PrintSelf(ostream& os, vtkIndent indent) override;\n\n"
      << text_accessors(d.selector, selector_documentation(d, "\n   * - ")) << accessors(d)
      << " protected:\n  " << name << "() = default;\n  ~" << name << "() override = default;\n\n"
      << text_member(d.selector, d.choices.front().name) << members(d) << "\n private:\n  " << name
      << "(const " << name << "&) = delete;\n  void operator=(const " << name
      << "&) = delete;\n};\n\n#endif\n";
  return out.str();
}

std::string parameters_source(const Described& d) {
  const std::string name = class_name(d);
  std::ostringstream out;
  out << notice() << "#include \"" << name << ".h\"\n#include \"chosen_parameters.h\"\n\n"
      << "void " << name << "::PrintSelf(ostream& os, vtkIndent indent) {\n"
      << "  this->Superclass::PrintSelf(os, indent);\n"
      << printed_text(d.selector) << printed(d) << "}\n\nsymsurf::Values chosen_parameters(" << name
      << "* filter) {\n"
      << "  const std::string chosen = filter->Get" << d.selector << "();\n";
  for (const Choice& choice : d.choices)
    if (!choice.parameters.empty())
      out << "  if (chosen == " << quoted(choice.name) << ")\n    return {\n"
          << values_of(choice, "filter") << "    };\n";
  out << "  return {};\n}\n";
  return out.str();
}

}  // namespace symsurf::front_ends
