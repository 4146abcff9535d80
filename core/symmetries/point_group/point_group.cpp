#include "point_group/point_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace symsurf {

namespace {

// Between matrices and directions: those of a small set are known to single precision, and the
// least turn of a thousand points is more.
constexpr double same = 1e-3;

// Schoenflies'.
std::string name_of(const PointGroup& group) {
  const std::vector<PointGroup::Axis> axes = group.axes();
  const std::vector<Vector3> normals = group.plane_normals();
  if (axes.empty()) return !normals.empty() ? "Cs" : group.inversion() ? "Ci" : "C1";
  const Index order = axes[0].order;
  if (axes.size() > 1 && axes[1].order > 2) {
    const std::string name = order == 3 ? "T" : order == 4 ? "O" : "I";
    return name + (group.inversion() ? "h" : normals.empty() ? "" : "d");
  }
  const std::string n = order == 0 ? "∞" : std::to_string(order);
  const bool across = std::any_of(normals.begin(), normals.end(), [&](const Vector3& normal) {
    return are_parallel(normal, axes[0].direction, same);
  });
  // Of D2 and its kin each of three axes may stand first.
  if (axes.size() > 1) return "D" + n + (across ? "h" : normals.empty() ? "" : "d");
  if (across) return "C" + n + "h";
  if (!normals.empty()) return "C" + n + "v";
  const bool rotary = static_cast<Index>(group.elements.size()) > order && order > 0;
  return rotary ? "S" + std::to_string(2 * order) : "C" + n;
}

}  // namespace

bool contains(const std::vector<Matrix3>& elements, const Matrix3& element) {
  return std::any_of(elements.begin(), elements.end(),
                     [&](const Matrix3& other) { return (other - element).isZero(same); });
}

std::vector<Matrix3> closed(const std::vector<Matrix3>& generators) {
  std::vector<Matrix3> elements{Matrix3::Identity()};
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (const Matrix3& generator : generators) {
      const Matrix3 product = generator * elements[i];
      if (!contains(elements, product)) elements.push_back(product);
    }
  return elements;
}

Matrix3 turn(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

Matrix3 reflection(const Vector3& normal) {
  return Matrix3::Identity() - 2 / normal.squaredNorm() * normal * normal.transpose();
}

bool are_parallel(const Vector3& a, const Vector3& b, double angle) {
  return a.cross(b).norm() < angle;
}

PointGroup axial_group(Index order, const AxialElements& has) {
  const auto n = static_cast<double>(std::max<Index>(order, 1));
  const Vector3 x = Vector3::UnitX(), z = Vector3::UnitZ();
  std::vector<Matrix3> generators;
  if (order > 1) generators.push_back(turn(z, 2 * std::numbers::pi / n));
  if (has.across) generators.push_back(reflection(z));
  if (has.rotary) generators.push_back(turn(z, std::numbers::pi / n) * reflection(z));
  if (has.vertical) generators.push_back(reflection(x));
  if (has.twofold) generators.push_back(turn(x, std::numbers::pi));
  return PointGroup(closed(generators), order == 0);
}

PointGroup inversion_group() { return PointGroup({Matrix3::Identity(), -Matrix3::Identity()}); }

PointGroup reflection_group() { return axial_group(1, {.across = true}); }

PointGroup spherical_group() {
  PointGroup group = inversion_group();
  group.name = "K";
  group.all = true;
  return group;
}

PointGroup polyhedral_group(Index highest_order, bool inversion, bool mirror) {
  constexpr double third = 2 * std::numbers::pi / 3;
  std::vector<Matrix3> generators{turn(Vector3::UnitZ(), std::numbers::pi),
                                  turn(Vector3::Ones(), third)};
  if (highest_order == 4)
    generators.push_back(turn(Vector3::UnitZ(), std::numbers::pi / 2));
  else if (highest_order == 5)
    generators.push_back(turn(Vector3(0, 1, std::numbers::phi), 2 * std::numbers::pi / 5));
  if (inversion)
    generators.push_back(-Matrix3::Identity());
  else if (mirror && highest_order == 3)
    generators.push_back(reflection(Vector3(1, -1, 0)));
  return PointGroup(closed(generators));
}

PointGroup::PointGroup(std::vector<Matrix3> elements, bool continuous)
    : elements(std::move(elements)), continuous(continuous) {
  name = name_of(*this);
}

std::vector<Vector3> PointGroup::plane_normals() const {
  std::vector<Vector3> normals;
  if (all) return normals;
  for (const Matrix3& element : elements) {
    if (element.determinant() > 0 || element.trace() < 0 || !(element * element).isIdentity(same))
      continue;
    // I - 2 n n': its longest column with I taken away is along n.
    const Matrix3 moved = Matrix3::Identity() - element;
    Index longest;
    moved.colwise().squaredNorm().maxCoeff(&longest);
    normals.push_back(moved.col(longest).normalized());
  }
  return normals;
}

std::vector<PointGroup::Axis> PointGroup::axes() const {
  if (all) return {{Vector3::UnitX(), 0}, {Vector3::UnitY(), 0}, {Vector3::UnitZ(), 0}};
  std::vector<Axis> found;
  for (const Matrix3& element : elements) {
    if (element.determinant() < 0 || element.isIdentity(same)) continue;
    const Vector3 direction = Eigen::AngleAxisd(element).axis();
    if (continuous && std::abs(direction.z()) > 1 - same) continue;
    const auto known = std::find_if(found.begin(), found.end(), [&](const Axis& axis) {
      return are_parallel(axis.direction, direction, same);
    });
    if (known == found.end())
      found.push_back({direction, 2});
    else
      ++known->order;  // an axis of order n has n - 1 turns
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Axis& a, const Axis& b) { return a.order > b.order; });
  if (continuous) found.insert(found.begin(), {Vector3::UnitZ(), 0});
  return found;
}

bool PointGroup::inversion() const { return contains(elements, -Matrix3::Identity()); }

}  // namespace symsurf
