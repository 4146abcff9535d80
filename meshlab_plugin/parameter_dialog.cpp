// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_dialog.h"

#include <symsurf/context.h>
#include <symsurf/placement.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace symsurf::meshlab {

namespace {

QString label(const Parameter& parameter) {
  QString text = QString::fromStdString(parameter.name).replace('_', ' ');
  text[0] = text[0].toUpper();
  return text;
}

QString tooltip(const Parameter& parameter) {
  std::string text = parameter.doc;
  if (parameter.type != ParameterType::Boolean && parameter.type != ParameterType::Choice) {
    text += " Allowed: " + parameter.range();
    if (parameter.unit == "diagonal")
      text += " of the diagonal";
    else if (!parameter.unit.empty())
      text += " " + parameter.unit;
    text += ".";
  }
  return QString::fromStdString(text).toHtmlEscaped();
}

bool is_share_of_diagonal(const Parameter& parameter) {
  return parameter.type == ParameterType::Real && parameter.unit == "diagonal";
}

int choice_index(const Parameter& parameter) {
  const auto& names = parameter.choices;
  const auto it =
      std::find(names.begin(), names.end(), std::get<std::string>(parameter.default_value));
  return static_cast<int>(it - names.begin());
}

QStringList choice_names(const Parameter& parameter) {
  QStringList names;
  for (const std::string& name : parameter.choices) names << QString::fromStdString(name);
  return names;
}

Point3m point(const Vector3& v) { return Point3m(v.x(), v.y(), v.z()); }

double shortest_decimal(double given, double unit) {
  // Percentages pass through three roundings to float.
  const double tolerance = 1.5 * std::numeric_limits<float>::epsilon() * std::abs(given);
  const double exact = given / unit;
  if (!std::isfinite(exact)) return exact;
  for (int digits = 1; digits <= std::numeric_limits<float>::digits10; ++digits) {
    std::stringstream text;
    text.imbue(std::locale::classic());
    text.precision(digits);
    text << exact;
    double decimal = exact;
    text >> decimal;
    if (std::abs(decimal * unit - given) <= tolerance) return decimal;
  }
  return exact;
}

Value read(const RichParameterList& dialog, const Parameter& parameter, double diagonal) {
  const QString name = QString::fromStdString(parameter.name);
  switch (parameter.type) {
    case ParameterType::Boolean:
      return dialog.getBool(name);
    case ParameterType::Integer:
      return static_cast<Index>(dialog.getInt(name));
    case ParameterType::Real:
      return is_share_of_diagonal(parameter) ? shortest_decimal(dialog.getAbsPerc(name), diagonal)
                                             : shortest_decimal(dialog.getFloat(name), 1);
    case ParameterType::Choice: {
      const int chosen = dialog.getEnum(name);
      if (chosen < 0 || chosen >= static_cast<int>(parameter.choices.size()))
        throw InvalidParameter(parameter.name + " is number " + std::to_string(chosen) +
                               " of the choices " + parameter.range());
      return parameter.choices[chosen];
    }
    case ParameterType::Direction:
    case ParameterType::Position: {
      const Point3m p = dialog.getPoint3m(name);
      return Vector3(p[0], p[1], p[2]);
    }
  }
  return parameter.default_value;
}

}  // namespace

Parameter only_selected_parameter() {
  return Parameter::boolean("only_selected", false,
                            "Use only the selected vertices and the corners of selected faces; "
                            "percentages are then of the diagonal of the selection.");
}

Parameter threads_parameter() {
  return Parameter::integer(
      "threads", 0, 0, std::numeric_limits<int>::max(), "",
      "Number of threads; 0: all of the machine. The result does not depend on it.");
}

void add_parameters(RichParameterList& dialog, const std::vector<Parameter>& described,
                    double diagonal) {
  for (const Parameter& parameter : described) {
    const QString name = QString::fromStdString(parameter.name);
    const QString shown = label(parameter), tip = tooltip(parameter);
    const Value& value = parameter.default_value;
    const bool advanced = placement(parameter.name).is_advanced;
    switch (parameter.type) {
      case ParameterType::Boolean:
        dialog.addParam(RichBool(name, std::get<bool>(value), shown, tip, advanced));
        break;
      case ParameterType::Integer:
        dialog.addParam(
            RichInt(name, static_cast<int>(std::get<Index>(value)), shown, tip, advanced));
        break;
      case ParameterType::Real:
        if (is_share_of_diagonal(parameter))
          dialog.addParam(RichPercentage(name, std::get<double>(value) * diagonal, 0, diagonal,
                                         shown, tip, advanced));
        else
          dialog.addParam(RichFloat(name, std::get<double>(value), shown, tip, advanced));
        break;
      case ParameterType::Choice:
        dialog.addParam(
            RichEnum(name, choice_index(parameter), choice_names(parameter), shown, tip, advanced));
        break;
      case ParameterType::Direction:
        dialog.addParam(RichDirection(name, point(std::get<Vector3>(value)), shown, tip, advanced));
        break;
      case ParameterType::Position:
        dialog.addParam(RichPosition(name, point(std::get<Vector3>(value)), shown, tip, advanced));
        break;
    }
  }
}

Values read_parameters(const RichParameterList& dialog, const std::vector<Parameter>& described,
                       double diagonal) {
  Values values;
  for (const Parameter& parameter : described)
    values[parameter.name] = read(dialog, parameter, diagonal);
  return values;
}

}  // namespace symsurf::meshlab
