#pragma once

#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace symsurf {

/// Prints a case as Python where SYMSURF_FUZZ_SHOW is set: what a finding's bytes stand for.
inline void show(const std::string& name, const std::string& text) {
  if (std::getenv("SYMSURF_FUZZ_SHOW"))
    std::fprintf(stderr, "%s = %s\n", name.c_str(), text.c_str());
}

template <typename Table>
void show_rows(const std::string& name, const Table& table) {
  std::string text = "numpy.array([";
  for (Index i = 0; i < table.rows(); ++i) {
    text += i > 0 ? ", [" : "[";
    for (Index k = 0; k < table.cols(); ++k) {
      char number[32];
      std::snprintf(number, sizeof number, "%.17g", static_cast<double>(table(i, k)));
      text += (k > 0 ? ", " : "") + std::string(number);
    }
    text += "]";
  }
  show(name, text + "])");
}

inline void show(const std::string& name, const Values& values) {
  for (const auto& [key, value] : values) {
    const std::string item = name + "[\"" + key + "\"]";
    if (const auto* table = std::get_if<Eigen::MatrixXd>(&value))
      show_rows(item, *table);
    else if (const auto* three = std::get_if<Vector3>(&value))
      show_rows(item, three->transpose());
    else if (const auto* real = std::get_if<double>(&value))
      show_rows(item, Eigen::MatrixXd::Constant(1, 1, *real));
    else
      show(item, '"' + to_string(value) + '"');
  }
}

}  // namespace symsurf
