// SPDX-License-Identifier: GPL-3.0-or-later
#include "vertex_marks.h"

#include <algorithm>
#include <cmath>

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

constexpr int marked = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;

// Lengths below this share of the diagonal are rounding, which is not worth a colour.
constexpr double least_ramp = 1e-6;

double sign(double x) { return (x > 0) - (x < 0); }

// MeshLab's own ramp turns from red to blue, or the other way where its ends change places.
void colour_by_quality(MeshModel& layer, double blue, double red) {
  vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(layer.cm, red, blue);
  layer.updateDataMask(marked);
}

// One that is there may have another type.
template <typename Type>
auto new_attribute(CMeshO& mesh, const std::string& name) {
  Allocator::DeletePerVertexAttribute(mesh, name);
  return Allocator::AddPerVertexAttribute<Type>(mesh, name);
}

// The row that stands for "nothing is said" of a vertex.
double absent(const PointArray& array) { return array.type == ParameterType::Integer ? -1 : 0; }

// One value a vertex of the layer; indices of points become those of vertices.
Eigen::MatrixXd by_vertex(const CMeshO& mesh, const LayerCloud& cloud, const PointArray& array,
                          const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd all =
      Eigen::MatrixXd::Constant(static_cast<Index>(mesh.vert.size()), rows.cols(), absent(array));
  for (Index i = 0; i < rows.rows(); ++i)
    for (Index c = 0; c < rows.cols(); ++c) {
      const double value = rows(i, c);
      all(cloud.vertex[i], c) =
          array.names_points && value >= 0 ? cloud.vertex[static_cast<Index>(value)] : value;
    }
  return all;
}

void add_attribute(CMeshO& mesh, const std::string& name, const Eigen::MatrixXd& rows) {
  if (rows.cols() == 3) {
    auto attribute = new_attribute<Point3m>(mesh, name);
    for (Index i = 0; i < rows.rows(); ++i)
      attribute[i] = Point3m(rows(i, 0), rows(i, 1), rows(i, 2));
  } else {
    for (Index c = 0; c < rows.cols(); ++c) {  // MeshLab has no longer rows
      const std::string end = rows.cols() > 1 ? "_" + std::to_string(c) : "";
      auto attribute = new_attribute<Scalarm>(mesh, name + end);
      for (Index i = 0; i < rows.rows(); ++i) attribute[i] = rows(i, c);
    }
  }
}

}  // namespace

void colour_by_residual(MeshModel& layer, const Eigen::VectorXd& residuals) {
  const double largest = residuals.size() > 0 ? residuals.maxCoeff() : 0;
  colour_by_quality(layer, 0, std::max(largest, least_ramp * layer_diagonal(&layer)));
}

void mark_residuals(MeshModel& layer, const LayerCloud& cloud, const Result& result,
                    const Eigen::VectorXd& distances) {
  CMeshO& mesh = layer.cm;
  auto partner = new_attribute<Scalarm>(mesh, "partner");
  auto side = new_attribute<Scalarm>(mesh, "side");
  for (std::size_t i = 0; i < mesh.vert.size(); ++i) {
    mesh.vert[i].Q() = -1;
    partner[i] = -1;
    side[i] = 0;
  }
  for (Index i = 0; i < result.pairs.rows(); ++i) {
    const int vertex = cloud.vertex[result.pairs(i, 0)];
    mesh.vert[vertex].Q() = result.residuals[i];
    partner[vertex] = cloud.vertex[result.pairs(i, 1)];
  }
  for (Index i = 0; i < distances.size(); ++i)
    if (cloud.points.row(i).allFinite()) side[cloud.vertex[i]] = sign(distances[i]);
  colour_by_residual(layer, result.residuals);
  for (CVertexO& vertex : mesh.vert)
    if (vertex.Q() < 0) vertex.C() = vcg::Color4b::Gray;
}

void add_attributes(MeshModel& layer, const OperationResult& result) {
  for (const auto& [name, rows] : result.arrays) add_attribute(layer.cm, name, rows);
}

void show_as_quality(MeshModel& layer, const OperationResult& result) {
  const auto asymmetry = result.arrays.find("signed"),
             confidence = result.arrays.find("confidence");
  const bool is_signed = asymmetry != result.arrays.end();
  if (!is_signed && confidence == result.arrays.end()) return;
  const Eigen::VectorXd values = is_signed ? asymmetry->second : confidence->second;
  // NaN where there is no counterpart, and no confidence there.
  const auto is_known = [&](Index i) {
    return is_signed ? std::isfinite(values[i]) : values[i] > 0;
  };
  double largest = least_ramp * layer_diagonal(&layer);
  for (Index i = 0; i < values.size(); ++i) {
    layer.cm.vert[i].Q() = is_known(i) ? values[i] : 0;
    if (is_known(i)) largest = std::max(largest, std::abs(values[i]));
  }
  if (is_signed)
    colour_by_quality(layer, -largest, largest);
  else
    colour_by_quality(layer, 1, 0);
  for (Index i = 0; i < values.size(); ++i)
    if (!is_known(i)) layer.cm.vert[i].C() = vcg::Color4b::Gray;
}

void mark_analysed(MeshModel& layer, const LayerCloud& cloud, const AnalysisResult& result) {
  const Analysis& described = analysis(result.analysis);
  for (const PointArray& array : described.arrays) {
    const auto found = result.arrays.find(array.name);
    if (found == result.arrays.end()) continue;
    const Eigen::MatrixXd values = by_vertex(layer.cm, cloud, array, found->second);
    add_attribute(layer.cm, array.name, values);
    if (array.name != described.shown) continue;
    std::vector<char> is_known(layer.cm.vert.size(), 0);
    double largest = 0;
    for (Index i = 0; i < cloud.points.rows(); ++i) {
      const double value = values(cloud.vertex[i], 0);
      is_known[cloud.vertex[i]] = std::isfinite(value) && value >= 0;
      if (is_known[cloud.vertex[i]]) largest = std::max(largest, value);
    }
    for (std::size_t v = 0; v < is_known.size(); ++v)
      layer.cm.vert[v].Q() = is_known[v] ? values(static_cast<Index>(v), 0) : 0;
    colour_by_quality(layer, 0, largest > 0 ? largest : 1);
    for (std::size_t v = 0; v < is_known.size(); ++v)
      if (!is_known[v]) layer.cm.vert[v].C() = vcg::Color4b::Gray;
  }
}

}  // namespace symsurf::meshlab
