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

// The folders of core/src from the lowest layer up: a file includes from its own layer and from
// lower ones.
constexpr std::array layers{"base",      "distributed", "spatial",   "mesh",       "cloud",
                            "mirrors",   "optics",      "score",     "preprocess", "methods",
                            "detection", "symmetries",  "operations"};
// Used by no layer; may use all of them.
constexpr std::array leaves{"synthetic"};

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

const fs::path source_root = fs::path(SYMSURF_CORE) / "src";

int layer_of(const fs::path& relative) {
  const auto found = std::find(layers.begin(), layers.end(), *relative.begin());
  return static_cast<int>(found - layers.begin());
}

bool is_leaf(const fs::path& relative) {
  return std::find(leaves.begin(), leaves.end(), *relative.begin()) != leaves.end();
}

bool is_allowed_library(const std::string& header) {
  const auto starts_with = [&](const char* folder) { return header.rfind(folder, 0) == 0; };
  const bool is_standard =
      std::all_of(header.begin(), header.end(), [](char c) { return c != '/' && c != '.'; });
  return starts_with("symsurf/") || starts_with("Eigen/") || starts_with("OpenMesh/") ||
         starts_with("Spectra/") || header == "nanoflann.hpp" || is_standard;
}

// Two sources ask the operating system or C, for what C++ cannot tell everywhere.
bool asks_the_system(const fs::path& file) {
  const fs::path io = fs::path(SYMSURF_CORE) / "io";
  return file == io / "memory_limit.cpp" || file == io / "from_chars.cpp";
}

TEST(Dependencies, TheCoreUsesNoFrontEndAndNoLibraryButItsOwn) {
  const std::vector<Include> includes = includes_below(SYMSURF_CORE);
  EXPECT_GT(includes.size(), 500u);
  for (const Include& include : includes)
    if (include.in_brackets)
      EXPECT_TRUE(is_allowed_library(include.header.generic_string()) ||
                  asks_the_system(include.file))
          << include.file << " includes " << include.header;
    else
      EXPECT_TRUE(fs::exists(source_root / include.header) ||
                  fs::exists(include.file.parent_path() / include.header))
          << include.file << " includes " << include.header << " from outside";
}

TEST(Dependencies, EverySourceLiesInALayer) {
  for (const auto& entry : fs::directory_iterator(source_root)) {
    const fs::path folder = entry.path().filename();
    EXPECT_TRUE(entry.is_directory()) << folder << " lies in no folder";
    EXPECT_TRUE(layer_of(folder) < static_cast<int>(layers.size()) || is_leaf(folder)) << folder;
  }
}

TEST(Dependencies, LayersIncludeOnlyLowerOnes) {
  for (const Include& include : includes_below(source_root)) {
    if (include.in_brackets) continue;
    const fs::path from = fs::relative(include.file, source_root);
    ASSERT_TRUE(fs::exists(source_root / include.header))
        << from << " includes " << include.header << ": paths begin at core/src";
    if (!is_leaf(from)) {
      EXPECT_TRUE(layer_of(include.header) <= layer_of(from))
          << from << " includes " << include.header;
    }
  }
}

// Others get a Partition, which is the same for any number of processes.
TEST(Dependencies, OnlyDistributedPartsKnowTheProcesses) {
  const std::regex processes("[Cc]ommunicator|processes\\(\\)");
  for (const auto& entry : fs::recursive_directory_iterator(source_root)) {
    const fs::path path = fs::relative(entry.path(), source_root);
    const fs::path folder = *path.begin();
    if (!entry.is_regular_file() || folder == "distributed" || folder == "detection" ||
        path == "base/context.cpp" || path == "score/distributed_matching.cpp")
      continue;
    std::ifstream source(entry.path());
    for (std::string line; std::getline(source, line);)
      EXPECT_FALSE(std::regex_search(line, processes)) << path << ": " << line;
  }
}

TEST(Dependencies, NoFoldersIncludeEachOtherInACycle) {
  std::map<fs::path, std::set<fs::path>> used;
  for (const Include& include : includes_below(source_root)) {
    const fs::path from = fs::relative(include.file, source_root).parent_path();
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
  for (const auto& entry : fs::recursive_directory_iterator(source_root))
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
  for (const auto& entry : fs::recursive_directory_iterator(SYMSURF_CORE)) {
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
