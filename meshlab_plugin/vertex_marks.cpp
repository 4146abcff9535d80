// SPDX-License-Identifier: GPL-3.0-or-later
#include "vertex_marks.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace symsurf::meshlab {

namespace {

using Allocator = vcg::tri::Allocator<CMeshO>;

constexpr int marked = MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR;

// Lengths below this share of the diagonal are rounding, which is not worth a colour.
constexpr double least_ramp = 1e-6;

// Brighter points are red, too: caustics are thin and know no bounds.
constexpr double bright = 0.98;

// 0 of nothing.
double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto nth = values.begin() + static_cast<Index>(share * (values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

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
  const std::string& shown = operation(result.operation).shown;
  if (result.arrays.count(shown) == 0) return;
  const Eigen::VectorXd values = result.arrays.at(shown);
  const bool is_confidence = shown == "confidence";
  // NaN where there is no counterpart, and no confidence there.
  const auto is_known = [&](Index i) {
    return std::isfinite(values[i]) && (!is_confidence || values[i] > 0);
  };
  std::vector<double> sizes;
  for (Index i = 0; i < values.size(); ++i) {
    layer.cm.vert[i].Q() = is_known(i) ? values[i] : 0;
    if (is_known(i)) sizes.push_back(std::abs(values[i]));
  }
  if (is_confidence)
    colour_by_quality(layer, 1, 0);
  else if (shown == "signed") {
    const double largest = std::max(least_ramp * layer_diagonal(&layer), quantile_of(sizes, 1));
    colour_by_quality(layer, -largest, largest);
  } else {
    const double most = quantile_of(sizes, bright);
    colour_by_quality(layer, 0, most > 0 ? most : 1);
  }
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
