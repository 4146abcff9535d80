#pragma once

#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

// The tables of this folder for the hosts in C++; README.md says what their columns mean.
// SYMSURF_BAD_INPUT is this folder.

namespace symsurf::bad_input {

inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// The rows below the table's heading, each with as many cells as that.
inline std::vector<std::vector<std::string>> table(const std::string& name) {
  std::ifstream file(std::string(SYMSURF_BAD_INPUT) + "/" + name);
  std::string line;
  std::getline(file, line);
  const std::size_t columns = split(line, '\t').size();
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    rows.push_back(split(line, '\t'));
    if (rows.back().size() != columns) throw std::runtime_error(name + ": " + line);
  }
  if (rows.empty()) throw std::runtime_error(name + " has no rows");
  return rows;
}

/// std::istream reads neither nan nor inf, std::stod no subnormal number.
inline std::vector<double> numbers(const std::string& text) {
  std::istringstream words(text);
  std::vector<double> values;
  for (std::string word; words >> word;) values.push_back(std::strtod(word.c_str(), nullptr));
  return values;
}

struct Cloud {
  std::string name, reason;
  bool refuses_nonfinite;
  Points points;
};

inline Points points_of(const std::string& rows) {
  std::vector<Vector3> points;
  for (std::string row : split(rows, ';')) {
    if (row.empty()) continue;
    Index count = 1;
    if (const std::size_t times = row.find('*'); times != row.npos) {
      count = std::stoll(row);
      row = row.substr(times + 1);
    }
    const std::size_t plus = row.find(" + ");
    const std::vector<double> first = numbers(row.substr(0, plus));
    const std::vector<double> step =
        plus == row.npos ? std::vector<double>(3) : numbers(row.substr(plus + 3));
    for (Index i = 0; i < count; ++i)
      points.emplace_back(first.at(0) + double(i) * step.at(0),
                          first.at(1) + double(i) * step.at(1),
                          first.at(2) + double(i) * step.at(2));
  }
  Points matrix(static_cast<Index>(points.size()), 3);
  for (Index i = 0; i < matrix.rows(); ++i) matrix.row(i) = points[i].transpose();
  return matrix;
}

inline std::vector<Cloud> clouds() {
  std::vector<Cloud> found;
  for (const auto& row : table("clouds.tsv"))
    found.push_back({row[0], row[2], row[1] == "refuse", points_of(row[3])});
  return found;
}

struct MirrorNumbers {
  std::string name, kind, reason;
  Values numbers;
};

inline Value value_of(const std::string& text) {
  if (std::isalpha(static_cast<unsigned char>(text[0])) && text != "nan" && text != "inf" &&
      text.find(' ') == text.npos)
    return text;
  const std::vector<std::string> rows = split(text, '/');
  const std::vector<double> first = numbers(rows[0]);
  if (rows.size() == 1 && first.size() == 1) return first[0];
  if (rows.size() == 1 && first.size() == 3) return Vector3(first[0], first[1], first[2]);
  Eigen::MatrixXd matrix(rows.size(), first.size());
  for (Index r = 0; r < matrix.rows(); ++r)
    for (Index c = 0; c < matrix.cols(); ++c) matrix(r, c) = numbers(rows[r]).at(c);
  return matrix;
}

inline std::vector<MirrorNumbers> mirrors() {
  std::vector<MirrorNumbers> found;
  for (const auto& row : table("mirrors.tsv")) {
    Values numbers;
    for (const std::string& entry : split(row[3], ';')) {
      const std::size_t start = entry.find_first_not_of(' '), equals = entry.find('=');
      if (equals == entry.npos) continue;
      numbers[entry.substr(start, equals - start)] = value_of(entry.substr(equals + 1));
    }
    found.push_back({row[0], row[1], row[2], std::move(numbers)});
  }
  return found;
}

struct File {
  std::string name, reason, content;
};

inline std::string unescaped(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      bytes += text[i];
      continue;
    }
    const char code = text.at(++i);
    if (code == 'x') {
      bytes += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      bytes += code == 'n' ? '\n' : code == 'r' ? '\r' : code;
    }
  }
  return bytes;
}

inline std::vector<File> files() {
  std::vector<File> found;
  for (const auto& row : table("files.tsv")) found.push_back({row[0], row[1], unescaped(row[2])});
  return found;
}

}  // namespace symsurf::bad_input
