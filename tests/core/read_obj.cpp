#include <gtest/gtest.h>

#include "temporary_file.h"

namespace symsurf::read_obj_tests {
namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, EveryWayToWriteAFace) {
  const Triangles fan = triangles({{0, 1, 2}, {0, 2, 3}});
  const std::string other = "vt 0 0\nvn 0 0 1\n";
  for (const char* face :
       {"f 1 2 3 4", "f 1/1 2/1 3/1 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/1/1 3/1/1 4/1/1",
        "f -4 -3 -2 -1", "f -4/-1/-1 2/1/1 3/1/1 -1", "f 1 2 3 4   # a square", "f 1 2 \\\n3 4"}) {
    const std::string word = std::string(face).substr(0, std::string(face).find('#'));
    const Shape shape = read_content("a.obj", square + other + word + "\n");
    EXPECT_EQ(shape.points, rows({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(shape.faces, fan) << face;
  }
}

TEST(ReadObj, PassesOverTheRest) {
  const Shape shape = read_content(
      "a.obj",
      "# made by hand\nmtllib a.mtl\no thing\n\nv 4000000.001 2 3 1.0\nv 1 2 3 0.5 0.5 0.5\n"
      "vt 0 0\ng group\nusemtl red\ns off\nl 1 2\np 1\nvp 0.1\n");
  EXPECT_EQ(shape.points, rows({{4000000.001, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(shape.faces.rows(), 0);
  EXPECT_EQ(shape.normals.rows(), 0);
}

TEST(ReadObj, FacesMayStandBeforeWhatTheyName) {
  const Shape shape =
      read_content("a.obj", "f 1//1 2//1 3//1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n");
  EXPECT_EQ(shape.faces, triangles({{0, 1, 2}}));
  EXPECT_EQ(shape.normals, rows({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
}

TEST(ReadObj, NegativeNumbersCountFromWhereTheyStand) {
  const Shape shape = read_content(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf -3 -2 -1\n");
  EXPECT_EQ(shape.faces, triangles({{0, 1, 2}, {3, 4, 5}}));
}

TEST(ReadObj, NormalsOfCorners) {
  const std::string normals = "vn 0.6 0.8 0\nvn 0 0 1\nvn 1 0 0\n";
  const Shape same =
      read_content("a.obj", square + normals + "f 1//1 2//2 3//3\nf 1//1 3//3 4//2\n");
  EXPECT_EQ(same.normals, rows({{0.6, 0.8, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}}));

  const Shape mean =
      read_content("a.obj", square + normals + "f 1//2 2//2 3//2\nf 1//3 3//2 4//2\n");
  EXPECT_LE((mean.normals.row(0) - Eigen::RowVector3d(1, 0, 1).normalized()).norm(), 1e-15);

  const Shape lacking = read_content("a.obj", square + normals + "f 1//1 2//2 3//3\n");
  EXPECT_EQ(lacking.normals.rows(), 0) << "vertex 4 has none";
}

TEST(ReadObj, NormalsOfBareClouds) {
  const std::string two = "v 1 2 3\nv 4 5 6\n";
  EXPECT_EQ(read_content("a.obj", two + "vn 0 0 1\nvn 1 0 0\n").normals,
            rows({{0, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(read_content("a.obj", two + "vn 0 0 1\n").normals.rows(), 0);
  EXPECT_EQ(read_content("a.obj", two + "vn 0 0 1\nvn 0 0 0\n").normals.rows(), 0);
}

TEST(ReadObj, CommentsBehindDataAndLinesThatGoOn) {
  const Shape shape = read_content("a.obj",
                                   "v 0 0 \\\n0 # first\nv 1 0 0# second\nv 0 \\\r\n1 \\\r\n0\n"
                                   "vn 0 0 1 # up\nf 1//1 \\\n2//1\\\n3//1 # all\n");
  EXPECT_EQ(shape.points, rows({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(shape.faces, triangles({{0, 1, 2}}));
  EXPECT_EQ(shape.normals.rows(), 3);
}

TEST(ReadObj, FacesOfTwoCornersAreEdges) {
  EXPECT_EQ(read_content("a.obj", square + "f 1 2\nf 1\nf 1 2 3\n").faces, triangles({{0, 1, 2}}));
}

TEST(ReadObj, SaysWhatIsBroken) {
  const auto expect = [](const std::string& content, const std::string& reason) {
    expect_unreadable("a.obj", content, reason);
  };
  expect("hello\n", "the file holds no points");
  expect("v 1 2\n", "line 1: a coordinate is missing");
  expect("v 1 2 x\n", "line 1: a coordinate is 'x', not a number");
  expect(square + "vn 0 0\n", "line 5: a coordinate of the normal is missing");
  expect(square + "f 1 2 0\n", "line 5: a corner names vertex '0'; there are 4 so far");
  expect(square + "f 1 2 x\n", "line 5: a corner names vertex 'x'");
  expect(square + "f 1 2 /3\n", "line 5: a corner names vertex ''");
  expect(square + "f 1 2 -5\n", "line 5: a corner names vertex '-5'; there are 4 so far");
  expect(square + "f 1 2 3\nf 1 2 5\nf 1 2 3\n",
         "line 6: a corner names vertex 5; there are 4, counted from 1");
  expect(square + "vn 0 0 1\nf 1//1 2//1 3//2\n", "line 6: a corner names normal 2; there are 1");
  expect(square + "vn 0 0 1\nf 1//1 2//1 3//x\n", "line 6: a corner names normal 'x'");
}

}  // namespace
}  // namespace symsurf::read_obj_tests
