#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "formats.h"
#include "ply_format.h"

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

}  // namespace symsurf
