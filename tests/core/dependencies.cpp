#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// The folders of core/heart from the lowest layer up: a file includes from its own layer and from
// lower ones. That a satellite sees the heart alone, and the heart no satellite, the compiler
// checks: each part of the core has the include directories that it may see.
constexpr std::array layers{"base",       "cloud", "mirrors", "pairing",         "score",
                            "preprocess", "fit",   "search",  "fixed_direction", "detection",
                            "operations"};

struct Include {
  fs::path file, header;  // the header as it is written
  bool in_brackets;
};

std::vector<Include> includes_below(const fs::path& root) {
  const std::regex include(R"-(^\s*#\s*include\s*(<(.+)>|"(.+)"))-");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const fs::path path = entry.path();
    if (path.extension() != ".h" && path.extension() != ".cpp") continue;
    std::ifstream source(path);
    for (std::string line; std::getline(source, line);) {
      std::smatch match;
      if (std::regex_search(line, match, include))
        includes.push_back(
            {path, match[2].matched ? match[2].str() : match[3].str(), match[2].matched});
    }
  }
  return includes;
}

const fs::path core = SYMSURF_CORE, heart = core / "heart";

int layer_of(const fs::path& relative) {
  const auto found = std::find(layers.begin(), layers.end(), *relative.begin());
  return static_cast<int>(found - layers.begin());
}

bool is_allowed_library(const std::string& header) {
  const auto starts_with = [&](const char* folder) { return header.rfind(folder, 0) == 0; };
  const bool is_standard =
      std::all_of(header.begin(), header.end(), [](char c) { return c != '/' && c != '.'; });
  return starts_with("symsurf/") || starts_with("Eigen/") || starts_with("OpenMesh/") ||
         starts_with("Spectra/") || header == "nanoflann.hpp" || is_standard;
}

// One source asks the operating system or C, for what C++ cannot tell everywhere.
bool asks_the_system(const fs::path& file) { return file == core / "io" / "system.cpp"; }

// A header is written as below the heart, the core, its own folder or the satellite that it is of.
bool is_of_the_core(const Include& include) {
  const fs::path satellite = core / *fs::relative(include.file, core).begin();
  for (const fs::path& root : {heart, core, satellite, include.file.parent_path()})
    if (fs::exists(root / include.header)) return true;
  return false;
}

TEST(Dependencies, TheCoreUsesNoFrontEndAndNoLibraryButItsOwn) {
  const std::vector<Include> includes = includes_below(core);
  EXPECT_GT(includes.size(), 500u);
  for (const Include& include : includes)
    if (include.in_brackets)
      EXPECT_TRUE(is_allowed_library(include.header.generic_string()) ||
                  asks_the_system(include.file))
          << include.file << " includes " << include.header;
    else
      EXPECT_TRUE(is_of_the_core(include))
          << include.file << " includes " << include.header << " from outside";
}

TEST(Dependencies, EverySourceOfTheHeartLiesInALayer) {
  for (const auto& entry : fs::directory_iterator(heart)) {
    const fs::path folder = entry.path().filename();
    EXPECT_TRUE(entry.is_directory()) << folder << " lies in no folder";
    EXPECT_LT(layer_of(folder), static_cast<int>(layers.size())) << folder;
  }
}

TEST(Dependencies, LayersIncludeOnlyLowerOnes) {
  for (const Include& include : includes_below(heart)) {
    if (include.in_brackets) continue;
    const fs::path from = fs::relative(include.file, heart);
    ASSERT_TRUE(fs::exists(heart / include.header))
        << from << " includes " << include.header << ": paths begin at core/heart";
    EXPECT_LE(layer_of(include.header), layer_of(from)) << from << " includes " << include.header;
  }
}

// Others get a Partition, which is the same for any number of processes.
TEST(Dependencies, OnlyTheirSatelliteKnowsTheProcesses) {
  const std::regex processes("[Cc]ommunicator|processes\\(\\)");
  for (const auto& entry : fs::recursive_directory_iterator(core)) {
    const fs::path path = fs::relative(entry.path(), core);
    const fs::path folder = *path.begin();
    if (!entry.is_regular_file() || folder == "processes" || folder == "include" ||
        path == "detect.cpp" || path == "heart/base/context.cpp")
      continue;
    std::ifstream source(entry.path());
    for (std::string line; std::getline(source, line);)
      EXPECT_FALSE(std::regex_search(line, processes)) << path << ": " << line;
  }
}

TEST(Dependencies, NoFoldersIncludeEachOtherInACycle) {
  std::map<fs::path, std::set<fs::path>> used;
  for (const Include& include : includes_below(heart)) {
    const fs::path from = fs::relative(include.file, heart).parent_path();
    if (!include.in_brackets && include.header.parent_path() != from)
      used[from].insert(include.header.parent_path());
  }
  std::set<fs::path> done;
  std::vector<fs::path> way;
  const std::function<void(const fs::path&)> follow = [&](const fs::path& folder) {
    const bool is_cycle = std::find(way.begin(), way.end(), folder) != way.end();
    EXPECT_FALSE(is_cycle) << folder << " includes itself by way of " << way.back();
    if (is_cycle || !done.insert(folder).second) return;
    way.push_back(folder);
    for (const fs::path& next : used[folder]) follow(next);
    way.pop_back();
  };
  for (const auto& [folder, _] : std::map(used)) follow(folder);
}

TEST(Dependencies, NoTwoSourcesShareAName) {
  std::map<fs::path, fs::path> seen;
  for (const auto& entry : fs::recursive_directory_iterator(core))
    if (entry.is_regular_file()) {
      const auto [other, is_new] = seen.emplace(entry.path().filename(), entry.path());
      EXPECT_TRUE(is_new) << entry.path() << " and " << other->second;
    }
}

// Two of one name in one namespace would break the one definition rule, which no linker reports.
TEST(Dependencies, NoTwoHeadersDefineAClassOfOneName) {
  const std::regex space("^namespace ([a-z:]+) \\{"),
      definition("^(class|struct) (\\w+)[^;]*\\{?$");
  std::map<std::string, fs::path> seen;
  for (const auto& entry : fs::recursive_directory_iterator(core)) {
    if (entry.path().extension() != ".h") continue;
    std::ifstream source(entry.path());
    std::string inside;
    std::smatch match;
    for (std::string line; std::getline(source, line);) {
      if (std::regex_search(line, match, space)) inside = match[1];
      if (!std::regex_search(line, match, definition)) continue;
      const auto [other, is_new] = seen.emplace(inside + "::" + match[2].str(), entry.path());
      EXPECT_TRUE(is_new) << match[2] << " in " << entry.path() << " and " << other->second;
    }
  }
  EXPECT_GT(seen.size(), 100u);
}

}  // namespace
