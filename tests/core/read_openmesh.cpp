// What an independent library writes is read as it was.

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <set>

#include "random_cloud.h"
#include "temporary_file.h"

namespace symsurf::read_openmesh_tests {
namespace {

using OpenMesh::IO::Options;
using TriMesh = OpenMesh::TriMesh_ArrayKernelT<>;

constexpr int columns = 7, rings = 12;

// A bumpy patch of a sphere with its normals.
TriMesh patch() {
  RandomCloud random(0);
  TriMesh mesh;
  mesh.request_vertex_normals();
  std::vector<TriMesh::VertexHandle> vertices;
  for (int r = 0; r < rings; ++r)
    for (int c = 0; c < columns; ++c) {
      const Eigen::Vector3f x =
          (Vector3(c, r, 20).normalized() * random.uniform(10, 10.2)).cast<float>();
      vertices.push_back(mesh.add_vertex({x[0], x[1], x[2]}));
      const Eigen::Vector3f n = x.normalized();
      mesh.set_normal(vertices.back(), {n[0], n[1], n[2]});
    }
  for (int r = 0; r + 1 < rings; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = r * columns + c;
      mesh.add_face(vertices[a], vertices[a + 1], vertices[a + columns + 1]);
      mesh.add_face(vertices[a], vertices[a + columns + 1], vertices[a + columns]);
    }
  return mesh;
}

Shape written_and_read(TriMesh& mesh, const std::string& name, Options options) {
  const TemporaryFile file(name, "");
  constexpr int digits_of_float = 9;
  EXPECT_TRUE(OpenMesh::IO::write_mesh(mesh, file.path().string(), options, digits_of_float));
  return read(file.path());
}

Vector3 of(const OpenMesh::Vec3f& x) { return {x[0], x[1], x[2]}; }

// The triangles as coordinates, each from its least corner on: whatever the numbering.
using Corners = std::array<std::array<double, 3>, 3>;
void insert(std::multiset<Corners>& triangles, Corners corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  triangles.insert(corners);
}

void expect_same_triangles(TriMesh& mesh, const Shape& shape) {
  std::multiset<Corners> written, found;
  for (const auto face : mesh.faces()) {
    Corners corners;
    int c = 0;
    for (const auto vertex : face.vertices()) {
      const Vector3 x = of(mesh.point(vertex));
      corners[c++] = {x.x(), x.y(), x.z()};
    }
    insert(written, corners);
  }
  for (Index f = 0; f < shape.faces.rows(); ++f) {
    Corners corners;
    for (int c = 0; c < 3; ++c)
      for (int axis = 0; axis < 3; ++axis)
        corners[c][axis] = static_cast<float>(shape.points(shape.faces(f, c), axis));
    insert(found, corners);
  }
  EXPECT_EQ(found, written);
}

TEST(ReadOpenMesh, WhatItWrites) {
  TriMesh mesh = patch();
  ::omlog().disable();  // "write file"
  const Options plain, binary(Options::Binary), swapped(Options::Binary | Options::MSB);
  struct Case {
    const char* name;
    Options options;
    bool has_normals;
  };
  for (const Case& c :
       {Case{"a.ply", plain, true}, Case{"a.ply", binary, true}, Case{"a.ply", swapped, true},
        Case{"a.off", plain, true}, Case{"a.obj", plain, true}, Case{"a.stl", plain, false},
        Case{"a.stl", binary, false}}) {
    SCOPED_TRACE(c.name);
    Options options = c.options;
    if (c.has_normals) options += Options::VertexNormal;
    const Shape shape = written_and_read(mesh, c.name, options);
    ASSERT_EQ(shape.points.rows(), static_cast<Index>(mesh.n_vertices()));
    expect_same_triangles(mesh, shape);
    if (!c.has_normals) continue;
    ASSERT_EQ(shape.normals.rows(), shape.points.rows());
    for (const auto vertex : mesh.vertices()) {
      const Vector3 x = shape.points.row(vertex.idx()), n = shape.normals.row(vertex.idx());
      EXPECT_LE((x - of(mesh.point(vertex))).norm(), 1e-7 * x.norm());
      EXPECT_LE((n - of(mesh.normal(vertex))).norm(), 1e-7);
    }
  }
}

TEST(ReadOpenMesh, BinaryOffIsRefused) {
  TriMesh mesh = patch();
  expect_error<InvalidInput>("line 1: binary OFF cannot be read",
                             [&] { written_and_read(mesh, "a.off", Options(Options::Binary)); });
}

}  // namespace
}  // namespace symsurf::read_openmesh_tests
