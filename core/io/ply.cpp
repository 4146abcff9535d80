#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "formats.h"

namespace symsurf {

namespace {

template <typename Rows>
Index integer(Rows& rows, const PlyProperty& property, PlyType type) {
  constexpr double largest = 0x1p53;
  const double value = rows.number(property, type);
  if (!(value >= -largest && value <= largest) || value != std::floor(value))
    rows.fail(property.name + " holds " + to_string(Value(value)) + ", not an index");
  return static_cast<Index>(value);
}

template <typename Rows>
Index list_length(Rows& rows, const PlyProperty& property) {
  const Index length = integer(rows, property, *property.length_type);
  if (length < 0) rows.fail("the list " + property.name + " has a length below 0");
  return length;
}

template <typename Rows>
void skip(Rows& rows, const PlyProperty& property) {
  const Index length = property.length_type ? list_length(rows, property) : 1;
  for (Index i = 0; i < length; ++i) rows.skip(property, property.type);
}

// Calls read(property number) for every property of every row; read says whether it took it.
template <typename Rows, typename Read, typename End>
void each_row(Rows& rows, const PlyElement& element, const Read& read, const End& end_row) {
  if (element.properties.empty()) return;
  for (Index row = 0; row < element.count; ++row) {
    rows.begin(element, row);
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (!read(p)) skip(rows, element.properties[p]);
    rows.end();
    end_row();
  }
}

template <typename Rows>
void read_vertices(Rows& rows, const PlyElement& element, ShapeBuilder& shape) {
  constexpr std::array<std::string_view, 9> names{"x",  "y",   "z",     "nx",  "ny",
                                                  "nz", "red", "green", "blue"};
  std::vector<int> position(element.properties.size(), -1);
  int named = 0;  // a bit a name
  for (std::size_t p = 0; p < position.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    const auto it = std::find(names.begin(), names.end(), property.name);
    if (it == names.end() || property.length_type) continue;
    position[p] = static_cast<int>(it - names.begin());
    named |= 1 << position[p];
  }
  if ((named & 7) != 7) throw InvalidInput("the element 'vertex' lacks x, y or z");
  const bool has_normals = (named & 56) == 56, has_colours = (named & 448) == 448;
  for (int& p : position)
    if ((p >= 3 && p < 6 && !has_normals) || (p >= 6 && !has_colours)) p = -1;

  std::array<double, 9> values;
  each_row(
      rows, element,
      [&](std::size_t p) {
        if (position[p] >= 0)
          values[position[p]] = rows.number(element.properties[p], element.properties[p].type);
        return position[p] >= 0;
      },
      [&] {
        shape.add_point({values[0], values[1], values[2]});
        if (has_normals) shape.add_normal({values[3], values[4], values[5]});
        if (has_colours) shape.add_colour(Vector3(values[6], values[7], values[8]));
      });
}

bool is_polygon(const PlyProperty& property) {
  return property.length_type &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

// Triangles that each share an edge with the one before, in strips that end with -1.
template <typename Rows>
void read_strips(Rows& rows, const PlyElement& element, Index vertices, ShapeBuilder& shape) {
  std::array<Index, 3> corners{};
  each_row(
      rows, element,
      [&](std::size_t p) {
        const PlyProperty& property = element.properties[p];
        if (!is_polygon(property)) return false;
        Index in_strip = 0;
        for (Index left = list_length(rows, property); left > 0; --left) {
          const Index corner = integer(rows, property, property.type);
          if (corner < -1 || corner >= vertices) rows.fail(no_vertex(corner, vertices));
          in_strip = corner < 0 ? 0 : in_strip + 1;
          corners = {corners[1], corners[2], corner};
          if (in_strip < 3 || corners[0] == corners[1] || corners[1] == corners[2] ||
              corners[0] == corners[2])
            continue;  // a corner that stands twice joins strips
          const bool is_turned = in_strip % 2 == 0;
          shape.add_polygon(std::array{corners[is_turned], corners[!is_turned], corners[2]});
        }
        return true;
      },
      [] {});
}

template <typename Rows>
void read_polygons(Rows& rows, const PlyElement& element, Index vertices, ShapeBuilder& shape) {
  std::vector<Index> corners;
  each_row(
      rows, element,
      [&](std::size_t p) {
        const PlyProperty& property = element.properties[p];
        if (!is_polygon(property)) return false;
        const Index length = list_length(rows, property);
        corners.clear();
        for (Index i = 0; i < length; ++i) {
          const Index corner = integer(rows, property, property.type);
          if (corner < 0 || corner >= vertices) rows.fail(no_vertex(corner, vertices));
          corners.push_back(corner);
        }
        return true;
      },
      [&] {
        shape.add_polygon(corners);
        corners.clear();
      });
}

// That nothing of the surface is dropped.
void require_corners(const PlyElement& element) {
  const bool is_surface = element.name == "face" || element.name == "tristrips";
  if (is_surface && element.count > 0 &&
      std::none_of(element.properties.begin(), element.properties.end(), is_polygon))
    throw InvalidInput("the element " + in_quotes(element.name) +
                       " lacks the list vertex_indices or vertex_index");
}

template <typename Rows>
Shape read_elements(Rows rows, const PlyHeader& header) {
  Index vertices = 0;
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") vertices = element.count;
  ShapeBuilder shape;
  for (const PlyElement& element : header.elements) {
    require_corners(element);
    if (element.name == "vertex")
      read_vertices(rows, element, shape);
    else if (element.name == "tristrips")
      read_strips(rows, element, vertices, shape);
    else
      read_polygons(rows, element, vertices, shape);
  }
  return shape.build();
}

}  // namespace

Shape read_ply(std::string_view content) {
  TextScanner text(content);
  const PlyHeader header = read_ply_header(text);
  if (header.encoding == PlyHeader::Encoding::Ascii)
    return read_elements(PlyTextRows(text), header);
  const bool is_little = header.encoding == PlyHeader::Encoding::LittleEndian;
  return read_elements(
      PlyBinaryRows(text.text_after_line(), is_little ? std::endian::little : std::endian::big),
      header);
}

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
