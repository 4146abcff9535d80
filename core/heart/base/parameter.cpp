#include <symsurf/context.h>
#include <symsurf/parameter.h>
#include <symsurf/placement.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace symsurf {

namespace {

std::string number(double value) {
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::digits10);
  text << value;
  return text.str();
}

template <typename Items>
std::string join(const Items& items, const char* separator) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : separator) + item;
  return text;
}

}  // namespace

std::string_view to_string(ParameterType type) {
  switch (type) {
    case ParameterType::Boolean:
      return "boolean";
    case ParameterType::Integer:
      return "integer";
    case ParameterType::Real:
      return "real";
    case ParameterType::Choice:
      return "choice";
    case ParameterType::Direction:
      return "direction";
    case ParameterType::Position:
      return "position";
  }
  return "";
}

std::string to_string(const Value& value) {
  struct Text {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(Index v) const { return std::to_string(v); }
    std::string operator()(double v) const { return number(v); }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(const Vector3& v) const {
      std::string text = "(";
      text += number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()) + ")";
      return text;
    }
    std::string operator()(const Eigen::MatrixXd& v) const {
      return std::to_string(v.rows()) + " x " + std::to_string(v.cols()) + " numbers";
    }
  };
  return std::visit(Text{}, value);
}

Parameter Parameter::boolean(std::string name, bool value, std::string doc) {
  return {std::move(name), ParameterType::Boolean, "", value, 0, 0, {}, std::move(doc)};
}

Parameter Parameter::integer(std::string name, Index value, Index minimum, Index maximum,
                             std::string unit, std::string doc) {
  return {std::move(name),
          ParameterType::Integer,
          std::move(unit),
          value,
          static_cast<double>(minimum),
          static_cast<double>(maximum),
          {},
          std::move(doc)};
}

Parameter Parameter::real(std::string name, double value, double minimum, double maximum,
                          std::string unit, std::string doc) {
  return {std::move(name), ParameterType::Real, std::move(unit), value, minimum, maximum, {},
          std::move(doc)};
}

Parameter Parameter::choice(std::string name, std::string value, std::vector<std::string> choices,
                            std::string doc) {
  return {std::move(name),    ParameterType::Choice, "", std::move(value), 0, 0,
          std::move(choices), std::move(doc)};
}

Parameter Parameter::direction(std::string name, std::string doc) {
  return {std::move(name), ParameterType::Direction, "", Vector3(0, 0, 0), 0, 0, {},
          std::move(doc)};
}

Parameter Parameter::position(std::string name, std::string doc) {
  return {std::move(name), ParameterType::Position, "", Vector3(0, 0, 0), 0, 0, {}, std::move(doc)};
}

std::string Parameter::range() const {
  switch (type) {
    case ParameterType::Boolean:
      return "true | false";
    case ParameterType::Choice:
      return join(choices, " | ");
    case ParameterType::Direction:
    case ParameterType::Position:
      return "3 finite numbers";
    default: {
      std::string text = std::isinf(minimum) ? "(" : "[";
      text += number(minimum) + ", " + number(maximum) + (std::isinf(maximum) ? ")" : "]");
      return text;
    }
  }
}

std::string Parameter::allowed() const {
  return range() + (unit.empty() ? "" : unit == "diagonal" ? " of the diagonal" : " " + unit);
}

Value Parameter::checked(const Value& value) const {
  const auto fail = [&]() -> Value {
    throw InvalidParameter(name + " is " + to_string(value) + "; allowed is " +
                           std::string(to_string(type)) + " " + allowed());
  };
  const auto within = [&](double v) { return v >= minimum && v <= maximum; };
  switch (type) {
    case ParameterType::Boolean:
      return std::holds_alternative<bool>(value) ? value : fail();
    case ParameterType::Integer: {
      const Index* v = std::get_if<Index>(&value);
      return v && within(static_cast<double>(*v)) ? value : fail();
    }
    case ParameterType::Real: {
      const Index* whole = std::get_if<Index>(&value);
      const double* real = std::get_if<double>(&value);
      if (!whole && !real) return fail();
      const double v = real ? *real : static_cast<double>(*whole);
      return std::isfinite(v) && within(v) ? Value(v) : fail();
    }
    case ParameterType::Choice: {
      const std::string* v = std::get_if<std::string>(&value);
      return v && std::find(choices.begin(), choices.end(), *v) != choices.end() ? value : fail();
    }
    case ParameterType::Direction:
    case ParameterType::Position: {
      const Vector3* v = std::get_if<Vector3>(&value);
      return v && v->allFinite() ? value : fail();
    }
  }
  return fail();
}

ParameterValues::ParameterValues(std::string_view owner, const std::vector<Parameter>& described,
                                 const Values& given) {
  std::vector<std::string> names;
  for (const Parameter& parameter : described) {
    const auto it = given.find(parameter.name);
    values_[parameter.name] =
        parameter.checked(it == given.end() ? parameter.default_value : it->second);
    names.push_back(parameter.name);
  }
  for (const auto& [name, value] : given)
    if (!values_.count(name))
      throw InvalidParameter("'" + std::string(owner) + "' has no parameter '" + name +
                             "'; it has " + (names.empty() ? "none" : join(names, ", ")));
}

bool ParameterValues::boolean(const std::string& name) const {
  return std::get<bool>(values_.at(name));
}

Index ParameterValues::integer(const std::string& name) const {
  return std::get<Index>(values_.at(name));
}

double ParameterValues::real(const std::string& name) const {
  return std::get<double>(values_.at(name));
}

const std::string& ParameterValues::choice(const std::string& name) const {
  return std::get<std::string>(values_.at(name));
}

const Vector3& ParameterValues::vector(const std::string& name) const {
  return std::get<Vector3>(values_.at(name));
}

const Placement& placement(std::string_view parameter) {
  static constexpr Placement rare{"", true};
  static constexpr Placement pairs{"Pairs"};
  static constexpr Placement acceptance{"Acceptance"};
  static constexpr Placement counterparts{"Counterparts"};
  static constexpr Placement axis{"Axis", false, "symmetry", "axis"};
  static constexpr Placement computing{"Computing", true};

  static const std::map<std::string_view, Placement> placements{
      {"pairs", {"Pairs", true}},
      {"pair_distance", pairs},
      {"minimum_score", acceptance},
      {"tolerance", acceptance},
      {"require_found", rare},
      {"pairing", counterparts},
      {"one_to_one", counterparts},
      {"max_distance", counterparts},
      {"max_angle", counterparts},
      {"axis_point", axis},
      {"axis_direction", axis},
      {"axis_order", axis},
      // How much a search looks at: the defaults do for shapes of any size.
      {"sample_size", rare},
      {"max_candidates", rare},
      {"starts", rare},
      {"draws", rare},
      {"paired_points", rare},
      {"disc", rare},
      {"points", rare},
      {"localization", rare},
      {"power", rare},
      {"resolution", rare},
      {"functions", rare},
      {"seed", computing},
      {"threads", computing},
  };
  static const Placement usual;
  const auto found = placements.find(parameter);
  return found == placements.end() ? usual : found->second;
}

}  // namespace symsurf
