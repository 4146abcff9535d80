#include <gtest/gtest.h>
#ifndef _WIN32
#include <sys/mman.h>
#include <sys/resource.h>
#endif

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "temporary_file.h"

namespace symsurf::read_files_tests {
namespace {

using namespace std::string_literals;

struct Sample {
  const char* name;
  std::string content;
  bool says_its_length;  ///< a cut that takes more than the last line is seen
};

std::vector<Sample> samples() {
  return {{"a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
           "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
           true},
          {"b.ply",
           "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\n"
           "property char y\nproperty char z\nelement face 1\n"
           "property list uchar uchar vertex_index\nend_header\n"s +
               "\0\0\0\1\0\0\0\1\0\3\0\1\2"s,
           true},
          {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", true},
          {"a.stl",
           "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
           "endloop\nendfacet\nendsolid a\n",
           true},
          {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n", false},
          {"a.xyz", "0 0 0\n1 0 0\n0 1 0\n", false},
          {"a.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n", false}};
}

// Reads, and allows nothing but a sound shape or an InvalidInput of the file's name.
bool reads_soundly(const std::string& name, const std::string& content) {
  try {
    const Shape shape = read_content(name, content);
    EXPECT_GT(shape.points.rows(), 0);
    for (Index i = 0; i < shape.normals.rows(); ++i)
      EXPECT_TRUE(shape.normals.row(i).allFinite() || !shape.points.row(i).allFinite());
    EXPECT_TRUE(shape.normals.rows() == 0 || shape.normals.rows() == shape.points.rows());
    if (shape.faces.rows() > 0) {
      EXPECT_GE(shape.faces.minCoeff(), 0);
      EXPECT_LT(shape.faces.maxCoeff(), shape.points.rows());
    }
    return true;
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find(name + ": "), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return false;
  }
}

// What a scanner writes where it saw nothing is kept, for whoever uses the points to leave out.
TEST(ReadFiles, PointsThatAreNotFinite) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\nnan -inf 1e999\n";
  std::string stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex nan -inf inf\n"
      "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  for (const auto& [name, content] :
       {std::pair<std::string, std::string>{"a.xyz", "1 2 3\nnan -inf 1e400\n"},
        {"a.csv", "x,y,z\n1,2,3\nnan,-inf,inf\n"},
        {"a.obj", "v 1 2 3\nv nan -inf inf\n"},
        {"a.off", "OFF\n2 0 0\n1 2 3\nnan -inf inf\n"},
        {"a.ply", ply},
        {"a.stl", stl}}) {
    const Points points = read_content(name, content).points;
    ASSERT_GE(points.rows(), 2) << name;
    EXPECT_EQ(Vector3(points.row(0)), Vector3(1, 2, 3)) << name;
    EXPECT_TRUE(std::isnan(points(1, 0))) << name;
    EXPECT_EQ(points(1, 1), -std::numeric_limits<double>::infinity()) << name;
    EXPECT_EQ(points(1, 2), std::numeric_limits<double>::infinity()) << name;
  }
}

TEST(ReadFiles, NormalsOfFinitePointsAreAllThereOrNone) {
  EXPECT_EQ(read_content("a.xyz", "1 2 3 0 0 1\nnan 5 6 nan 0 0\n").normals.rows(), 2);
  EXPECT_EQ(read_content("a.xyz", "1 2 3 0 0 1\n4 5 6 nan 0 0\n").normals.rows(), 0);
  EXPECT_EQ(read_content("a.xyz", "1 2 3 0 0 1\n4 5 6 0 0 inf\n").normals.rows(), 0);
}

TEST(ReadFiles, WholeOnes) {
  for (const Sample& sample : samples())
    EXPECT_TRUE(reads_soundly(sample.name, sample.content)) << sample.name;
}

TEST(ReadFiles, CutAnywhere) {
  for (const Sample& sample : samples()) {
    const std::size_t last_line = sample.content.rfind('\n', sample.content.size() - 2);
    for (std::size_t size = 0; size < sample.content.size(); ++size) {
      SCOPED_TRACE(sample.name + (" cut at " + std::to_string(size)));
      const bool read = reads_soundly(sample.name, sample.content.substr(0, size));
      EXPECT_FALSE(read && sample.says_its_length && size <= last_line);
    }
  }
}

TEST(ReadFiles, WithAnyByteChanged) {
  for (const Sample& sample : samples()) {
    std::mt19937 random(0);
    for (std::size_t at = 0; at < sample.content.size(); ++at)
      for (const int byte : {0, 10, 32, 45, 57, 255, static_cast<int>(random() % 256)}) {
        std::string content = sample.content;
        content[at] = static_cast<char>(byte);
        SCOPED_TRACE(content);
        reads_soundly(sample.name, content);
      }
  }
}

TEST(ReadFiles, ThatAreNone) {
  expect_error<InvalidInput>("nowhere.ply: there is no such file", [] { read("nowhere.ply"); });
  expect_unreadable("a.vtk", "# vtk",
                    "suffix '.vtk' is none of .ply .obj .off .stl .xyz .csv .txt");
  expect_unreadable("a", "1 2 3", "suffix '' is none of");
  for (const Sample& sample : samples()) expect_unreadable(sample.name, "", "the file is empty");
  const auto folder = temporary_path("folder.ply");
  std::filesystem::create_directory(folder);
  expect_error<InvalidInput>("folder.ply: this is not a file", [&] { read(folder); });
  std::filesystem::remove(folder);
}

// Files of holes, which take no room on the disk.
TEST(ReadFiles, LargerThanTheMemory) {
  constexpr std::uintmax_t size = 8'000'000'000'000;
  for (const char* suffix : {".ply", ".obj", ".off", ".stl", ".xyz", ".csv", ".txt"}) {
    const TemporaryFile file(std::string("holes") + suffix, "");
    std::error_code error;
    std::filesystem::resize_file(file.path(), size, error);
    if (error) GTEST_SKIP() << "no file may have " << size << " bytes: " << error.message();
    expect_error<InvalidInput>(
        std::string("holes") + suffix + ": the file has 8000000000000 bytes; allowed are at most ",
        [&] { read(file.path()); });
  }
}

#ifndef _WIN32

// What a process may have can be less than the machine's memory.
TEST(ReadFiles, LargerThanTheProcessMayBe) {
  const auto read_with = [](rlim_t memory, const std::string& said) {
    const TemporaryFile file("holes.xyz", "");
    std::filesystem::resize_file(file.path(), 900'000'000);
    const rlimit limit{memory, memory};
    setrlimit(RLIMIT_AS, &limit);
    expect_error<InvalidInput>("holes.xyz: " + said, [&] { read(file.path()); });
    std::exit(testing::Test::HasFailure());
  };
  EXPECT_EXIT(
      read_with(1'000'000'000, "the file has 900000000 bytes; allowed are at most 500000000"),
      testing::ExitedWithCode(0), "");
  // Half of the memory is too little beside what the process has already.
  const auto read_beside = [&] {
    mmap(nullptr, 1'200'000'000, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    read_with(1'900'000'000, "what the file holds does not fit into the memory");
  };
  EXPECT_EXIT(read_beside(), testing::ExitedWithCode(0), "");
}

#endif

TEST(ReadFiles, WithSuffixesInCapitals) {
  EXPECT_EQ(read_content("A.XYZ", "1 2 3\n").points, rows({{1, 2, 3}}));
  EXPECT_EQ(read_content("A.Obj", "v 1 2 3\n").points, rows({{1, 2, 3}}));
}

}  // namespace
}  // namespace symsurf::read_files_tests
