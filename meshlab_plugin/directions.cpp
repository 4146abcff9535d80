// SPDX-License-Identifier: GPL-3.0-or-later
#include "directions.h"

#include <vector>

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

template <typename Of>
Eigen::MatrixXd rows_of(const CMeshO& mesh, const Of& of) {
  Eigen::MatrixXd rows(mesh.vert.size(), 3);
  for (Index i = 0; i < rows.rows(); ++i)
    for (int c = 0; c < 3; ++c) rows(i, c) = of(static_cast<std::size_t>(i))[c];
  return rows;
}

template <typename Of>
void set_rows(const Eigen::MatrixXd& rows, const Of& of) {
  for (Index i = 0; i < rows.rows(); ++i)
    of(static_cast<std::size_t>(i)) = Point3m(rows(i, 0), rows(i, 1), rows(i, 2));
}

}  // namespace

Directions::Directions(CMeshO& mesh) {
  if (mesh.fn == 0) normals_ = rows_of(mesh, [&](std::size_t i) { return mesh.vert[i].cN(); });
  std::vector<std::string> names;
  Allocator::GetAllPerVertexAttribute<Point3m>(mesh, names);
  for (const std::string& name : names) {
    auto attribute = Allocator::GetPerVertexAttribute<Point3m>(mesh, name);
    vectors_[name] = rows_of(mesh, [&](std::size_t i) { return attribute[i]; });
  }
}

void Directions::carry(const AttributeTransform& by) {
  if (normals_.rows() > 0) normals_ = by(normals_, AttributeKind::Normal);
  for (auto& [name, rows] : vectors_) rows = by(rows, AttributeKind::Vector);
}

void Directions::set(CMeshO& mesh) const {
  set_rows(normals_, [&](std::size_t i) -> Point3m& { return mesh.vert[i].N(); });
  for (const auto& [name, rows] : vectors_) {
    auto attribute = Allocator::GetPerVertexAttribute<Point3m>(mesh, name);
    set_rows(rows, [&](std::size_t i) -> Point3m& { return attribute[i]; });
  }
}

}  // namespace symsurf::meshlab
