#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

namespace {

// Of everything in pointed brackets the core may include itself, Eigen and the standard library.
bool is_allowed(const std::string& header) {
  const auto starts_with = [&](const char* folder) { return header.rfind(folder, 0) == 0; };
  const bool is_standard =
      std::all_of(header.begin(), header.end(), [](char c) { return c != '/' && c != '.'; });
  return starts_with("symsurf/") || starts_with("Eigen/") || is_standard;
}

TEST(Dependencies, TheCoreIncludesNoFrontEnd) {
  const std::regex include(R"-(^\s*#\s*include\s*(<(.+)>|"(.+)"))-");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SYMSURF_CORE)) {
    const std::filesystem::path path = entry.path();
    if (path.extension() != ".h" && path.extension() != ".cpp") continue;
    ++files;
    std::ifstream source(path);
    for (std::string line; std::getline(source, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      if (match[2].matched)
        EXPECT_TRUE(is_allowed(match[2])) << path << " includes " << match[2];
      else
        EXPECT_TRUE(
            std::filesystem::exists(path.parent_path() / match[3].str()) ||
            std::filesystem::exists(std::filesystem::path(SYMSURF_CORE) / "src" / match[3].str()))
            << path << " includes " << match[3] << " from outside";
    }
  }
  EXPECT_GT(files, 30);
}

}  // namespace
