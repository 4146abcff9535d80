#include "ply_format.h"

#include <symsurf/context.h>

#include <cstdint>
#include <map>
#include <set>
#include <string_view>

#include "formats.h"

namespace symsurf {

namespace {

PlyHeader::Encoding encoding(TextScanner& text) {
  const std::string_view name = text.word(), version = text.word();
  if (version != "1.0") text.fail("PLY's version is " + in_quotes(version) + "; 1.0 can be read");
  if (name == "ascii") return PlyHeader::Encoding::Ascii;
  if (name == "binary_little_endian") return PlyHeader::Encoding::LittleEndian;
  if (name == "binary_big_endian") return PlyHeader::Encoding::BigEndian;
  text.fail("there is no PLY format " + in_quotes(name));
}

PlyType type(TextScanner& text, std::string_view name) {
  static const std::map<std::string_view, PlyType> types{
      {"char", PlyType::Int8},      {"int8", PlyType::Int8},       {"uchar", PlyType::UInt8},
      {"uint8", PlyType::UInt8},    {"short", PlyType::Int16},     {"int16", PlyType::Int16},
      {"ushort", PlyType::UInt16},  {"uint16", PlyType::UInt16},   {"int", PlyType::Int32},
      {"int32", PlyType::Int32},    {"uint", PlyType::UInt32},     {"uint32", PlyType::UInt32},
      {"float", PlyType::Float32},  {"float32", PlyType::Float32}, {"double", PlyType::Float64},
      {"float64", PlyType::Float64}};
  const auto it = types.find(name);
  if (it == types.end()) text.fail("PLY has no type " + in_quotes(name));
  return it->second;
}

PlyElement element(TextScanner& text) {
  const std::string name(text.word());
  if (name.empty()) text.fail("the element's name is missing");
  const Index count = text.integer("the count of the element " + in_quotes(name));
  if (count < 0) text.fail("the count of the element " + in_quotes(name) + " is below 0");
  return {name, count, {}};
}

PlyProperty property(TextScanner& text) {
  PlyProperty property;
  std::string_view word = text.word();
  if (word == "list") {
    property.length_type = type(text, text.word());
    if (*property.length_type == PlyType::Float32 || *property.length_type == PlyType::Float64)
      text.fail("a list's length cannot be a fraction");
    word = text.word();
  }
  property.type = type(text, word);
  property.name = text.word();
  if (property.name.empty()) text.fail("the property's name is missing");
  return property;
}

}  // namespace

PlyHeader read_ply_header(TextScanner& text) {
  if (!text.next_line() || text.word() != "ply")
    throw InvalidInput("this is no PLY file: it does not start with 'ply'");
  text.pass_over("comment");
  text.pass_over("obj_info");

  PlyHeader header;
  std::set<std::string> names;
  bool has_format = false;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "format") {
      header.encoding = encoding(text);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(element(text));
      const std::string& name = header.elements.back().name;
      if (!names.insert(name).second)
        text.fail("the element " + in_quotes(name) + " stands there twice");
    } else if (keyword == "property") {
      if (header.elements.empty()) text.fail("a property stands before any element");
      header.elements.back().properties.push_back(property(text));
    } else if (keyword == "end_header") {
      if (!has_format) text.fail("the header names no format");
      return header;
    } else {
      text.fail("PLY headers have no " + in_quotes(keyword));
    }
  }
  throw InvalidInput("the header is truncated: 'end_header' is missing");
}

namespace {

std::string truncated(const PlyElement& element, Index row) {
  return "the file is truncated: it ends at row " + std::to_string(row) + " of the " +
         std::to_string(element.count) + " of the element " + in_quotes(element.name);
}

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::UInt8:
      return 1;
    case PlyType::Int16:
    case PlyType::UInt16:
      return 2;
    case PlyType::Float64:
      return 8;
    default:
      return 4;
  }
}

}  // namespace

void PlyTextRows::begin(const PlyElement& element, Index row) {
  if (!text_.next_line()) throw InvalidInput(truncated(element, row));
  is_vertex_ = element.name == "vertex";
  first_line_ = text_.line_number();
}

const char* PlyBinaryRows::take(PlyType type) {
  const std::size_t size = size_of(type);
  if (bytes_.size() < size) throw InvalidInput(truncated(*element_, row_));
  const char* at = bytes_.data();
  bytes_.remove_prefix(size);
  return at;
}

double PlyBinaryRows::number(const PlyProperty& property, PlyType type) {
  const char* at = take(type);
  switch (type) {
    case PlyType::Int8:
      return load<std::int8_t>(at, order_);
    case PlyType::UInt8:
      return load<std::uint8_t>(at, order_);
    case PlyType::Int16:
      return load<std::int16_t>(at, order_);
    case PlyType::UInt16:
      return load<std::uint16_t>(at, order_);
    case PlyType::Int32:
      return load<std::int32_t>(at, order_);
    case PlyType::UInt32:
      return load<std::uint32_t>(at, order_);
    case PlyType::Float32:
      return load<float>(at, order_);
    case PlyType::Float64:
      return load<double>(at, order_);
  }
  fail(property.name + " has no type");
}

void PlyBinaryRows::fail(const std::string& reason) const {
  throw InvalidInput("row " + std::to_string(row_) + " of the element " +
                     in_quotes(element_->name) + ": " + reason);
}

}  // namespace symsurf
