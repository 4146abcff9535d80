#include <symsurf/context.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "formats.h"
#include "text_scanner.h"

namespace symsurf {

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
  if (text.line() == "OFF BINARY") text.fail("binary OFF cannot be read; text can");
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

}  // namespace symsurf
