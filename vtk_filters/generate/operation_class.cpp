#include <sstream>

#include "../operation_names.h"
#include "class_parts.h"

// The filter of an operation: vtkMirrorOperation with the operation's parameters.

namespace symsurf::front_ends {

namespace {

const char* const mask = "MaskArray";

std::string array_list(const Described& d) {
  const auto listed = [&](const std::string& of, const std::vector<PointArray>& arrays) {
    std::string text;
    for (const PointArray& array : arrays)
      text += "\n * - " + array_name(*d.operation, array.name) + ": " + array.doc;
    return text.empty() ? text : of + " data:\n *" + text + "\n *\n * ";
  };
  return listed("Point", d.operation->arrays) + listed("Cell", d.operation->face_arrays);
}

std::string outputs_documentation(const Described& d) {
  if (!d.operation->adds_points) return "";
  return "Output 0 is the whole, output 1 what was added alone. ";
}

}  // namespace

std::string operation_header(const Described& d) {
  const std::string& name = d.vtk_class;
  const Operation& operation = *d.operation;
  std::ostringstream out;
  out << notice() << "#ifndef " << name << "_h\n#define " << name << "_h\n\n"
      << "#include \"vtkMirrorOperation.h\"\n"
      << "#include \"vtkSymsurfFiltersModule.h\" // for the export macro\n\n"
      << "#include <string> // for the members\n\n"
      << "/**\n * @class " << name << "\n * @brief " << operation.summary << "\n *\n * "
      << outputs_documentation(d) << array_list(d)
      << "The inputs and what is kept of them: see vtkMirrorOperation.\n */\n"
      << "class VTKSYMSURFFILTERS_EXPORT " << name << " : public vtkMirrorOperation {\n public:\n"
      << "  static " << name << "* New();\n  vtkTypeMacro(" << name << ", vtkMirrorOperation);\n"
      << "  void PrintSelf(ostream& os, vtkIndent indent) override;\n\n";
  if (operation.adds_points) out << "  enum OutputPorts { WHOLE = 0, PATCH = 1 };\n\n";
  out << accessors(d);
  if (operation.takes_mask) out << text_accessors(mask, mask_documentation());
  out << " protected:\n  " << name << "()";
  out << (operation.adds_points ? " { this->SetNumberOfOutputPorts(2); }\n  ~" : " = default;\n  ~")
      << name << "() override = default;\n\n"
      << "  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) "
         "override;\n\n"
      << members(d);
  if (operation.takes_mask) out << text_member(mask, "");
  out << "\n private:\n  " << name << "(const " << name << "&) = delete;\n  void operator=(const "
      << name << "&) = delete;\n};\n\n#endif\n";
  return out.str();
}

std::string operation_source(const Described& d) {
  const std::string& name = d.vtk_class;
  std::ostringstream out;
  out << notice() << "#include \"" << name << ".h\"\n#include \"run_operation.h\"\n"
      << "#include \"vtkObjectFactory.h\"\n\nvtkStandardNewMacro(" << name << ");\n\n"
      << "void " << name << "::PrintSelf(ostream& os, vtkIndent indent) {\n"
      << "  this->Superclass::PrintSelf(os, indent);\n"
      << printed(d);
  if (d.operation->takes_mask) out << printed_text(mask);
  out << "}\n\nint " << name << "::RequestData(vtkInformation*, vtkInformationVector** inputs,\n"
      << "    vtkInformationVector* outputs) {\n"
      << "  const OperationCall call{" << quoted(d.operation->name) << ", {\n"
      << values_of(d.choices.front(), "this") << "    }, "
      << (d.operation->takes_mask ? std::string("this->") + mask : "{}") << "};\n"
      << "  return run_operation(this, inputs, outputs, call);\n}\n";
  return out.str();
}

}  // namespace symsurf::front_ends
