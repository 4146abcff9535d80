#include <symsurf/context.h>
#include <symsurf/io.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <new>
#include <string>

#include "formats.h"

namespace symsurf {

namespace {

struct Format {
  std::string_view suffix;
  Shape (*read)(std::string_view content);
};

constexpr std::array<Format, 8> formats{{{".ply", read_ply},
                                         {".obj", read_obj},
                                         {".off", read_off},
                                         {".stl", read_stl},
                                         {".xyz", read_columns},
                                         {".csv", read_columns},
                                         {".txt", read_columns},
                                         {".fcsv", read_columns}}};

// On Windows string() is of the code page, which lacks letters.
std::string utf8(const std::filesystem::path& path) {
  const auto text = path.u8string();
  return {text.begin(), text.end()};
}

const Format& format_of(const std::filesystem::path& path) {
  std::string suffix = utf8(path.extension()), known;
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Format& format : formats) {
    if (format.suffix == suffix) return format;
    known += (known.empty() ? "" : " ") + std::string(format.suffix);
  }
  throw InvalidInput("suffix '" + suffix + "' is none of " + known);
}

// Half of the memory: the content stands beside the numbers that are made of it.
void require_that_it_fits(std::uintmax_t bytes) {
  const std::uintmax_t allowed = memory_limit() / 2;
  if (bytes > allowed)
    throw InvalidInput("the file has " + std::to_string(bytes) + " bytes; allowed are at most " +
                       std::to_string(allowed) + ", half of the memory");
}

std::string content_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InvalidInput("there is no such file");
  if (!std::filesystem::is_regular_file(status)) throw InvalidInput("this is not a file");
  const auto size = std::filesystem::file_size(path, error);
  if (!error) require_that_it_fits(size);
  std::ifstream file(path, std::ios::binary);
  std::string content(error ? 0 : size, '\0');
  if (error || !file.read(content.data(), static_cast<std::streamsize>(content.size())))
    throw InvalidInput("the file cannot be read");
  if (content.empty()) throw InvalidInput("the file is empty");
  return content;
}

// Of all finite points.
bool has_normals(const Shape& shape) {
  if (shape.normals.rows() != shape.points.rows()) return false;
  for (Index i = 0; i < shape.points.rows(); ++i) {
    const bool is_direction = shape.normals.row(i).allFinite() && !shape.normals.row(i).isZero(0);
    if (!is_direction && shape.points.row(i).allFinite()) return false;
  }
  return true;
}

}  // namespace

Shape read(const std::filesystem::path& path) {
  try {
    const Format& format = format_of(path);
    Shape shape = format.read(content_of(path));
    if (shape.points.rows() == 0) throw InvalidInput("the file holds no points");
    if (!has_normals(shape)) shape.normals.resize(0, 3);
    if (shape.colours.rows() != shape.points.rows()) shape.colours.resize(0, 3);
    return shape;
  } catch (const InvalidInput& error) {
    throw InvalidInput(utf8(path) + ": " + error.what());
  } catch (const std::bad_alloc&) {  // what else is held leaves less than half of the memory
    throw InvalidInput(utf8(path) + ": what the file holds does not fit into the memory");
  }
}

}  // namespace symsurf
