#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "formats.h"

namespace symsurf {

namespace {

constexpr std::array<const char*, 6> names{"x", "y", "z", "nx", "ny", "nz"};
// Those of ParaView, and of its later versions.
constexpr std::array<const char*, 6> paraview_names{"points:0",  "points:1",  "points:2",
                                                    "normals:0", "normals:1", "normals:2"};
constexpr std::array<const char*, 2> comment_marks{"#", "//"};

// Which of the six numbers each column holds; -1: none.
using Positions = std::vector<int>;
using Words = std::vector<std::string>;

Words words(TextScanner& text) {
  Words found;
  while (!text.line_ends()) found.emplace_back(text.word());
  return found;
}

// Words but for units in brackets.
Words name_words(TextScanner& text) {
  Words found = words(text);
  std::erase_if(found, [](const std::string& word) {
    return word.starts_with('[') || word.starts_with('(');
  });
  return found;
}

bool is_number(std::string word) {
  if (word.starts_with(',') || word.ends_with(',')) return false;
  std::replace(word.begin(), word.end(), ',', '.');
  double value;
  return parse(word, value);
}

char separator_of(std::string_view line) {
  const auto split = [&](char separator) {
    TextScanner text(line);
    text.next_line();
    text.set_table(separator);
    return words(text);
  };
  if (split(';').size() > 1) return ';';
  if (split(',').size() == 1) return ' ';
  // Decimal commas stand between blanks, or commas between numbers.
  const Words by_blanks = split(' ');
  const bool has_decimal_commas =
      by_blanks.size() > 2 && std::all_of(by_blanks.begin(), by_blanks.end(), is_number);
  return has_decimal_commas ? ' ' : ',';
}

// "X [mm]" names x.
std::string plain_name(std::string word) {
  word = word.substr(0, word.find_first_of("[("));
  std::erase(word, '"');
  while (word.ends_with(' ')) word.pop_back();
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (word.starts_with("points_") || word.starts_with("normals_"))
    std::replace(word.begin(), word.end(), '_', ':');
  return word;
}

// No positions where x, y or z is missing.
Positions named_positions(const Words& row) {
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
  if (!has[0] || !has[1] || !has[2]) return {};
  if (!has[3] || !has[4] || !has[5])
    for (int& position : positions) position = position < 3 ? position : -1;
  return positions;
}

// Those that a comment names: "# x y z", "//X,Y,Z,R,G,B", "# columns = id,x,y,z".
Positions commented_positions(std::string_view line) {
  while (!line.empty() && (line[0] == '#' || line[0] == '/')) line.remove_prefix(1);
  TextScanner text(line);
  if (!text.next_line()) return {};
  if (plain_name(std::string(text.word())) == "columns" && text.word() == "=") {
    line.remove_prefix(line.find('=') + 1);
    text = TextScanner(line);
    text.next_line();
  } else {
    text.restart_line();
  }
  text.set_table(separator_of(line));
  return named_positions(name_words(text));
}

Positions unnamed_positions(const TextScanner& text, std::size_t columns) {
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

// 0, 1, 2, ... or 1, 2, 3, ...
bool counts_rows(const Points& points) {
  if (points.rows() < 3 || (points(0, 0) != 0 && points(0, 0) != 1)) return false;
  for (Index i = 1; i < points.rows(); ++i)
    if (points(i, 0) != points(0, 0) + static_cast<double>(i)) return false;
  return true;
}

// What a table's first lines say.
struct Head {
  Positions positions;
  bool is_named = false;
  char separator = ' ';
};

// Passes over comments; gives the columns that the last one with names has named.
Positions pass_comments(TextScanner& text) {
  const auto is_comment = [&] {
    return std::any_of(comment_marks.begin(), comment_marks.end(),
                       [&](const char* mark) { return text.line().starts_with(mark); });
  };
  Positions named;
  do {
    if (!text.next_line()) throw InvalidInput("the file holds only blank lines and comments");
    const Positions found = is_comment() ? commented_positions(text.line()) : Positions();
    if (!found.empty()) named = found;
  } while (is_comment());
  for (const char* mark : comment_marks) text.pass_over(mark);
  return named;
}

// Passes over a first row that says how many rows there are, and a row of text behind it, as
// chemists write it; whether there was one.
bool pass_count(TextScanner& text) {
  Index promised = 0;
  if (!parse(text.line(), promised)) return false;
  const Index rows = text.count_lines();
  if (rows != promised && rows != promised + 1)
    text.fail("the row has 1 column, and is no number of rows: there are " + std::to_string(rows) +
              " more");
  text.next_line();
  TextScanner row(text.line());
  row.next_line();
  row.set_table(separator_of(text.line()));
  if (rows == promised + 1 && named_positions(words(row)).empty()) text.next_line();
  return true;
}

// Leaves the scanner at the first row of numbers.
Head read_head(TextScanner& text) {
  Head head;
  const Positions commented = pass_comments(text);
  const bool has_count = pass_count(text);
  head.separator = separator_of(text.line());
  text.set_table(head.separator);
  const Words first = name_words(text);
  const bool starts_with_number = !first.empty() && is_number(first[0]);
  const bool has_symbols = has_count && first.size() > 3 && !starts_with_number &&
                           std::all_of(first.begin() + 1, first.begin() + 4, is_number);
  if (!commented.empty() && commented.size() + 1 >= first.size() && first.size() > 2) {
    head = {commented, true, head.separator};
    text.restart_line();
  } else if (has_symbols) {
    head.positions = {-1, 0, 1, 2};
    head.positions.resize(first.size(), -1);
    text.restart_line();
  } else if (starts_with_number) {
    head.positions = unnamed_positions(text, first.size());
    text.restart_line();
  } else {
    head.positions = named_positions(first);
    head.is_named = true;
    if (head.positions.empty())
      text.fail("the row starts with " + in_quotes(first.empty() ? "" : first[0]) +
                ": it is neither numbers nor names of columns x, y and z");
    if (!text.next_line()) return head;
    // R writes no name above the names of rows.
    if (words(text).size() == first.size() + 1) head.positions.insert(head.positions.begin(), -1);
    text.restart_line();
  }
  return head;
}

// The row the scanner stands at the start of.
void read_row(TextScanner& text, const Head& head, bool has_normals, ShapeBuilder& shape) {
  std::array<double, 6> values;
  for (std::size_t c = 0; c < head.positions.size(); ++c) {
    const int position = head.positions[c];
    const bool is_empty_at_end = c + 1 == head.positions.size() && head.separator != ' ';
    if (position >= 0)
      values[position] = text.number(names[position]);
    else if (text.line_ends() && !is_empty_at_end)
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
  const Head head = read_head(text);
  const bool has_normals =
      std::find(head.positions.begin(), head.positions.end(), 5) != head.positions.end();
  ShapeBuilder builder;
  if (!text.line().empty()) do
      read_row(text, head, has_normals, builder);
    while (text.next_line());
  Shape shape = builder.build();
  if (head.is_named) return shape;
  if (head.positions.size() > 3 && head.positions[0] == 0 && counts_rows(shape.points))
    throw InvalidInput("the first of " + std::to_string(head.positions.size()) +
                       " columns without names counts the rows, so that which are x, y and z is "
                       "not clear; name them in a first row, such as id,x,y,z");
  if (are_colours(shape.normals)) shape.colours.swap(shape.normals);
  return shape;
}

}  // namespace symsurf
