#include <gtest/gtest.h>

#include <algorithm>

#include "temporary_file.h"

namespace symsurf::read_off_tests {
namespace {

const std::string square = "0 0 0\n4000000.001 0 0\n1 1 0\n0 1 0\n";
const Points corners = rows({{0, 0, 0}, {4000000.001, 0, 0}, {1, 1, 0}, {0, 1, 0}});

TEST(ReadOff, MeshesAndBareClouds) {
  const Shape mesh =
      read_content("a.off", "OFF\n# a square\n4 2 0\n" + square + "4 0 1 2 3\n\n3 0 1 2 255 0 0\n");
  EXPECT_EQ(mesh.points, corners);
  EXPECT_EQ(mesh.faces, triangles({{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh.normals.rows(), 0);
  const Shape cloud = read_content("a.off", "OFF 4 0 0\n" + square);
  EXPECT_EQ(cloud.points, corners);
  EXPECT_EQ(cloud.faces.rows(), 0);
}

TEST(ReadOff, EdgesAreNoTriangles) {
  EXPECT_EQ(read_content("a.off", "OFF\n4 2 0\n" + square + "2 0 1\n3 0 1 2\n").faces,
            triangles({{0, 1, 2}}));
}

TEST(ReadOff, NormalsAndColours) {
  const Points points = rows({{1, 2, 3}, {4, 5, 6}}), normals = rows({{0, 0, 1}, {0.6, 0.8, 0}});
  const Shape noff = read_content("a.off", "NOFF\n2 0 0\n1 2 3 0 0 1\n4 5 6 0.6 0.8 0\n");
  EXPECT_EQ(noff.points, points);
  EXPECT_EQ(noff.normals, normals);
  const Shape coff = read_content("a.off", "COFF\n2 0 0\n1 2 3 255 0 0 255\n4 5 6 0 0 1 1\n");
  EXPECT_EQ(coff.points, points);
  EXPECT_EQ(coff.normals.rows(), 0);
  for (const char* keyword : {"CNOFF", "STCNOFF", "STNOFF"}) {
    const Shape all = read_content(
        "a.off", keyword + std::string("\n2 0 0\n1 2 3 0 0 1 9 9 9 9\n4 5 6 0.6 0.8 0 9 9 9 9\n"));
    EXPECT_EQ(all.points, points);
    EXPECT_EQ(all.normals, normals);
  }
}

TEST(ReadOff, EveryWayToBegin) {
  const std::string rest = square + "3 0 1 2\n";
  for (const char* start : {"OFF\n4 1 0\n", "OFF4 1 0\n", "OFF 4 1\n", "4 1 0\n", "off\n4 1 5\n",
                            "# by hand\nOFF # so\n4 1 0 # edges\n", "\nOFF\n\n4 1 0\n\n"}) {
    const Shape shape = read_content("a.off", start + rest);
    EXPECT_EQ(shape.points, corners) << start;
    EXPECT_EQ(shape.faces, triangles({{0, 1, 2}})) << start;
  }
}

TEST(ReadOff, NumbersOverLinesAndInOne) {
  const std::string one_line = "OFF 4 1 0 0 0 0 4000000.001 0 0 1 1 0 0 1 0 3 0 1 2";
  std::string a_line_each = one_line;
  std::replace(a_line_each.begin(), a_line_each.end(), ' ', '\n');
  for (const std::string& content : {one_line, a_line_each}) {
    const Shape shape = read_content("a.off", content);
    EXPECT_EQ(shape.points, corners);
    EXPECT_EQ(shape.faces, triangles({{0, 1, 2}}));
  }
}

TEST(ReadOff, SaysWhatIsBroken) {
  const auto expect = [](const std::string& content, const std::string& reason) {
    expect_unreadable("a.off", content, reason);
  };
  expect("# nothing\n", "the file holds only comments");
  expect("4OFF\n4 2 0\n" + square, "line 1: the file starts with '4OFF'");
  expect("OFF BINARY\n", "line 1: binary OFF cannot be read; text can");
  expect("OFF\n", "the file is truncated: the numbers of vertices and faces are missing");
  expect("OFF\n4\n", "line 2: the number of faces is missing");
  expect("OFF\n-4 0 0\n" + square, "line 2: the number of vertices is below 0");
  expect("OFF\n0 0 0\n", "the file holds no points");
  expect("OFF\n5 0 0\n" + square, "the file is truncated: it ends at vertex 4 of 5");
  expect("OFF\n4 2 0\n" + square + "3 0 1 2\n", "the file is truncated: it ends at face 1 of 2");
  expect("OFF\n9000000000000000000 0 0\n" + square, "the file is truncated");
  expect("OFF\n1 0 0\n1 2\n", "line 3: a coordinate is missing");
  expect("NOFF\n1 0 0\n1 2 3 0 0\n", "line 3: a coordinate of the normal is missing");
  expect("OFF\n4 1 0\n" + square + "3 0 1 4\n", "line 7: a face names vertex 4; there are 4");
  expect("OFF\n4 1 0\n" + square + "3 0 1 -1\n", "line 7: a face names vertex -1");
  expect("OFF\n4 1 0\n" + square + "3 0 1\n", "line 7: a corner is missing");
  expect("OFF\n4 1 0\n" + square + "x 0 1\n", "line 7: the number of corners is 'x'");
}

}  // namespace
}  // namespace symsurf::read_off_tests
