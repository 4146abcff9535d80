#pragma once

#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "base/math.h"
#include "random_cloud.h"

namespace symsurf {

/// A mesh of a body with limbs whose points know which one mirrors them, whatever its pose.
struct LimbedBody {
  Points points;
  Triangles faces;
  std::vector<Index> mirrored;
};

/// A four-legged animal of cubes, mirrored in x = 0, its corners smoothed.
inline LimbedBody standing_animal() {
  using Cell = std::array<int, 3>;
  struct Box {
    Cell low, high;
  };
  // Of the side x >= 0: trunk, neck, head, tail, legs.
  const std::vector<Box> boxes{{{0, 0, 0}, {4, 20, 6}},   {{0, 20, 4}, {2, 24, 10}},
                               {{0, 22, 8}, {3, 30, 13}}, {{0, -12, 3}, {1, 0, 5}},
                               {{1, 1, -16}, {4, 4, 0}},  {{1, 16, -14}, {4, 19, 0}}};
  const auto is_full = [&](Cell c) {
    if (c[0] < 0) c[0] = -1 - c[0];
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
      bool inside = true;
      for (int k = 0; k < 3; ++k) inside = inside && c[k] >= box.low[k] && c[k] < box.high[k];
      return inside;
    });
  };
  std::map<Cell, Index> vertices;
  std::vector<std::array<Index, 3>> faces;
  const auto vertex = [&](Cell corner) {
    return vertices.emplace(corner, static_cast<Index>(vertices.size())).first->second;
  };
  for (int x = -4; x < 4; ++x)
    for (int y = -12; y < 30; ++y)
      for (int z = -16; z < 13; ++z)
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            const Cell cell{x, y, z};
            Cell beside = cell;
            beside[axis] += side == 1 ? 1 : -1;
            if (!is_full(cell) || is_full(beside)) continue;
            std::array<Index, 4> quad;
            for (int k = 0; k < 4; ++k) {
              Cell corner = cell;
              corner[axis] += side;
              corner[(axis + 1) % 3] += k == 1 || k == 2;
              corner[(axis + 2) % 3] += k >= 2;
              quad[k] = vertex(corner);
            }
            if (side == 0) std::swap(quad[1], quad[3]);
            // Cut along either diagonal: no triangulation is mirrored as a whole.
            const int first = (x < 0) != (axis == 0) ? 1 : 0;
            for (const int k : {1, 2})
              faces.push_back({quad[first], quad[(first + k) % 4], quad[(first + k + 1) % 4]});
          }
  LimbedBody body;
  body.faces = rows_of(faces);
  body.points.resize(static_cast<Index>(vertices.size()), 3);
  body.mirrored.resize(vertices.size());
  for (const auto& [corner, v] : vertices) {
    body.points.row(v) << corner[0], corner[1], corner[2];
    body.mirrored[v] = vertices.at({-corner[0], corner[1], corner[2]});
  }
  for (int step = 0; step < 3; ++step) {
    Points sum = Points::Zero(body.points.rows(), 3);
    Eigen::VectorXd count = Eigen::VectorXd::Zero(body.points.rows());
    for (const auto& face : faces)
      for (int c = 0; c < 3; ++c) {
        sum.row(face[c]) += body.points.row(face[(c + 1) % 3]) + body.points.row(face[(c + 2) % 3]);
        count[face[c]] += 2;
      }
    body.points = (body.points + Points(count.cwiseInverse().asDiagonal() * sum)) / 2;
  }
  return body;
}

/// Bends all that lies beyond a joint along an axis into an arc of a length, then straight on.
/// `turn`: an axis across that one, as long as the angle in radians.
inline Vector3 bent(const Vector3& x, const Vector3& joint, const Vector3& axis,
                    const Vector3& turn, double length) {
  const double along = (x - joint).dot(axis), angle = turn.norm();
  if (along <= 0 || angle == 0) return x;
  const Vector3 about = turn / angle, side = about.cross(axis);
  const double on_arc = std::min(along, length), turned = angle * on_arc / length;
  const double radius = length / angle;
  const Vector3 ahead = std::cos(turned) * axis + std::sin(turned) * side;
  const Vector3 inward = std::cos(turned) * side - std::sin(turned) * axis;
  const Vector3 middle = joint + radius * (std::sin(turned) * axis + (1 - std::cos(turned)) * side);
  return middle + (along - on_arc) * ahead + (x - joint).dot(side) * inward +
         (x - joint).dot(about) * about;
}

/// The animal with each leg, the neck and the tail bent by up to 50 degrees to somewhere.
inline LimbedBody posed_animal(std::uint64_t seed) {
  LimbedBody body = standing_animal();
  RandomCloud random(seed);
  struct Joint {
    Vector3 at, axis;
    double length;
    int side;  // of the mirror; 0: on it
  };
  const Vector3 down = -Vector3::UnitZ();
  const std::vector<Joint> joints{{{2.5, 2.5, -3}, down, 9, 1},
                                  {{-2.5, 2.5, -3}, down, 9, -1},
                                  {{2.5, 17.5, -3}, down, 9, 1},
                                  {{-2.5, 17.5, -3}, down, 9, -1},
                                  {{0, -2, 4}, {0, -1, 0}, 6, 0}};
  std::vector<Vector3> turns;
  for (const Joint& joint : joints) {
    const Vector3 across = joint.axis.cross(random.direction()).normalized();
    turns.push_back(random.uniform(0.3, 0.9) * across);
  }
  for (Index i = 0; i < body.points.rows(); ++i) {
    const Vector3 x = body.points.row(i);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const Joint& joint = joints[k];
      const bool is_of_limb = joint.side == 0 ? x.y() < 0
                                              : x.z() < 0 && joint.side * x.x() > 0 &&
                                                    std::abs(x.y() - joint.at.y()) < 4;
      if (is_of_limb)
        body.points.row(i) = bent(x, joint.at, joint.axis, turns[k], joint.length).transpose();
    }
  }
  return body;
}

}  // namespace symsurf
