// SPDX-License-Identifier: GPL-3.0-or-later
#include "returned_values.h"

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <limits>

namespace symsurf::meshlab {

namespace {

// Of two figures of one name the first stands.
Values figures(const Result& result) {
  Values all{{"score", result.score},
             {"pairs", static_cast<Index>(result.pairs.rows())},
             {"candidates", static_cast<Index>(result.candidates.size())},
             {"seconds", result.seconds},
             {"found", result.verdict() == "found"}};
  if (result.mirror) {
    all.emplace("kind", std::string(result.mirror->kind()));
    all.merge(result.mirror->numbers());
    if (const auto plane = std::dynamic_pointer_cast<const Plane>(result.mirror))
      all.emplace("matrix", Eigen::MatrixXd(plane->matrix()));
  }
  all.merge(Values(result.statistics));
  return all;
}

template <typename Matrix>
QVariant square(const Eigen::MatrixXd& m) {
  Matrix out;
  for (int row = 0; row < m.rows(); ++row)
    for (int column = 0; column < m.cols(); ++column) out[row][column] = m(row, column);
  return QVariant::fromValue(out);
}

QVariant row_by_row(const Eigen::MatrixXd& m) {
  const Eigen::MatrixXd columns = m.transpose();
  return QVariant::fromValue(
      Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(columns.data(), columns.size())));
}

// Matrices small enough to be read are written out.
std::string logged(const Value& value) {
  const auto* matrix = std::get_if<Eigen::MatrixXd>(&value);
  if (!matrix || matrix->size() > 16) return to_string(value);
  std::string text;
  for (const auto& row : matrix->rowwise()) {
    text += text.empty() ? "(" : "; ";
    for (Index i = 0; i < row.size(); ++i)
      text += (i > 0 ? ", " : "") + to_string(Value(static_cast<double>(row[i])));
  }
  return text + ")";
}

struct ToVariant {
  std::optional<QVariant> operator()(bool v) const { return QVariant(v); }
  std::optional<QVariant> operator()(Index v) const {
    if (v < std::numeric_limits<int>::min() || v > std::numeric_limits<int>::max())
      return QVariant(static_cast<double>(v));
    return QVariant(static_cast<int>(v));
  }
  std::optional<QVariant> operator()(double v) const { return QVariant(v); }
  std::optional<QVariant> operator()(const std::string&) const { return std::nullopt; }
  std::optional<QVariant> operator()(const Vector3& v) const {
    return QVariant::fromValue(Point3m(v.x(), v.y(), v.z()));
  }
  // Other shapes than MeshLab's two go row by row.
  std::optional<QVariant> operator()(const Eigen::MatrixXd& v) const {
    if (v.rows() == 4 && v.cols() == 4) return square<Matrix44m>(v);
    if (v.rows() == 3 && v.cols() == 3) return square<Matrix33m>(v);
    return row_by_row(v);
  }
};

}  // namespace

std::optional<QVariant> to_variant(const Value& value) { return std::visit(ToVariant{}, value); }

std::map<std::string, QVariant> returned_values(const Values& values) {
  std::map<std::string, QVariant> returned;
  for (const auto& [name, value] : values)
    if (const auto variant = to_variant(value)) returned.emplace(name, *variant);
  return returned;
}

std::vector<std::string> logged_values(const Values& values) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : values) lines.push_back(name + ": " + logged(value));
  return lines;
}

std::map<std::string, QVariant> returned_values(const Result& result) {
  std::map<std::string, QVariant> returned = returned_values(figures(result));
  // The same shape for any number of candidates: three normals are no 3 x 3 matrix.
  for (const auto& [name, value] : candidate_values(result))
    returned.emplace(name, row_by_row(std::get<Eigen::MatrixXd>(value)));
  return returned;
}

std::vector<std::string> logged_values(const Result& result) {
  Values all = figures(result);
  all.merge(candidate_values(result));
  return logged_values(all);
}

}  // namespace symsurf::meshlab
