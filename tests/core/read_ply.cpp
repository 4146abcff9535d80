#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "temporary_file.h"

namespace symsurf::read_ply_tests {
namespace {

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string faces = "property list uchar int vertex_indices\n";

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

// The bytes of numbers in either order.
class Bytes {
 public:
  explicit Bytes(bool big) : big_(big) {}

  template <typename T>
  Bytes& put(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    const std::uint16_t one = 1;
    const bool native_is_big = *reinterpret_cast<const char*>(&one) == 0;
    if (big_ != native_is_big) std::reverse(bytes.begin(), bytes.end());
    text_ += bytes;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool big_;
  std::string text_;
};

TEST(ReadPly, TextWithNormalsPolygonsAndEverythingElseBesides) {
  const Shape shape = read_content(
      "all.ply", header("ascii",
                        "comment made by hand\nobj_info nothing\n"
                        "element camera 1\nproperty float view\nproperty list uchar short at\n"
                        "element vertex 5\nproperty double nx\nproperty uchar red\n" +
                            xyz +
                            "property list uchar float weights\nproperty double ny\n"
                            "property double nz\nproperty float quality\n"
                            "element face 3\nproperty uchar red\n" +
                            faces +
                            "property int flags\n"
                            "element edge 1\nproperty int vertex1\nproperty int vertex2\n") +
                     "1.5 2 7 8\n"
                     "0 255 0 0 0 2 .5 .5 0 1 nan\n"
                     "0 255 1 0 0 0 0 1 0.25\n"
                     "0 255 4000000.001 1e-3 +1 0 0 1 0.25\n"
                     "0 255 0 1 0 1 0.5 0 1 0.25\n"
                     "0.6 255 5 5 5 0 0.8 0 1\n"
                     "9 3 0 1 2 0\n9 5 0 1 2 3 4 0\n9 2 0 1 0\n"
                     "0 1\n");
  EXPECT_EQ(shape.points,
            rows({{0, 0, 0}, {1, 0, 0}, {4000000.001, 1e-3, 1}, {0, 1, 0}, {5, 5, 5}}));
  EXPECT_EQ(shape.normals, rows({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0.6, 0.8, 0}}));
  EXPECT_EQ(shape.faces, triangles({{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(ReadPly, TextOfOtherSystems) {
  std::string content = header("ascii", "element vertex 1\n" + xyz) + "\n1\t2  3 \n";
  content.insert(content.find("element"), "comment \n");
  std::string crlf;
  for (const char c : content) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_content("crlf.ply", crlf).points, rows({{1, 2, 3}}));
}

template <typename Coordinate, typename Length, typename Corner>
void expect_binary(bool big, const std::string& types) {
  const std::string format = big ? "binary_big_endian" : "binary_little_endian";
  char coordinate[16], length[16], corner[16];
  ASSERT_EQ(std::sscanf(types.c_str(), "%15s %15s %15s", coordinate, length, corner), 3);
  const std::string of = std::string("property ") + coordinate;
  Bytes bytes(big);
  const Coordinate v[][3] = {{0, 0, 0}, {100, 0, 1}, {100, 50, 2}, {0, 50, 3}};
  for (const auto& x : v)
    bytes.put(std::uint8_t{200}).put(x[0]).put(x[1]).put(x[2]).put(std::int16_t{-7});
  bytes.put(Length{4}).put(Corner{0}).put(Corner{1}).put(Corner{2}).put(Corner{3});
  bytes.put(Length{3}).put(Corner{3}).put(Corner{2}).put(Corner{0});
  const Shape shape = read_content(
      "binary.ply",
      header(format, "element vertex 4\nproperty uchar red\n" + of + " x\n" + of + " y\n" + of +
                         " z\nproperty short temperature\nelement face 2\nproperty list " + length +
                         " " + corner + " vertex_index\n") +
          bytes.text());
  EXPECT_EQ(shape.points, rows({{0, 0, 0}, {100, 0, 1}, {100, 50, 2}, {0, 50, 3}})) << types;
  EXPECT_EQ(shape.faces, triangles({{0, 1, 2}, {0, 2, 3}, {3, 2, 0}})) << types;
  EXPECT_EQ(shape.normals.rows(), 0);
}

TEST(ReadPly, BinaryOfEveryTypeAndOrder) {
  for (const bool big : {false, true}) {
    expect_binary<std::int8_t, std::int8_t, std::int8_t>(big, "char int8 char");
    expect_binary<std::uint8_t, std::uint8_t, std::uint8_t>(big, "uchar uint8 uint8");
    expect_binary<std::int16_t, std::int16_t, std::int16_t>(big, "short int16 short");
    expect_binary<std::uint16_t, std::uint16_t, std::uint16_t>(big, "ushort uint16 ushort");
    expect_binary<std::int32_t, std::int32_t, std::int32_t>(big, "int int32 int32");
    expect_binary<std::uint32_t, std::uint32_t, std::uint32_t>(big, "uint uint32 uint");
    expect_binary<float, std::uint8_t, std::int32_t>(big, "float uchar int");
    expect_binary<double, std::uint8_t, std::uint32_t>(big, "float64 uchar uint");
  }
}

TEST(ReadPly, BinaryDoublesDigitForDigit) {
  const std::string of_doubles =
      "element vertex 1\nproperty double x\nproperty double y\nproperty double z\n";
  for (const bool big : {false, true}) {
    const double x = 4000000.001, y = -1.0 / 3, z = 1e-310;
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    const Shape shape =
        read_content("d.ply", header(format, of_doubles) + Bytes(big).put(x).put(y).put(z).text());
    EXPECT_EQ(shape.points, rows({{x, y, z}}));
  }
}

TEST(ReadPly, SaysWhatIsBrokenInTheHeader) {
  const std::string vertex = "element vertex 1\n" + xyz, row = "1 2 3\n";
  expect_unreadable("a.ply", "hello\n", "this is no PLY file");
  expect_unreadable("a.ply", "ply\nformat ascii 1.0\n" + vertex, "the header is truncated");
  expect_unreadable("a.ply", "ply\n" + vertex + "end_header\n" + row, "line 6: ");
  expect_unreadable("a.ply", header("text", vertex) + row, "line 2: there is no PLY format 'text'");
  expect_unreadable("a.ply", "ply\nformat ascii 2.0\n", "line 2: PLY's version is '2.0'");
  expect_unreadable("a.ply", header("ascii", "element vertex\n" + xyz) + row, "line 3: ");
  expect_unreadable("a.ply", header("ascii", "element vertex -1\n" + xyz) + row, "line 3: ");
  expect_unreadable("a.ply", header("ascii", "element vertex 1.5\n" + xyz) + row,
                    "line 3: the count of the element 'vertex' is '1.5', not an integer");
  expect_unreadable("a.ply", header("ascii", "element vertex 1\nproperty real x\n") + row,
                    "line 4: PLY has no type 'real'");
  expect_unreadable("a.ply", header("ascii", xyz + "element vertex 1\n") + row,
                    "line 3: a property stands before any element");
  expect_unreadable("a.ply", header("ascii", vertex + "proper float w\n") + row,
                    "line 7: PLY headers have no 'proper'");
  expect_unreadable("a.ply", header("ascii", vertex + "property list float int vertex_indices\n"),
                    "line 7: a list's length");
  expect_unreadable("a.ply", header("ascii", "element vertex 1\nproperty float x\n") + "1\n",
                    "the element 'vertex' lacks x, y or z");
  expect_unreadable("a.ply", header("ascii", "element face 0\n" + faces),
                    "the file holds no points");
  expect_unreadable("a.ply", header("ascii", "element vertex 0\n" + xyz),
                    "the file holds no points");
}

TEST(ReadPly, SaysWhatIsBrokenInTheText) {
  const auto expect = [](const std::string& body, const std::string& reason) {
    const std::string elements = "element vertex 3\n" + xyz + "element face 1\n" + faces;
    expect_unreadable("a.ply", header("ascii", elements) + body, reason);
  };
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  expect("0 0 0\n1 0 0\n",
         "the file is truncated: it ends at row 2 of the 3 of the element 'vertex'");
  expect(vertices, "the file is truncated: it ends at row 0 of the 1 of the element 'face'");
  expect("0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "line 12: the row is longer than the header says");
  expect("0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "line 11: y is 'zero', not a number");
  expect("0 0 0\n1 0x1 0\n0 1 0\n3 0 1 2\n", "line 11: y is '0x1', not a number");
  expect(vertices + "3 0 1 3\n", "line 13: a face names vertex 3; there are 3, counted from 0");
  expect(vertices + "3 0 1 -1\n", "line 13: a face names vertex -1");
  expect(vertices + "3 0 1 1.5\n", "line 13: vertex_indices holds 1.5, not an index");
  expect(vertices + "3 0 1\n", "line 13: vertex_indices is missing");
  expect(vertices + "-3 0 1 2\n", "line 13: the list vertex_indices has a length below 0");
  expect(vertices + "2 0 1 2\n", "line 13: the row is longer");
}

TEST(ReadPly, SaysWhatIsBrokenInTheBinary) {
  const std::string head =
      header("binary_little_endian", "element vertex 2\n" + xyz + "element face 1\n" + faces);
  const auto body = [](float z, std::int32_t corner) {
    Bytes bytes(false);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 2.f, z}) bytes.put(x);
    return bytes.put(std::uint8_t{3}).put(std::int32_t{0}).put(std::int32_t{1}).put(corner).text();
  };
  EXPECT_EQ(read_content("a.ply", head + body(3, 1)).points, rows({{0, 0, 0}, {1, 2, 3}}));
  EXPECT_TRUE(std::isnan(read_content("a.ply", head + body(std::nanf(""), 1)).points(1, 2)));
  expect_unreadable("a.ply", head + body(3, 2),
                    "row 0 of the element 'face': a face names vertex 2");
  const std::string whole = head + body(3, 1);
  for (std::size_t size = head.size(); size < whole.size(); ++size)
    expect_unreadable("a.ply", whole.substr(0, size), "the file is truncated: it ends at row ");
}

TEST(ReadPly, DoesNotTrustCounts) {
  expect_unreadable("a.ply",
                    header("binary_little_endian", "element vertex 9000000000000000000\n" + xyz),
                    "the file is truncated");
  expect_unreadable("a.ply",
                    header("ascii", "element vertex 9000000000000000000\n" + xyz) + "1 2 3",
                    "the file is truncated");
  const std::string lists = "element vertex 1\nproperty list uint int extra\n" + xyz;
  expect_unreadable("a.ply", header("binary_little_endian", lists) + "\xff\xff\xff\xff",
                    "the file is truncated");
}

// Each line starts a row; a vertex may have more numbers there than the header names.
TEST(ReadPly, TextRowsOverLinesAndLongerOnes) {
  const std::string head = header("ascii", "element vertex 3\n" + xyz + "element face 1\n" + faces);
  const Points corners = rows({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const char* body : {"0\n0\n0\n1 0\n0\n0 1 0\n3\n0 1\n2\n",
                           "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n"}) {
    const Shape shape = read_content("a.ply", head + body);
    EXPECT_EQ(shape.points, corners) << body;
    EXPECT_EQ(shape.faces, triangles({{0, 1, 2}})) << body;
  }
}

TEST(ReadPly, OldLineEnds) {
  std::string text = header("ascii", "element vertex 1\n" + xyz) + "1 2 3\n";
  std::replace(text.begin(), text.end(), '\n', '\r');
  EXPECT_EQ(read_content("a.ply", text).points, rows({{1, 2, 3}}));
}

// Every second triangle of a strip is wound the other way round, so that all face one way.
TEST(ReadPly, TriangleStrips) {
  const std::string vertices = "element vertex 6\n" + xyz,
                    points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  const std::string strips =
      vertices + "element tristrips 1\nproperty list int int vertex_indices\n";
  EXPECT_EQ(read_content("a.ply", header("ascii", strips) + points + "6 0 1 2 3 4 5\n").faces,
            triangles({{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}));
  EXPECT_EQ(read_content("a.ply", header("ascii", strips) + points + "8 0 1 2 3 -1 3 4 5\n").faces,
            triangles({{0, 1, 2}, {2, 1, 3}, {3, 4, 5}}));
  expect_unreadable("a.ply", header("ascii", strips) + points + "4 0 1 2 -2\n",
                    "line 16: a face names vertex -2");
}

TEST(ReadPly, DropsNoSurfaceWithoutAWord) {
  const std::string points = "element vertex 3\n" + xyz;
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read_content("a.ply", header("ascii", points + "element polygon 1\n" + faces) + body)
                .faces.rows(),
            1);
  expect_unreadable(
      "a.ply", header("ascii", points + "element face 1\nproperty list uchar int corners\n") + body,
      "the element 'face' lacks the list vertex_indices or vertex_index");
}

// The sum of such counts is more than an index holds.
TEST(ReadPly, RefusesAnElementThatStandsTwice) {
  const std::string vertices = "element vertex 6666661000000000000\n" + xyz;
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    expect_unreadable("a.ply", header(format, vertices + vertices),
                      "line 7: the element 'vertex' stands there twice");
  expect_unreadable("a.ply", header("ascii", "element\n"), "line 3: the element's name is missing");
}

}  // namespace
}  // namespace symsurf::read_ply_tests
