#pragma once

#include <symsurf/io.h>
#include <symsurf/points.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

#ifndef _WIN32
/// As std::from_chars, of real numbers, by what C libraries have: for C++ libraries that lack it.
std::from_chars_result from_chars_by_c(const char* begin, const char* end, double& number);
#endif

/// Apple's C++ library has it from macOS 26 on.
inline std::from_chars_result from_chars(const char* begin, const char* end, double& number) {
#ifdef __APPLE__
  return from_chars_by_c(begin, end, number);
#else
  return std::from_chars(begin, end, number);
#endif
}

/// A text taken line by line and word by word. Lines end with \n, \r\n, or all with \r; blank lines
/// and lines that start with a comment mark are passed over.
class TextScanner {
 public:
  /// The text must outlive the scanner. A byte order mark is passed over.
  explicit TextScanner(std::string_view text);

  /// Lines that start with the mark are comments. May be called several times.
  void pass_over(std::string_view comment_mark) { comment_marks_.emplace_back(comment_mark); }

  /// From the mark on the rest of any line is a comment.
  void cut_at(char comment_mark) { cut_mark_ = comment_mark; }

  /// A line that ends with the mark goes on in the next one.
  void join_at(char mark) { join_mark_ = mark; }

  /// Numbers may stand in the next line where this one ends.
  void wrap_lines() { wraps_ = true; }

  /// The text is a table, in which what stands in double quotes is one word. Between words stands
  /// ' ' (any run of blanks and tabs) or one given character; where that is no comma, one may stand
  /// for the point of a number.
  void set_table(char separator) {
    separator_ = separator;
    is_table_ = true;
  }

  /// Moves to the next line; false at the end of the text.
  bool next_line();

  /// Back to the first word of the line.
  void restart_line() { rest_ = line_; }

  /// Back to a word of the line, or to the end of one.
  void go_back_to(std::string_view word) {
    rest_ = {word.data(), static_cast<std::size_t>(line_.end() - word.begin())};
  }

  /// How many lines follow.
  Index count_lines() const;

  std::string_view line() const { return line_; }
  bool line_ends() const { return rest_.empty(); }
  std::string_view text_after_line() const { return text_.substr(position_); }

  /// The next word of the line, empty where there is none.
  std::string_view word();

  /// The next word as a number, maybe an infinite one or NaN. `what` names it in errors: "x of the
  /// vertex".
  double number(std::string_view what);
  Vector3 vector(std::string_view what);
  Index integer(std::string_view what);

  /// Red, green and blue, where the rest of the line is three or four numbers.
  std::optional<Vector3> colour();

  Index line_number() const { return line_number_; }

  /// Throws InvalidInput: "line 12: " and the reason.
  [[noreturn]] void fail(const std::string& reason) const { fail(reason, line_number_); }
  [[noreturn]] static void fail(const std::string& reason, Index line_number);

 private:
  std::string_view next_number();

  std::string_view text_, line_, rest_;
  std::size_t position_ = 0;
  Index line_number_ = 0;
  char separator_ = ' ', line_end_ = '\n', cut_mark_ = '\0', join_mark_ = '\0';
  bool is_table_ = false, wraps_ = false;
  std::string joined_;  // of lines, where one goes on in the next
  std::vector<std::string_view> comment_marks_;
};

/// Whether all of the word is a number, infinite and NaN ones included.
bool parse(std::string_view word, double& number);
bool parse(std::string_view word, Index& number);

/// The word in quotes, fit for an error message: short and printable.
std::string in_quotes(std::string_view word);

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

/// The number whose bytes stand at `bytes` in the given order.
template <typename T>
T load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> native;
  std::memcpy(native.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(native.begin(), native.end());
  return std::bit_cast<T>(native);
}

// The formats, one source each. All take a file's content and throw InvalidInput with the reason,
// and the line where there are lines; read() adds the file's name and drops normals that some
// points lack.

/// Turk's Polygon File Format 1.0: ascii, binary_little_endian, binary_big_endian. Elements but
/// vertex, those with polygons and tristrips, and properties but x y z nx ny nz, red green blue and
/// vertex_indices (vertex_index), are skipped.
Shape read_ply(std::string_view content);

/// Wavefront OBJ: v, vn and f. Colours stand behind the coordinates. A vertex's normal is the one
/// that its faces' corners name (their mean where they differ); without any in the faces, the
/// normals are the vertices' in order if there are as many.
Shape read_obj(std::string_view content);

/// Geomview's OFF, COFF, NOFF, CNOFF, with or without texture coordinates (ST); ascii, the keyword
/// missing or glued to the first number as well.
Shape read_off(std::string_view content);

/// Stereolithography, ascii in any case or binary. Equal corners of the triangles are one point.
Shape read_stl(std::string_view content);

/// XYZ, CSV, TXT and FCSV: rows of numbers, as read() describes them.
Shape read_columns(std::string_view content);

/// Collects what a file holds, of which it may not say beforehand how much there is.
class ShapeBuilder {
 public:
  Index points() const { return static_cast<Index>(points_.size()) / 3; }
  Index normals() const { return static_cast<Index>(normals_.size()) / 3; }

  void add_point(const Vector3& x) { points_.insert(points_.end(), {x.x(), x.y(), x.z()}); }
  void add_colour(const std::optional<Vector3>& c) {
    if (c) colours_.insert(colours_.end(), {c->x(), c->y(), c->z()});
  }
  void add_normal(const Vector3& n) { normals_.insert(normals_.end(), {n.x(), n.y(), n.z()}); }

  /// As a fan of triangles around the first corner; none for fewer than three corners.
  void add_polygon(std::span<const Index> corners) {
    has_others_ = has_others_ || corners.size() > 3;
    for (std::size_t c = 2; c < corners.size(); ++c)
      faces_.insert(faces_.end(), {corners[0], corners[c - 1], corners[c]});
    if (!has_others_) return;
    if (polygons_.empty()) {  // the triangles so far
      polygons_.resize(faces_.size() / 3 - (corners.size() - 2));
      std::iota(polygons_.begin(), polygons_.end(), 0);
    }
    const Index number = polygons_.empty() ? 0 : polygons_.back() + 1;
    polygons_.resize(faces_.size() / 3, number);
  }

  Shape build() const {
    return {Eigen::Map<const Points>(points_.data(), points(), 3),
            Eigen::Map<const Triangles>(faces_.data(), static_cast<Index>(faces_.size()) / 3, 3),
            Eigen::Map<const Points>(normals_.data(), normals(), 3),
            Eigen::Map<const Points>(colours_.data(), static_cast<Index>(colours_.size()) / 3, 3),
            Eigen::Map<const Eigen::Matrix<Index, Eigen::Dynamic, 1>>(
                polygons_.data(), static_cast<Index>(polygons_.size()))};
  }

 private:
  std::vector<double> points_, normals_, colours_;
  std::vector<Index> faces_, polygons_;
  bool has_others_ = false;  // than triangles
};

/// The reason why a face is broken, for an error.
inline std::string no_vertex(Index named, Index vertices) {
  return "a face names vertex " + std::to_string(named) + "; there are " +
         std::to_string(vertices) + ", counted from 0";
}

}  // namespace symsurf
