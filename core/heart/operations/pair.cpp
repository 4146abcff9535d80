#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/triangle_mesh.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

// Two shapes as one.
class TwoShapes {
 public:
  TwoShapes(const OperationInput& given, const Matrix4& map)
      : given_(given), plane_(beside(given, map)) {
    const Index own = given.points.size(), faces = given.faces.size();
    points_.resize(own + given.other.size(), 3);
    const Points laid = laid_back(given, map);
    points_ << given.points.matrix(), plane_.reflect(laid);
    faces_.resize(faces + given.other_faces.size(), 3);
    const auto matrix = [](TrianglesView all) {
      return Eigen::Map<const Triangles>(all.data(), all.size(), 3);
    };
    faces_ << matrix(given.faces), matrix(given.other_faces).array() + own;
    turned_ = are_wound_apart(given, laid);
    if (turned_) swap_corners(faces_.bottomRows(given.other_faces.size()));
    input_ = given;
    input_.points = points_;
    input_.faces = faces_;
    input_.own_points = own;
  }
  TwoShapes(const TwoShapes&) = delete;
  TwoShapes& operator=(const TwoShapes&) = delete;

  const OperationInput& input() const { return input_; }
  const Plane& plane() const { return plane_; }

  // Makes the result for both that for the first.
  void map_back(const Operation& operation, OperationResult& result) const {
    const auto is_others = [&](Index i) { return i >= given_.points.size() && i < points_.rows(); };
    std::vector<Index> points, faces;
    for (Index i = 0; i < result.points.rows(); ++i)
      if (!is_others(i)) points.push_back(i);
    for (Index f = 0; f < result.faces.rows(); ++f)
      if (const auto corner = result.faces.row(f);
          std::none_of(corner.begin(), corner.end(), is_others))
        faces.push_back(f);
    for (const PointArray& array : operation.arrays) {
      const auto found = result.arrays.find(array.name);
      if (found == result.arrays.end()) continue;
      Eigen::MatrixXd& rows = found->second;
      rows = Eigen::MatrixXd(rows(points, Eigen::indexing::all));
      if (turned_ && array.name == "weights") swap_corners(rows);
      if (!array.names_points && !array.names_faces) continue;
      const Index own = array.names_points ? given_.points.size() : given_.faces.size();
      rows = rows.unaryExpr([&](double i) { return std::max(-1.0, i - static_cast<double>(own)); });
    }
    result.points = Points(result.points(points, Eigen::indexing::all));
    const Index gone = given_.other.size();
    result.faces = Triangles(result.faces(faces, Eigen::indexing::all)).unaryExpr([&](Index i) {
      return i < points_.rows() ? i : i - gone;
    });
    set_sources(result);
  }

 private:
  // The second shape where it lies on the first, mirrored.
  static Points laid_back(const OperationInput& given, const Matrix4& map) {
    const Matrix3 linear = map.topLeftCorner<3, 3>();
    return (given.other.matrix().rowwise() - map.topRightCorner<3, 1>().transpose()) * linear;
  }

  // Of faces, or what belongs to them.
  template <typename Rows>
  static void swap_corners(Rows&& rows) {
    rows.col(1).swap(rows.col(2));
  }

  // Whether one is wound inwards, the other outwards: a reflection turns normals round.
  static bool are_wound_apart(const OperationInput& given, const Points& laid) {
    if (given.faces.empty()) return false;
    const Points own = TriangleMesh(given.points, given.faces).vertex_normals(),
                 other = TriangleMesh(laid, given.other_faces).vertex_normals();
    const PointTree tree(laid);
    double alike = 0;
    for (Index i = 0; i < own.rows(); ++i)
      if (const Index j = tree.nearest(given.points[i]).index; j >= 0)
        if (const double cosine = own.row(i).dot(other.row(j)); std::isfinite(cosine))
          alike += cosine;
    return alike > 0;
  }

  // Left of both, which lie on its positive side.
  static Plane beside(const OperationInput& given, const Matrix4& map) {
    constexpr double gap = 0.1;  // diagonals: what is near the plane counts less
    const Points own = finite_rows(given.points.matrix());
    if (own.rows() == 0) throw InvalidInput("none of the points given is finite");
    const double low = std::min(own.col(0).minCoeff(), laid_back(given, map).col(0).minCoeff());
    return Plane(Vector3::UnitX(), gap * diagonal_of(own) - low);
  }

  // What was added has the attributes of the points next to it: the second shape's are others.
  void set_sources(OperationResult& result) const {
    if (result.point_sources.empty()) return;
    const Index own = given_.points.size(), faces = given_.faces.size();
    const PointTree tree(given_.points);
    result.point_sources.resize(result.points.rows());
    for (Index i = own; i < result.points.rows(); ++i)
      result.point_sources[i] = tree.nearest(result.points.row(i).transpose()).index;
    std::vector<Index> face_at(own, 0);
    for (Index f = 0; f < faces; ++f)
      for (int c = 0; c < 3; ++c) face_at[given_.faces[f][c]] = f;
    result.face_sources.resize(result.faces.rows());
    for (Index f = faces; f < result.faces.rows(); ++f)
      result.face_sources[f] = face_at[result.point_sources[result.faces(f, 0)]];
  }

  const OperationInput& given_;
  Plane plane_;
  Points points_;
  Triangles faces_;
  bool turned_ = false;  // faces of the second
  OperationInput input_;
};

}  // namespace

OperationResult run_on_pair(const OperationImplementation& operation, const OperationInput& given,
                            const Matrix4& map, const Values& parameters, const Context& context) {
  const ParameterValues values(operation.name, operation.parameters, parameters);
  if (!is_over_mirror(operation, values))
    throw InvalidParameter("symmetry is axis beside a second shape; allowed is mirror");
  require_finite(given.other, "point of the second shape");
  require_corners(given.faces, given.points.size());
  require_corners(given.other_faces, given.other.size());
  if (given.faces.empty() != given.other_faces.empty())
    throw InvalidInput("one of the two shapes has faces; allowed are two meshes, or two clouds");
  const TwoShapes both(given, map);
  OperationResult result =
      run_operation(operation, both.input(), &both.plane(), parameters, context);
  both.map_back(operation, result);
  return result;
}

}  // namespace symsurf
