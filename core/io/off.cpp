#include <symsurf/errors.h>

#include <vector>

#include "formats.h"
#include "shape_builder.h"
#include "text_scanner.h"

namespace symsurf {

namespace {

// [ST][C][N]OFF; whether the vertices have normals.
bool keyword_has_normals(TextScanner& text) {
  const std::string_view keyword = text.word();
  std::string_view rest = keyword;
  const auto take = [&](std::string_view prefix) {
    const bool found = rest.starts_with(prefix);
    if (found) rest.remove_prefix(prefix.size());
    return found;
  };
  take("ST");
  take("C");
  const bool has_normals = take("N");
  if (rest != "OFF")
    text.fail("the file starts with " + in_quotes(keyword) +
              "; OFF, COFF, NOFF, CNOFF can be read");
  return has_normals;
}

Index count(TextScanner& text, const char* what) {
  const Index value = text.integer(what);
  if (value < 0) text.fail(std::string(what) + " is below 0");
  return value;
}

void next_row(TextScanner& text, const char* what, Index row, Index rows) {
  if (!text.next_line())
    throw InvalidInput("the file is truncated: it ends at " + std::string(what) + " " +
                       std::to_string(row) + " of " + std::to_string(rows));
}

}  // namespace

Shape read_off(std::string_view content) {
  TextScanner text(content);
  text.pass_over("#");
  if (!text.next_line()) throw InvalidInput("the file holds only comments");
  const bool has_normals = keyword_has_normals(text);
  if (text.line_ends() && !text.next_line())
    throw InvalidInput("the file is truncated: the numbers of vertices and faces are missing");
  const Index vertices = count(text, "the number of vertices");
  const Index faces = count(text, "the number of faces");

  ShapeBuilder shape;
  for (Index v = 0; v < vertices; ++v) {
    next_row(text, "vertex", v, vertices);
    shape.add_point(text.vector("a coordinate"));
    if (has_normals) shape.add_normal(text.vector("a coordinate of the normal"));
  }
  std::vector<Index> corners;
  for (Index f = 0; f < faces; ++f) {
    next_row(text, "face", f, faces);
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
