#pragma once

#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/io.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "expect_error.h"

namespace symsurf {

/// A path in the folder for such, of which other processes have others.
inline std::filesystem::path temporary_path(const std::string& name) {
  static const unsigned process = std::random_device()();
  return std::filesystem::path(testing::TempDir()) /
         ("symsurf_" + std::to_string(process) + "_" + name);
}

/// A file with the given content, gone with the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& content) : path_(temporary_path(name)) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Reads a file of that name (its suffix tells the format) and content.
inline Shape read_content(const std::string& name, const std::string& content) {
  return read(TemporaryFile(name, content).path());
}

/// Expects one error, of the file's name and the reason.
inline void expect_unreadable(const std::string& name, const std::string& content,
                              const std::string& reason) {
  SCOPED_TRACE(content.substr(0, 400));
  expect_error<InvalidInput>(name + ": " + reason, [&] { read_content(name, content); });
}

inline Points rows(std::initializer_list<std::initializer_list<double>> values) {
  Points points(static_cast<Index>(values.size()), 3);
  Index row = 0;
  for (const auto& value : values) {
    points.row(row++) = Eigen::Map<const Eigen::RowVector3d>(value.begin());
  }
  return points;
}

inline Triangles triangles(std::initializer_list<std::initializer_list<Index>> corners) {
  Triangles faces(static_cast<Index>(corners.size()), 3);
  Index row = 0;
  for (const auto& face : corners)
    faces.row(row++) = Eigen::Map<const Eigen::Matrix<Index, 1, 3>>(face.begin());
  return faces;
}

}  // namespace symsurf
