#pragma once

#include <symsurf/points.h>

#include <optional>
#include <string>
#include <vector>

#include "text_scanner.h"

namespace symsurf {

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> length_type;  ///< lists only
};

struct PlyElement {
  std::string name;
  Index count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Encoding { Ascii, LittleEndian, BigEndian };

  Encoding encoding = Encoding::Ascii;
  std::vector<PlyElement> elements;
};

/// Reads up to and including the line "end_header". Throws InvalidInput.
PlyHeader read_ply_header(TextScanner& text);

}  // namespace symsurf
