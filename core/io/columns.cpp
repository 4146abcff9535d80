#include <symsurf/errors.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "formats.h"
#include "shape_builder.h"
#include "text_scanner.h"

namespace symsurf {

namespace {

constexpr std::array<const char*, 6> names{"x", "y", "z", "nx", "ny", "nz"};
constexpr std::array<const char*, 6> paraview_names{"points:0",  "points:1",  "points:2",
                                                    "normals:0", "normals:1", "normals:2"};

// Which of the six numbers each column holds; -1: none.
using Positions = std::vector<int>;

std::vector<std::string> words(TextScanner& text) {
  std::vector<std::string> found;
  while (!text.line_ends()) found.emplace_back(text.word());
  return found;
}

char separator_of(std::string_view line) {
  for (const char separator : {';', ','})
    if (line.find(separator) != line.npos) return separator;
  return ' ';
}

std::string plain_name(std::string word) {
  std::erase(word, '"');
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word;
}

bool is_number(const std::string& word) {
  double value;
  return parse(word, value);
}

Positions named_places(const TextScanner& text, const std::vector<std::string>& row) {
  Positions positions(row.size(), -1);
  std::array<bool, 6> has{};
  for (std::size_t c = 0; c < row.size(); ++c) {
    const std::string name = plain_name(row[c]);
    for (int n = 0; n < 6; ++n) {
      if (has[n] || (name != names[n] && name != paraview_names[n])) continue;
      positions[c] = n;
      has[n] = true;
    }
  }
  if (!has[0] || !has[1] || !has[2])
    text.fail("the row starts with " + in_quotes(row[0]) +
              ": it is neither numbers nor names of columns x, y and z");
  if (!has[3] || !has[4] || !has[5])
    for (int& position : positions) position = position < 3 ? position : -1;
  return positions;
}

Positions unnamed_places(const TextScanner& text, std::size_t columns) {
  if (columns < 3)
    text.fail("the row has " + std::to_string(columns) + " columns; at least 3 are needed");
  Positions positions{0, 1, 2};
  if (columns == 6) positions = {0, 1, 2, 3, 4, 5};
  positions.resize(columns, -1);
  return positions;
}

bool are_colours(const Points& normals) {
  const auto values = normals.array();
  return normals.size() > 0 && (values == values.round()).all() && values.minCoeff() >= 0 &&
         values.maxCoeff() > 1 && values.maxCoeff() <= 255;
}

// The row the scanner stands at the start of.
void read_row(TextScanner& text, const Positions& positions, bool has_normals,
              ShapeBuilder& shape) {
  std::array<double, 6> values;
  for (const int position : positions) {
    if (position >= 0)
      values[position] = text.number(names[position]);
    else if (text.line_ends())
      text.fail("the row has fewer columns than the first one");
    else
      text.word();
  }
  if (!text.line_ends()) text.fail("the row has more columns than the first one");
  shape.add_point({values[0], values[1], values[2]});
  if (has_normals) shape.add_normal({values[3], values[4], values[5]});
}

}  // namespace

Shape read_columns(std::string_view content) {
  TextScanner text(content);
  text.pass_over("#");
  text.pass_over("//");
  if (!text.next_line()) throw InvalidInput("the file holds only blank lines and comments");
  text.set_separator(separator_of(text.line()));

  const std::vector<std::string> first = words(text);
  const bool is_named = !is_number(first[0]);
  const Positions positions =
      is_named ? named_places(text, first) : unnamed_places(text, first.size());
  const bool has_normals = std::find(positions.begin(), positions.end(), 5) != positions.end();

  ShapeBuilder builder;
  bool has_row = true;
  if (is_named)
    has_row = text.next_line();
  else
    text.restart_line();
  for (; has_row; has_row = text.next_line()) read_row(text, positions, has_normals, builder);
  Shape shape = builder.build();
  if (!is_named && are_colours(shape.normals)) shape.normals.resize(0, 3);
  return shape;
}

}  // namespace symsurf
