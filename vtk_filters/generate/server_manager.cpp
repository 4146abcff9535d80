#include <cmath>

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
                     const std::string& hints) {
  return "      <" + std::string(kind.element) + attribute("name", name) +
         attribute("command", "Set" + name) +
         attribute("number_of_elements", std::to_string(kind.elements)) +
         attribute("default_values", kind.default_values) + ">\n" + kind.domain +
         "        <Documentation>" + escaped(doc) + "</Documentation>\n" + hints + "      </" +
         kind.element + ">\n";
}

}  // namespace

std::string server_manager_properties(const Described& d) {
  std::vector<std::string> names;
  std::string doc = d.selector_doc;
  for (const Choice& choice : d.choices) {
    names.push_back(choice.name);
    doc += " " + choice.name + ": " + choice.summary;
  }
  std::string text =
      property(d.selector, {"StringVectorProperty", 1, names.front(), string_list(names)}, doc, "");
  for (const Choice& choice : d.choices)
    for (const Parameter& parameter : choice.parameters)
      text +=
          property(property_name(choice, parameter), kind_of(parameter), documentation(parameter),
                   "        <Hints>\n          <PropertyWidgetDecorator"
                   " type=\"GenericDecorator\" mode=\"visibility\"" +
                       attribute("property", d.selector) + attribute("value", choice.name) +
                       "/>\n        </Hints>\n");
  return text;
}

}  // namespace symsurf::front_ends
