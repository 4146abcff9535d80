#pragma once

#include <symsurf/points.h>

#include <bit>
#include <optional>
#include <string>
#include <string_view>
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

// The two ways a PLY file writes an element's rows. Both have
//   begin(element, row)  moves to the next row
//   number(property)     the next scalar of the row
//   skip(type)           passes over it
//   end()                the row is done
//   fail(reason)         throws InvalidInput, saying where

/// A row a line, or over several. A vertex may have more numbers in its line than the header names.
class PlyTextRows {
 public:
  explicit PlyTextRows(TextScanner& text) : text_(text) { text_.wrap_lines(); }

  void begin(const PlyElement& element, Index row);
  double number(const PlyProperty& property, PlyType) { return text_.number(property.name); }
  void skip(const PlyProperty& property, PlyType) {
    if (text_.line_ends()) text_.next_line();
    if (text_.word().empty()) fail(property.name + " is missing");
  }
  void end() {
    if (!text_.line_ends() && (!is_vertex_ || text_.line_number() != first_line_))
      fail("the row is longer than the header says");
  }
  [[noreturn]] void fail(const std::string& reason) const { text_.fail(reason); }

 private:
  TextScanner& text_;
  bool is_vertex_ = false;
  Index first_line_ = 0;
};

/// Numbers of fixed size, one after the other.
class PlyBinaryRows {
 public:
  PlyBinaryRows(std::string_view bytes, std::endian order) : bytes_(bytes), order_(order) {}

  void begin(const PlyElement& element, Index row) {
    element_ = &element;
    row_ = row;
  }
  double number(const PlyProperty&, PlyType type);
  void skip(const PlyProperty&, PlyType type) { take(type); }
  void end() {}
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  const char* take(PlyType type);

  std::string_view bytes_;
  std::endian order_;
  const PlyElement* element_ = nullptr;
  Index row_ = 0;
};

}  // namespace symsurf
