#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <string>
#include <vector>

#include "cloud/voxel_grid.h"
#include "formats.h"

namespace symsurf {

namespace {

// References to one of the file's lists. They may stand before what they name, so the farthest one
// is kept and checked at the end.
class References {
 public:
  explicit References(const char* what) : what_(what) {}

  bool any() const { return line_ > 0; }

  // The index for a number from 1 on, or from -1 backwards from the last of the `size` so far.
  Index resolve(const TextScanner& text, std::string_view word, Index size) {
    Index number = 0;
    if (!parse(word, number) || number == 0 || number < -size)
      text.fail("a corner names " + what_ + " " + in_quotes(word) + "; there are " +
                std::to_string(size) + " so far, counted from 1");
    const Index index = number > 0 ? number - 1 : size + number;
    if (index > farthest_) {
      farthest_ = index;
      line_ = text.line_number();
    }
    return index;
  }

  void require_below(Index size) const {
    if (farthest_ >= size)
      TextScanner::fail("a corner names " + what_ + " " + std::to_string(farthest_ + 1) +
                            "; there are " + std::to_string(size) + ", counted from 1",
                        line_);
  }

 private:
  std::string what_;
  Index farthest_ = -1, line_ = 0;
};

struct Corner {
  Index point, normal;
};

// The normals of the points, from those that the corners of the faces name.
class CornerNormals {
 public:
  CornerNormals(Index points, const std::vector<Vector3>& normals)
      : normals_(normals), first_(points, -1), sum_(points, Vector3::Zero()), differ_(points) {}

  void add(const Corner& corner) {
    Index& first = first_[corner.point];
    if (first < 0) first = corner.normal;
    differ_[corner.point] = differ_[corner.point] || first != corner.normal;
    sum_[corner.point] += normals_[corner.normal];
  }

  // Zero where no corner names one; as written, digit for digit, where all name the same.
  Vector3 of(Index point) const {
    if (first_[point] < 0) return Vector3::Zero();
    return differ_[point] && !sum_[point].isZero() ? sum_[point].normalized()
                                                   : normals_[first_[point]];
  }

 private:
  const std::vector<Vector3>& normals_;
  std::vector<Index> first_;
  std::vector<Vector3> sum_;
  std::vector<bool> differ_;
};

}  // namespace

Shape read_obj(std::string_view content) {
  TextScanner text(content);
  text.cut_at('#');
  text.join_at('\\');
  ShapeBuilder shape;
  std::vector<Vector3> normals;
  std::vector<Corner> corners;
  References to_points("vertex"), to_normals("normal");
  std::vector<Index> face;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "v") {
      shape.add_point(text.vector("a coordinate"));
      shape.add_colour(text.colour());
    } else if (keyword == "vn") {
      normals.push_back(text.vector("a coordinate of the normal"));
    } else if (keyword == "f") {
      face.clear();
      while (!text.line_ends()) {
        // vertex, vertex/texture, vertex//normal or vertex/texture/normal
        const std::string_view word = text.word();
        const std::size_t end = std::min(word.find('/'), word.size());
        const std::size_t last = word.rfind('/');
        face.push_back(to_points.resolve(text, word.substr(0, end), shape.points()));
        if (last != word.npos && last > end && last + 1 < word.size())
          corners.push_back({face.back(), to_normals.resolve(text, word.substr(last + 1),
                                                             static_cast<Index>(normals.size()))});
      }
      shape.add_polygon(face);
    }
  }
  to_points.require_below(shape.points());
  to_normals.require_below(static_cast<Index>(normals.size()));

  if (to_normals.any()) {
    CornerNormals of_corners(shape.points(), normals);
    for (const Corner& corner : corners) of_corners.add(corner);
    for (Index p = 0; p < shape.points(); ++p) shape.add_normal(of_corners.of(p));
  } else if (static_cast<Index>(normals.size()) == shape.points()) {
    for (const Vector3& normal : normals) shape.add_normal(normal);
  }
  return shape.build();
}

namespace {

// Passes over [ST][C][N]OFF, in small letters too, which may be missing or glued to the first
// number; gives whether the vertices have normals. MeshLab's NCOFF has them, but where Geomview has
// colours.
bool keyword_has_normals(TextScanner& text) {
  const std::string_view keyword = text.word();
  std::string rest(keyword.substr(0, keyword.find_first_of("0123456789")));
  const std::string_view number = keyword.substr(rest.size());
  std::transform(rest.begin(), rest.end(), rest.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (rest.empty() && number.find_first_not_of("0123456789") == number.npos) {
    text.restart_line();
    return false;
  }
  const bool is_known = rest.ends_with("OFF");
  if (is_known) rest.resize(rest.size() - 3);
  for (const char* known : {"", "C", "N", "CN", "ST", "STC", "STN", "STCN", "NC", "NCST"}) {
    if (!is_known || rest != known) continue;
    if (!number.empty()) text.go_back_to(number);
    return rest.ends_with("N");
  }
  text.fail("the file starts with " + in_quotes(keyword) + "; OFF, COFF, NOFF, CNOFF can be read");
}

// Whatever its capitals.
bool is_next(TextScanner& text, std::string_view word) {
  const std::string_view found = text.word();
  text.go_back_to(found);
  return std::equal(found.begin(), found.end(), word.begin(), word.end(),
                    [](unsigned char a, char b) { return std::toupper(a) == b; });
}

Index count(TextScanner& text, const char* what) {
  const Index value = text.integer(what);
  if (value < 0) text.fail(std::string(what) + " is below 0");
  return value;
}

// The scanner stands at the start of the row then.
void begin_row(TextScanner& text, bool is_line, const char* what, Index row, Index rows) {
  if ((is_line || text.line_ends()) && !text.next_line())
    throw InvalidInput("the file is truncated: it ends at " + std::string(what) + " " +
                       std::to_string(row) + " of " + std::to_string(rows));
}

}  // namespace

Shape read_off(std::string_view content) {
  TextScanner text(content);
  text.cut_at('#');
  text.wrap_lines();
  if (!text.next_line()) throw InvalidInput("the file holds only comments");
  const bool has_normals = keyword_has_normals(text);
  if (text.line_ends() && !text.next_line())
    throw InvalidInput("the file is truncated: the numbers of vertices and faces are missing");
  if (is_next(text, "BINARY")) text.fail("binary OFF cannot be read; text can");
  const Index vertices = count(text, "the number of vertices");
  const Index line = text.line_number(), faces = count(text, "the number of faces");
  if (!text.line_ends() || text.line_number() > line) count(text, "the number of edges");
  // Fewer lines than rows: the numbers stand anyhow. Else what a line has beside are colours.
  const bool is_line = text.count_lines() >= vertices && text.count_lines() - vertices >= faces;

  ShapeBuilder shape;
  for (Index v = 0; v < vertices; ++v) {
    begin_row(text, is_line, "vertex", v, vertices);
    shape.add_point(text.vector("a coordinate"));
    if (has_normals) shape.add_normal(text.vector("a coordinate of the normal"));
    if (is_line) shape.add_colour(text.colour());
  }
  std::vector<Index> corners;
  for (Index f = 0; f < faces; ++f) {
    begin_row(text, is_line, "face", f, faces);
    corners.clear();
    for (Index left = count(text, "the number of corners"); left > 0; --left) {
      const Index corner = text.integer("a corner");
      if (corner < 0 || corner >= vertices) text.fail(no_vertex(corner, vertices));
      corners.push_back(corner);
    }
    shape.add_polygon(corners);
  }
  return shape.build();
}

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
