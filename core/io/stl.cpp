#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <string>

#include "cloud/voxel_grid.h"
#include "formats.h"
#include "text_scanner.h"

namespace symsurf {

namespace {

// 80 bytes of comment, the number of triangles, and for each its normal, three corners (12 floats)
// and two bytes; little endian.
constexpr std::size_t header_bytes = 84, count_at = 80, triangle_bytes = 50, corners_at = 12;

template <typename T>
T number_at(const char* bytes) {
  return load<T>(bytes, std::endian::little);
}

class Triangulation {
 public:
  void add_corner(const Vector3& x) {
    const Index corner = distinct_.add(ordered_bits(x));
    if (corner == shape_.points()) shape_.add_point(x);
    corners_[corner_++] = corner;
    if (corner_ < 3) return;
    shape_.add_polygon(corners_);
    corner_ = 0;
  }

  Shape build() const { return shape_.build(); }

 private:
  ShapeBuilder shape_;
  TripleIndex distinct_;
  std::array<Index, 3> corners_;
  int corner_ = 0;
};

Shape read_binary(std::string_view content, std::size_t triangles) {
  Triangulation shape;
  for (std::size_t t = 0; t < triangles; ++t) {
    const char* at = content.data() + header_bytes + t * triangle_bytes + corners_at;
    for (int corner = 0; corner < 3; ++corner, at += 3 * sizeof(float))
      shape.add_corner({number_at<float>(at), number_at<float>(at + sizeof(float)),
                        number_at<float>(at + 2 * sizeof(float))});
  }
  return shape.build();
}

// STL does not distinguish capitals.
bool is_keyword(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](unsigned char a, char b) { return std::tolower(a) == b; });
}

void expect(TextScanner& text, std::string_view keyword) {
  if (!text.next_line())
    throw InvalidInput("the file is truncated: '" + std::string(keyword) + "' is missing");
  const std::string_view found = text.word();
  if (!is_keyword(found, keyword))
    text.fail(in_quotes(found) + " stands where '" + std::string(keyword) + "' should");
}

Shape read_text(std::string_view content) {
  Triangulation shape;
  TextScanner text(content);
  while (text.next_line()) {
    if (!is_keyword(text.word(), "solid")) text.fail("'solid' is missing");
    for (;;) {
      if (!text.next_line()) throw InvalidInput("the file is truncated: 'endsolid' is missing");
      const std::string_view keyword = text.word();
      if (is_keyword(keyword, "endsolid")) break;
      if (!is_keyword(keyword, "facet"))
        text.fail(in_quotes(keyword) + " stands where 'facet' should");
      expect(text, "outer");
      for (int corner = 0; corner < 3; ++corner) {
        expect(text, "vertex");
        shape.add_corner(text.vector("a coordinate"));
      }
      expect(text, "endloop");
      expect(text, "endfacet");
    }
  }
  return shape.build();
}

}  // namespace

Shape read_stl(std::string_view content) {
  // Binary files may start with "solid" too: their size and their zeros are the surer signs.
  const bool has_header = content.size() >= header_bytes;
  const std::size_t triangles =
      has_header ? number_at<std::uint32_t>(content.data() + count_at) : std::size_t{0};
  const std::size_t bytes = header_bytes + triangles * triangle_bytes;
  TextScanner text(content);
  const bool is_solid = text.next_line() && is_keyword(text.word(), "solid");
  const bool has_zero = content.substr(0, header_bytes + triangle_bytes).find('\0') != content.npos;
  if (is_solid && content.size() != bytes && !has_zero) return read_text(content);
  if (!has_header)
    throw InvalidInput("this is no STL file: neither text nor as long as a binary header");
  if (content.size() < bytes)
    throw InvalidInput("the file is truncated: " + std::to_string(triangles) + " triangles take " +
                       std::to_string(bytes) + " bytes, it has " + std::to_string(content.size()));
  return read_binary(content, triangles);
}

}  // namespace symsurf
