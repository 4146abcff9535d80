#include "symmetries/point_group/point_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace symsurf {

namespace {

constexpr double rounding = 1e-6;

bool contains(const std::vector<Matrix3>& elements, const Matrix3& element) {
  return std::any_of(elements.begin(), elements.end(), [&](const Matrix3& other) {
    return (other - element).cwiseAbs().maxCoeff() < rounding;
  });
}

// The group that the generators make.
std::vector<Matrix3> closed(const std::vector<Matrix3>& generators) {
  std::vector<Matrix3> elements{Matrix3::Identity()};
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (const Matrix3& generator : generators) {
      const Matrix3 product = generator * elements[i];
      if (!contains(elements, product)) elements.push_back(product);
    }
  return elements;
}

std::string name_of(Index order, const AxialElements& has) {
  const std::string n = order == 0 ? "∞" : std::to_string(order);
  if (order == 1) return has.vertical || has.across ? "Cs" : has.rotary ? "Ci" : "C1";
  const bool dihedral = has.twofold || (has.vertical && (has.across || has.rotary));
  if (dihedral && has.across) return "D" + n + "h";
  if (dihedral && has.rotary) return "D" + n + "d";
  if (dihedral) return "D" + n;
  if (has.vertical) return "C" + n + "v";
  if (has.across) return "C" + n + "h";
  if (has.rotary) return "S" + std::to_string(2 * order);
  return "C" + n;
}

}  // namespace

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
  return {name_of(order, has), closed(generators), order == 0};
}

PointGroup inversion_group() { return {"Ci", closed({-Matrix3::Identity()})}; }

PointGroup reflection_group() { return {"Cs", closed({reflection(Vector3::UnitZ())})}; }

PointGroup spherical_group() { return {"K", closed({-Matrix3::Identity()}), false, true}; }

PointGroup polyhedral_group(Index highest_order, bool inversion, bool mirror) {
  constexpr double third = 2 * std::numbers::pi / 3;
  std::vector<Matrix3> generators{turn(Vector3::UnitZ(), std::numbers::pi),
                                  turn(Vector3::Ones(), third)};
  std::string name = "T";
  if (highest_order == 4) {
    name = "O";
    generators.push_back(turn(Vector3::UnitZ(), std::numbers::pi / 2));
  } else if (highest_order == 5) {
    name = "I";
    generators.push_back(turn(Vector3(0, 1, std::numbers::phi), 2 * std::numbers::pi / 5));
  }
  if (inversion) {
    name += "h";
    generators.push_back(-Matrix3::Identity());
  } else if (mirror && highest_order == 3) {
    name += "d";
    generators.push_back(reflection(Vector3(1, -1, 0)));
  }
  return {name, closed(generators)};
}

std::vector<Vector3> PointGroup::plane_normals() const {
  std::vector<Vector3> normals;
  if (all) return normals;
  for (const Matrix3& element : elements) {
    if (element.determinant() > 0 || std::abs(element.trace() - 1) > rounding) continue;
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
    if (element.determinant() < 0 || element.trace() > 3 - rounding) continue;
    // Orthogonal to what the turn moves along: its axis is the null space of R - I.
    Eigen::JacobiSVD<Matrix3> svd(element - Matrix3::Identity(), Eigen::ComputeFullV);
    const Vector3 direction = svd.matrixV().col(2);
    if (continuous && std::abs(direction.z()) > 1 - rounding) continue;
    const auto same = std::find_if(found.begin(), found.end(), [&](const Axis& axis) {
      return are_parallel(axis.direction, direction, rounding);
    });
    if (same == found.end())
      found.push_back({direction, 2});
    else
      ++same->order;  // an axis of order n has n - 1 turns
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Axis& a, const Axis& b) { return a.order > b.order; });
  if (continuous) found.insert(found.begin(), {Vector3::UnitZ(), 0});
  return found;
}

bool PointGroup::inversion() const { return contains(elements, -Matrix3::Identity()); }

}  // namespace symsurf
