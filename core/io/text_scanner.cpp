#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "formats.h"

namespace symsurf {

namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && (is_blank(text.back()) || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

// std::from_chars knows no plus sign.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

bool parse(std::string_view word, double& number) {
  word = without_plus(word);
  const char* end = word.data() + word.size();
  const auto [stop, error] = from_chars(word.data(), end, number);
  if (error == std::errc::result_out_of_range) {
    const bool is_small = word.find("e-") != word.npos || word.find("E-") != word.npos;
    number = is_small ? 0 : std::numeric_limits<double>::infinity();
  }
  return !word.empty() && stop == end && error != std::errc::invalid_argument;
}

bool parse(std::string_view word, Index& number) {
  word = without_plus(word);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  return !word.empty() && stop == end && error == std::errc();
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 24;
  std::string text(word.substr(0, longest));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + text + (word.size() > longest ? "...'" : "'");
}

TextScanner::TextScanner(std::string_view text) : text_(text) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text.starts_with(byte_order_mark)) position_ = byte_order_mark.size();
  const std::size_t end = text.find_first_of("\r\n");
  if (end != text.npos && text[end] == '\r' && text.substr(end, 2) != "\r\n") line_end_ = '\r';
}

bool TextScanner::next_line() {
  bool goes_on = false;
  while (position_ < text_.size()) {
    const std::size_t end = std::min(text_.find(line_end_, position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    if (cut_mark_) line_ = line_.substr(0, line_.find(cut_mark_));
    line_ = trimmed(line_);
    position_ = std::min(end + 1, text_.size());
    ++line_number_;
    if (join_mark_ && line_.ends_with(join_mark_)) {
      if (!goes_on) joined_.clear();
      joined_.append(line_.substr(0, line_.size() - 1)) += ' ';
      goes_on = true;
      continue;
    }
    if (goes_on) line_ = joined_.append(line_);
    goes_on = false;
    const auto starts_line = [&](std::string_view mark) { return line_.starts_with(mark); };
    if (line_.empty() || std::any_of(comment_marks_.begin(), comment_marks_.end(), starts_line))
      continue;
    rest_ = line_;
    return true;
  }
  line_ = rest_ = goes_on ? std::string_view(joined_) : std::string_view();
  return goes_on;
}

Index TextScanner::count_lines() const {
  TextScanner rest = *this;
  Index count = 0;
  while (rest.next_line()) ++count;
  return count;
}

std::string_view TextScanner::word() {
  const auto is_end = [&](char c) { return separator_ == ' ' ? is_blank(c) : c == separator_; };
  std::size_t length = 0;
  if (is_table_ && rest_.starts_with('"')) length = std::min(rest_.find('"', 1), rest_.size());
  while (length < rest_.size() && !is_end(rest_[length])) ++length;
  std::string_view found = trimmed(rest_.substr(0, length));
  rest_.remove_prefix(std::min(length + 1, rest_.size()));
  while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  if (is_table_ && found.size() > 1 && found.front() == '"' && found.back() == '"')
    found = trimmed(found.substr(1, found.size() - 2));
  return found;
}

std::string_view TextScanner::next_number() {
  if (wraps_ && rest_.empty()) next_line();
  return word();
}

double TextScanner::number(std::string_view what) {
  const std::string_view text = next_number();
  double value = 0;
  if (text.empty()) fail(std::string(what) + " is missing");
  std::string plain(text);
  if (is_table_ && separator_ != ',' && std::count(text.begin(), text.end(), ',') == 1)
    std::replace(plain.begin(), plain.end(), ',', '.');
  if (!parse(plain, value)) fail(std::string(what) + " is " + in_quotes(text) + ", not a number");
  return value;
}

Vector3 TextScanner::vector(std::string_view what) {
  const double x = number(what), y = number(what), z = number(what);
  return {x, y, z};
}

std::optional<Vector3> TextScanner::colour() {
  std::array<double, 4> values{};
  std::size_t count = 0;
  while (!line_ends() && count < 4)
    if (!parse(word(), values[count++])) return {};
  if (!line_ends() || count < 3) return {};
  return Vector3(values[0], values[1], values[2]);
}

Index TextScanner::integer(std::string_view what) {
  const std::string_view text = next_number();
  Index value = 0;
  if (text.empty()) fail(std::string(what) + " is missing");
  if (!parse(text, value)) fail(std::string(what) + " is " + in_quotes(text) + ", not an integer");
  return value;
}

void TextScanner::fail(const std::string& reason, Index line_number) {
  throw InvalidInput("line " + std::to_string(line_number) + ": " + reason);
}

}  // namespace symsurf
