#include <symsurf/detect.h>
#include <symsurf/placement.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "../operation_names.h"
#include "described.h"

namespace symsurf::front_ends {

namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

std::string attribute(const char* name, const std::string& value) {
  return " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

std::string number_range(const char* domain, const Parameter& parameter) {
  std::string text = std::string("        <") + domain + " name=\"range\"";
  const auto bound = [&](double value) {
    return parameter.type == ParameterType::Integer ? to_string(Value(static_cast<Index>(value)))
                                                    : to_string(Value(value));
  };
  if (std::isfinite(parameter.minimum)) text += attribute("min", bound(parameter.minimum));
  if (std::isfinite(parameter.maximum)) text += attribute("max", bound(parameter.maximum));
  return text + "/>\n";
}

std::string string_list(const std::vector<std::string>& values) {
  std::string text = "        <StringListDomain name=\"list\">\n";
  for (const std::string& value : values)
    text += "          <String" + attribute("value", value) + "/>\n";
  return text + "        </StringListDomain>\n";
}

struct Kind {
  const char* element;
  int elements;
  std::string default_values;
  std::string domain;
};

Kind kind_of(const Parameter& parameter) {
  const std::string value = to_string(parameter.default_value);
  switch (parameter.type) {
    case ParameterType::Boolean:
      return {"IntVectorProperty", 1, value == "true" ? "1" : "0",
              "        <BooleanDomain name=\"bool\"/>\n"};
    case ParameterType::Integer:
      return {"IntVectorProperty", 1, value, number_range("IntRangeDomain", parameter)};
    case ParameterType::Real:
      return {"DoubleVectorProperty", 1, value, number_range("DoubleRangeDomain", parameter)};
    case ParameterType::Choice:
      return {"StringVectorProperty", 1, value, string_list(parameter.choices)};
    case ParameterType::Direction:
    case ParameterType::Position:
      return {"DoubleVectorProperty", 3, components(parameter),
              "        <DoubleRangeDomain name=\"range\"/>\n"};
  }
  return {};
}

std::string property(const std::string& name, const Kind& kind, const std::string& doc,
                     const std::string& hints, bool is_advanced = false) {
  return "      <" + std::string(kind.element) + attribute("name", name) +
         attribute("command", "Set" + name) +
         attribute("number_of_elements", std::to_string(kind.elements)) +
         attribute("default_values", kind.default_values) +
         (is_advanced ? attribute("panel_visibility", "advanced") : "") + ">\n" + kind.domain +
         "        <Documentation>" + escaped(doc) + "</Documentation>\n" + hints + "      </" +
         kind.element + ">\n";
}

std::string choice_property(const std::string& name, const std::vector<std::string>& values,
                            const std::string& doc) {
  return property(name, {"StringVectorProperty", 1, values.front(), string_list(values)}, doc, "");
}

std::string selector_property(const Described& d) {
  std::vector<std::string> names;
  for (const Choice& choice : d.choices) names.push_back(choice.name);
  // ParaView shows lines that begin with a hyphen as a list.
  std::string doc = selector_documentation(d, "\n- ");
  doc.insert(doc.find("\n- "), "\n");
  return choice_property(d.selector, names, doc);
}

std::string decorator(const std::string& property, const std::string& value) {
  return "          <PropertyWidgetDecorator type=\"GenericDecorator\" mode=\"visibility\"" +
         attribute("property", property) + attribute("value", value) + "/>\n";
}

// Shown while the choice that it belongs to is chosen, and while it counts.
std::string shown_for(const Described& d, const Choice& choice, const Placement& place) {
  std::string text;
  if (!d.selector.empty()) text += decorator(d.selector, choice.name);
  if (!place.condition.empty())
    text += decorator(vtk_name(choice.name) + vtk_name(std::string(place.condition)),
                      std::string(place.value));
  return text.empty() ? "" : "        <Hints>\n" + text + "        </Hints>\n";
}

std::string parameter_property(const Described& d, const Choice& choice,
                               const Parameter& parameter) {
  const Placement& place = placement(parameter.name);
  return property(property_name(choice, parameter), kind_of(parameter), documentation(parameter),
                  shown_for(d, choice, place), place.is_advanced);
}

// One of the input's point arrays, or None, which ParaView hands on as it is.
std::string mask_property() {
  const std::string arrays =
      "        <ArrayListDomain name=\"array_list\" attribute_type=\"Scalars\""
      " none_string=\"None\">\n          <RequiredProperties>\n"
      "            <Property name=\"Input\" function=\"Input\"/>\n"
      "          </RequiredProperties>\n        </ArrayListDomain>\n";
  return property("MaskArray", {"StringVectorProperty", 1, "None", arrays}, mask_documentation(),
                  "");
}

std::string property_group(const std::string& label, const std::vector<std::string>& names) {
  std::string text = "      <PropertyGroup" + attribute("label", label) + ">\n";
  for (const std::string& name : names)
    text += "        <Property" + attribute("name", name) + "/>\n";
  return text + "      </PropertyGroup>\n";
}

// Headings and what stands below each; the filter's own comes first.
std::string property_groups(const Described& d) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups{{d.group, {}}};
  if (!d.selector.empty()) groups[0].second.push_back(d.selector);
  const auto add = [&](const std::string& group, const std::string& name) {
    const auto found = std::find_if(groups.begin(), groups.end(),
                                    [&](const auto& each) { return each.first == group; });
    if (found == groups.end())
      groups.push_back({group, {name}});
    else
      found->second.push_back(name);
  };
  for (const Choice& choice : d.choices)
    for (const Parameter& parameter : choice.parameters) {
      const std::string group(placement(parameter.name).group);
      add(group.empty() ? d.group : group, property_name(choice, parameter));
    }
  if (d.operation && d.operation->takes_mask) add(d.group, "MaskArray");
  std::string text;
  for (const auto& [label, names] : groups)
    if (!names.empty()) text += property_group(label, names);
  return text;
}

std::string properties(const Described& d) {
  std::string text = d.selector.empty() ? "" : selector_property(d);
  for (const Choice& choice : d.choices)
    for (const Parameter& parameter : choice.parameters)
      text += parameter_property(d, choice, parameter);
  if (d.operation && d.operation->takes_mask) text += mask_property();
  return text + property_groups(d);
}

std::string found_mirror_properties() {
  std::vector<std::string> names;
  for (const Method& method : methods()) names.push_back(method.name);
  const Parameter& require_found = require_found_parameter();
  return choice_property("Method", names,
                         "How the mirror is found where none is connected. Mirror Detection has "
                         "the methods' parameters.") +
         property("RequireFound", kind_of(require_found), documentation(require_found), "", true);
}

// Points or a mesh beside the shape. `hint`: what else is said of when it is shown.
std::string further_input(const std::string& name, int port, const std::string& text,
                          const std::string& hint) {
  return R"(      <InputProperty name=")" + name +
         R"(" command="SetInputConnection" clean_command="Remove)" + name + R"("
                     port_index=")" +
         std::to_string(port) + R"(" panel_widget="input_selector">
        <ProxyGroupDomain name="groups">
          <Group name="sources"/>
          <Group name="filters"/>
        </ProxyGroupDomain>
        <DataTypeDomain name="input_type">
          <DataType value="vtkPolyData"/>
        </DataTypeDomain>
        <Documentation>)" +
         text + R"(</Documentation>
        <Hints>
          <Optional/>
)" + hint +
         R"(        </Hints>
      </InputProperty>
)";
}

std::string other_input(int port, const std::string& hint) {
  return further_input(
      "Other", port,
      "The second of two shapes of a pair, such as a right bone, in a pose of its own.", hint);
}

std::string landmarks_input(const Operation& operation) {
  for (const Parameter& parameter : operation.parameters)
    if (parameter.name == "pairing")
      return further_input("Landmarks", 3,
                           "With homologous pairing: points of which each two that follow each "
                           "other mirror each other. Their array Deviation, or else 0, is the "
                           "standard deviation of placing the two.",
                           "");
  return "";
}

// What vtkShapeAlgorithm takes, and how it takes an image.
const char* const shape_input =
    R"(      <InputProperty name="Input" command="SetInputConnection" port_index="0">
        <ProxyGroupDomain name="groups">
          <Group name="sources"/>
          <Group name="filters"/>
        </ProxyGroupDomain>
        <DataTypeDomain name="input_type">
          <DataType value="vtkPointSet"/>
          <DataType value="vtkImageData"/>
          <DataType value="vtkRectilinearGrid"/>
        </DataTypeDomain>
        <InputArrayDomain name="input_array" attribute_type="point" number_of_components="1"
                          optional="1"/>
        <InputArrayDomain name="any_array" attribute_type="point" optional="1"/>
        <Documentation>
          The shape: a mesh or a bare set of points; of other grids their surface, of an image the
          points above ImageThreshold, of a multiblock all blocks together.
        </Documentation>
      </InputProperty>
      <StringVectorProperty name="ImageScalars" command="SetInputArrayToProcess"
                            number_of_elements="5" element_types="0 0 0 0 2">
        <ArrayListDomain name="array_list" attribute_type="Scalars">
          <RequiredProperties>
            <Property name="Input" function="Input"/>
          </RequiredProperties>
        </ArrayListDomain>
        <Documentation>Of an image: the array that says which points are the shape.</Documentation>
        <Hints>
          <PropertyWidgetDecorator type="InputDataTypeDecorator" mode="visibility"
                                   name="vtkImageData vtkRectilinearGrid"/>
        </Hints>
      </StringVectorProperty>
      <DoubleVectorProperty name="ImageThreshold" command="SetImageThreshold"
                            number_of_elements="1" default_values="0.5">
        <ArrayRangeDomain name="range" default_mode="mid">
          <RequiredProperties>
            <Property name="Input" function="Input"/>
            <Property name="ImageScalars" function="ArraySelection"/>
          </RequiredProperties>
        </ArrayRangeDomain>
        <Documentation>
          Of an image: the points whose scalar is greater are the shape. The middle of their range
          initially.
        </Documentation>
        <Hints>
          <PropertyWidgetDecorator type="InputDataTypeDecorator" mode="visibility"
                                   name="vtkImageData vtkRectilinearGrid"/>
        </Hints>
      </DoubleVectorProperty>
      <PropertyGroup label="Image">
        <Property name="ImageScalars"/>
        <Property name="ImageThreshold"/>
      </PropertyGroup>
)";

// "Mirror asymmetry" -> "Mirror Asymmetry", as ParaView writes its menus.
std::string label_of(const Operation& operation) {
  std::string label = operation.title;
  for (std::size_t i = 1; i < label.size(); ++i)
    if (label[i - 1] == ' ') label[i] = static_cast<char>(std::toupper(label[i]));
  return label;
}

std::string output_ports(const Operation& operation) {
  if (!operation.adds_points) return "";
  return "      <OutputPort index=\"0\" name=\"Whole\"/>\n"
         "      <OutputPort index=\"1\" name=\"Patch\"/>\n";
}

// "Signed asymmetry"
std::string legend_title(const Operation& operation, const PointArray& array) {
  std::string text = array.name + operation.title.substr(operation.title.rfind(' '));
  text[0] = static_cast<char>(std::toupper(text[0]));
  return text;
}

// For vtkSMColourRangesProxy.
std::string colour_ranges(const Operation& operation) {
  std::string text;
  for (const PointArray& array : operation.arrays)
    if (array.is_signed)
      text += "        <ColourRange" + attribute("array", array_name(operation, array.name)) +
              attribute("limit", "P99") + attribute("signed", "1") +
              attribute("title", legend_title(operation, array)) + "/>\n";
  return text;
}

void fill_line(std::string& text, const std::string& mark, const std::string& lines) {
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return;
  const std::size_t begin = text.rfind('\n', at) + 1;
  text.replace(begin, text.find('\n', at) + 1 - begin, lines);
}

void fill(std::string& text, const std::string& mark, const std::string& value) {
  for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos; at += value.size())
    text.replace(at, mark.size(), value);
}

}  // namespace

std::string server_manager_xml(const Described& d, std::string text) {
  if (!d.choices.empty() && text.find("@PARAMETERS@") == std::string::npos)
    throw std::invalid_argument("the template for " + d.vtk_class + " has no @PARAMETERS@");
  fill_line(text, "@INPUT@", shape_input);
  fill_line(text, "@PARAMETERS@", properties(d));
  fill_line(text, "@FOUND_MIRROR@", found_mirror_properties());
  fill_line(
      text, "@OTHER@",
      !d.operation
          ? other_input(
                1, R"(          <PropertyWidgetDecorator type="GenericDecorator" mode="visibility"
                                   property="Analysis" value="match_pair"/>
)")
      : d.operation->takes_other ? other_input(2, "")
                                 : "");
  if (!d.operation) return text;
  fill_line(text, "@LANDMARKS@", landmarks_input(*d.operation));
  fill_line(text, "@OUTPUTS@", output_ports(*d.operation));
  fill_line(text, "@COLOURS@", colour_ranges(*d.operation));
  fill(text, "@NAME@", filter_name(*d.operation));
  fill(text, "@LABEL@", label_of(*d.operation));
  fill(text, "@SUMMARY@", escaped(d.operation->summary));
  return text;
}

}  // namespace symsurf::front_ends
