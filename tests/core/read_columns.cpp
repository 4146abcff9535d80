#include <gtest/gtest.h>

#include "temporary_file.h"

namespace symsurf::read_columns_tests {
namespace {

const Points points = rows({{1, 2, 3}, {4000000.001, -5.5e-3, 6}});
const Points normals = rows({{0, 0, 1}, {0.6, 0.8, 0}});

TEST(ReadColumns, WhateverSeparates) {
  for (const char* name : {"a.xyz", "a.csv", "a.txt", "a.TXT"})
    for (const char* content :
         {"1 2 3\n4000000.001 -5.5e-3 6\n", "1\t2\t3\n4000000.001\t-5.5e-3\t6\n",
          "  1   2 3 \r\n 4000000.001 \t -5.5e-3 +6", "1,2,3\n4000000.001,-5.5e-3,6\n",
          "1, 2 , 3\n4000000.001,\t-5.5e-3, 6\n", "1;2;3\n4000000.001;-5.5e-3;6\n",
          "1,2,3,\n4000000.001,-5.5e-3,6,\n"}) {
      const Shape shape = read_content(name, content);
      EXPECT_EQ(shape.points, points) << content;
      EXPECT_EQ(shape.normals.rows(), 0) << content;
      EXPECT_EQ(shape.faces.rows(), 0) << content;
    }
}

TEST(ReadColumns, CommentsAndBlankLines) {
  EXPECT_EQ(read_content("a.txt",
                         "\xef\xbb\xbf# x y z\n\n//X Y Z\n1 2 3\n  # between\n\n"
                         "4000000.001 -5.5e-3 6\n# end")
                .points,
            points);
}

TEST(ReadColumns, NamesInAnyOrder) {
  for (const char* content :
       {"x,y,z\n1,2,3\n4000000.001,-5.5e-3,6\n", "X Y Z\n1 2 3\n4000000.001 -5.5e-3 6\n",
        "\"id\";\"z\";\"x\";\"y\"\np;3;1;2\nq;6;4000000.001;-5.5e-3\n",
        ",x,y,z,r,g,b\n0,1,2,3,9,9,9\n1,4000000.001,-5.5e-3,6,9,9,9\n",
        "\"Temp\",\"Points:0\",\"Points:1\",\"Points:2\"\n7,1,2,3\n,4000000.001,-5.5e-3,6\n"}) {
    const Shape shape = read_content("a.csv", content);
    EXPECT_EQ(shape.points, points) << content;
    EXPECT_EQ(shape.normals.rows(), 0) << content;
  }
}

TEST(ReadColumns, Normals) {
  for (const char* content :
       {"1 2 3 0 0 1\n4000000.001 -5.5e-3 6 0.6 0.8 0\n",
        "x,y,z,nx,ny,nz\n1,2,3,0,0,1\n4000000.001,-5.5e-3,6,0.6,0.8,0\n",
        "nx,ny,nz,q,x,y,z\n0,0,1,7,1,2,3\n0.6,0.8,0,7,4000000.001,-5.5e-3,6\n",
        "Normals:0,Normals:1,Normals:2,Points:0,Points:1,Points:2\n0,0,1,1,2,3\n"
        "0.6,0.8,0,4000000.001,-5.5e-3,6\n"}) {
    const Shape shape = read_content("a.csv", content);
    EXPECT_EQ(shape.points, points) << content;
    EXPECT_EQ(shape.normals, normals) << content;
  }
}

TEST(ReadColumns, OtherColumnsAreNoNormals) {
  for (const char* content :
       {"1 2 3 255 0 12\n4000000.001 -5.5e-3 6 0 0 1\n", "1 2 3 0\n4000000.001 -5.5e-3 6 1\n",
        "1 2 3 0 0 1 7\n4000000.001 -5.5e-3 6 0 0 1 tree\n",
        "1 2 3 0 0 1\n4000000.001 -5.5e-3 6 0 0 0\n",
        "x y z nx ny\n1 2 3 0 0\n4000000.001 -5.5e-3 6 0 0\n"}) {
    const Shape shape = read_content("a.txt", content);
    EXPECT_EQ(shape.points, points) << content;
    EXPECT_EQ(shape.normals.rows(), 0) << content;
  }
}

TEST(ReadColumns, NamesInComments) {
  for (const char* content :
       {"# file version = 4.11\n# columns = "
        "id,x,y,z,label\n1,1,2,3,\n2,4000000.001,-5.5e-3,6,F-2\n",
        "//X,Y,Z,R,G,B\n1,2,3,9,9,9\n4000000.001,-5.5e-3,6,9,9,9\n",
        "# id x y z\n1 1 2 3\n2 4000000.001 -5.5e-3 6\n", "# x y z\n1,2,3\n4000000.001,-5.5e-3,6\n",
        "#z,y,x\n3,2,1\n6,-5.5e-3,4000000.001\n"})
    EXPECT_EQ(read_content("a.csv", content).points, points) << content;
  EXPECT_EQ(read_content("a.txt", "//X Y Z Nx Ny Nz\n1 2 3 0 0 1\n4000000.001 -5.5e-3 6 .6 .8 0\n")
                .normals,
            normals);
}

TEST(ReadColumns, TablesOfManyWriters) {
  for (const char* content :
       {"2\n1 2 3\n4000000.001 -5.5e-3 6\n", "2\nx y z\n1 2 3\n4000000.001 -5.5e-3 6\n",
        "2\nwater, at rest\nO 1 2 3\nH 4000000.001 -5.5e-3 6\n",
        "2\n\nO 1 2 3\nH 4000000.001 -5.5e-3 6\n",
        "name,x,y,z\n\"left, above\",1,2,3\n\"right\",4000000.001,-5.5e-3,6\n",
        "\"x\" \"y\" \"z\"\n\"1\" 1 2 3\n\"2\" 4000000.001 -5.5e-3 6\n",
        "x,y,z,note\n1,2,3,\n4000000.001,-5.5e-3,6,far\n", "1,0;2,0;3,0\n4000000,001;-5,5e-3;6\n",
        "x;y;z\n1,0;2,0;3\n4000000,001;-5,5e-3;6,0\n", "1,0\t2,0\t3,0\n4000000,001\t-5,5e-3\t6\n",
        "1,0 2,0 3,0\n4000000,001 -5,5e-3 6,0\n",
        "X [mm],Y [mm],Z [mm]\n1,2,3\n4000000.001,-5.5e-3,6\n",
        "X [mm] Y [mm] Z [mm]\n1 2 3\n4000000.001 -5.5e-3 6\n",
        "x(mm);y(mm);z(mm)\n1;2;3\n4000000.001;-5.5e-3;6\n",
        "Points_0,Points_1,Points_2\n1,2,3\n4000000.001,-5.5e-3,6\n",
        "1 2 3\r4000000.001 -5.5e-3 6\r"})
    EXPECT_EQ(read_content("a.csv", content).points, points) << content;
}

// Which of the columns are x, y and z?
TEST(ReadColumns, RefusesToGuess) {
  expect_unreadable("a.csv", "1,10,20,30\n2,11,21,31\n3,12,22,32\n",
                    "the first of 4 columns without names counts the rows");
  expect_unreadable("a.xyz", "0 1 2 3 9\n1 4 5 6 9\n2 7 8 9 9\n",
                    "the first of 5 columns without names counts the rows");
  EXPECT_EQ(read_content("a.xyz", "0 1 2\n1 4 5\n2 7 8\n").points.rows(), 3);
}

TEST(ReadColumns, NumbersOfEveryKind) {
  const Shape shape =
      read_content("a.xyz", "1e-320 -.5 5.\n1E3 -0 1e-999\n0.1 1.7976931348623157e308 2.5e-1\n");
  EXPECT_EQ(shape.points,
            rows({{1e-320, -.5, 5}, {1000, 0, 0}, {0.1, 1.7976931348623157e308, .25}}));
}

TEST(ReadColumns, SaysWhatIsBroken) {
  const auto expect = [](const std::string& content, const std::string& reason) {
    expect_unreadable("a.csv", content, reason);
  };
  expect("# nothing\n\n", "the file holds only blank lines and comments");
  expect("x,y,z\n", "the file holds no points");
  expect("hello world\n", "line 1: the row starts with 'hello'");
  expect("a,b,c\n1,2,3\n", "line 1: the row starts with 'a': it is neither numbers nor names");
  expect("\n1 2\n", "line 2: the row has 2 columns; at least 3 are needed");
  expect("1 2 3\n4 5\n", "line 2: z is missing");
  expect("1,2,3\n4,,6\n", "line 2: y is missing");
  expect("1,2,3\n,5,6\n", "line 2: x is missing");
  expect("1 2 3\n4 5 six\n", "line 2: z is 'six', not a number");
  expect("5\n1 2 3\n", "line 1: the row has 1 column, and is no number of rows: there are 1 more");
  expect("1 2 3\n4 5 6 7\n", "line 2: the row has more columns than the first one");
  expect("1 2 3 7\n4 5 6\n", "line 2: the row has fewer columns than the first one");
  expect(std::string("1 2 a\0\xff", 7), "line 1: z is 'a\?\?', not a number");
}

}  // namespace
}  // namespace symsurf::read_columns_tests
