#pragma once

#include <symsurf/points.h>

#include <optional>
#include <string>
#include <string_view>

namespace symsurf {

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

}  // namespace symsurf
