#include <gtest/gtest.h>

#include <bit>
#include <cctype>
#include <cstdint>
#include <vector>

#include "temporary_file.h"

namespace symsurf::read_stl_tests {
namespace {

// Two triangles that share an edge, in one position as -0.
const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, -0.0f, 0, 1, 1, 0.5f, 0, 1, 0};
const Points merged = rows({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}});
const Triangles shared = triangles({{0, 1, 2}, {1, 3, 2}});

std::string text(const std::vector<float>& coordinates) {
  std::string content = "solid thing\n";
  for (std::size_t i = 0; i < coordinates.size(); i += 3) {
    if (i % 9 == 0) content += "facet normal 0 0 1\n outer loop\n";
    content += "  vertex " + std::to_string(coordinates[i]) + " " +
               std::to_string(coordinates[i + 1]) + " " + std::to_string(coordinates[i + 2]) + "\n";
    if (i % 9 == 6) content += " endloop\nendfacet\n";
  }
  return content + "endsolid thing\n";
}

void put(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 255);
}

std::string binary(const std::vector<float>& coordinates, const std::string& comment = "made") {
  std::string content = comment + std::string(80 - comment.size(), ' ');
  put(content, static_cast<std::uint32_t>(coordinates.size() / 9));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (i % 9 == 0) content += std::string(12, '\0');
    put(content, std::bit_cast<std::uint32_t>(coordinates[i]));
    if (i % 9 == 8) content += std::string(2, '\0');
  }
  return content;
}

TEST(ReadStl, MergesEqualCorners) {
  for (const std::string& content : {text(corners), binary(corners), binary(corners, "solid thing"),
                                     text(corners) + text({}), binary(corners) + "trailing"}) {
    const Shape shape = read_content("a.stl", content);
    EXPECT_EQ(shape.points, merged);
    EXPECT_EQ(shape.faces, shared);
    EXPECT_EQ(shape.normals.rows(), 0);
  }
}

TEST(ReadStl, DoesNotDistinguishCapitals) {
  std::string content = "\n  " + text(corners);
  for (char& c : content) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(read_content("a.stl", content).points, merged);
  EXPECT_EQ(read_content("a.stl", binary(corners, "SOLID thing") + "trailing").faces, shared);
}

TEST(ReadStl, KeepsTheDigitsOfText) {
  const Shape shape = read_content("a.stl",
                                   "solid\nfacet normal 0 0 1\nouter loop\n"
                                   "vertex 4000000.001 0 0\nvertex 4000000.002 0 0\n"
                                   "vertex 0 1e-3 0\nendloop\nendfacet\nendsolid\n");
  EXPECT_EQ(shape.points, rows({{4000000.001, 0, 0}, {4000000.002, 0, 0}, {0, 1e-3, 0}}));
}

TEST(ReadStl, SaysWhatIsBroken) {
  const auto expect = [](const std::string& content, const std::string& reason) {
    expect_unreadable("a.stl", content, reason);
  };
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string content = text(corners);
    return content.replace(content.find(from), from.size(), to);
  };
  expect("hello", "this is no STL file");
  expect("solid\nendsolid\n", "the file holds no points");
  expect(binary({}), "the file holds no points");
  expect(changed("1.000000 0.0", "one 0.0"), "line 5: a coordinate is 'one', not a number");
  expect(changed(" 0.000000\n", "\n"), "line 4: a coordinate is missing");
  expect(changed("outer loop", "loop"), "line 3: 'loop' stands where 'outer' should");
  expect(changed(" endloop", "vertex 1 2 3\n endloop"), "line 7: 'vertex' stands where 'endloop'");
  const std::string whole = binary(corners);
  for (std::size_t size = 84; size < whole.size(); ++size)
    expect(whole.substr(0, size), "the file is truncated: 2 triangles take 184 bytes");
}

}  // namespace
}  // namespace symsurf::read_stl_tests
