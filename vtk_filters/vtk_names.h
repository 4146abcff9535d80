#pragma once

#include <cctype>
#include <string>

/// "pair_distance" as VTK writes names: "PairDistance".
inline std::string vtk_name(const std::string& name) {
  std::string text;
  bool up = true;
  for (const char c : name) {
    if (c != '_') text += up ? static_cast<char>(std::toupper(c)) : c;
    up = c == '_';
  }
  return text;
}
