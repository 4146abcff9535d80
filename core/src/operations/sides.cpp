#include "operations/sides.h"

#include <Eigen/Geometry>
#include <array>

#include "base/parallel.h"

namespace symsurf {

namespace {

struct Corner {
  Vector3 x, foot;
  double distance;
};

// The volume under a triangle down to the triangle of its feet. The walls between neighbours
// cancel, and at the mirror they have no height, so that they need not be added: divergence
// theorem.
void add_triangle(const Corner& a, const Corner& b, const Corner& c, double& area, double& volume) {
  area += (b.x - a.x).cross(c.x - a.x).norm() / 2;
  volume += (a.x.cross(b.x).dot(c.x) - a.foot.cross(b.foot).dot(c.foot)) / 6;
}

// Where an edge meets the mirror, to the first order in the distances.
Corner crossing(const Corner& a, const Corner& b) {
  const double t = a.distance / (a.distance - b.distance);
  const Vector3 x = a.x + t * (b.x - a.x);
  return {x, x, 0};
}

// The corner apart from the two others: a triangle on its side, a quadrangle on theirs.
void add_cut(const Corner& apart, const Corner& b, const Corner& c, Sides& sides) {
  const Corner at_b = crossing(apart, b), at_c = crossing(apart, c);
  const bool positive = apart.distance > 0;
  double& area = positive ? sides.positive_area : sides.negative_area;
  double& volume = positive ? sides.positive_volume : sides.negative_volume;
  double& other_area = positive ? sides.negative_area : sides.positive_area;
  double& other_volume = positive ? sides.negative_volume : sides.positive_volume;
  add_triangle(apart, at_b, at_c, area, volume);
  add_triangle(at_b, b, c, other_area, other_volume);
  add_triangle(at_b, c, at_c, other_area, other_volume);
}

}  // namespace

double Sides::index(double positive, double negative) {
  return (positive - negative) / (positive + negative);
}

Sides measured_sides(PointsView points, TrianglesView faces, const Mirror& mirror,
                     const Context& context) {
  const Eigen::VectorXd distances = mirror.signed_distance(points, context.stage(0, 0.5));
  const Points feet = mirror.project(points, context.stage(0.5, 1));
  const Vector3 origin = points[0];
  Sides sides;
  interruptible_for(context, faces.size(), [&](Index f) {
    std::array<Corner, 3> corner;
    int positive = 0;
    for (int k = 0; k < 3; ++k) {
      const Index i = faces[f][k];
      corner[k] = {points[i] - origin, feet.row(i).transpose() - origin, distances[i]};
      positive += distances[i] > 0;
    }
    if (positive == 3)
      add_triangle(corner[0], corner[1], corner[2], sides.positive_area, sides.positive_volume);
    else if (positive == 0)
      add_triangle(corner[0], corner[1], corner[2], sides.negative_area, sides.negative_volume);
    else
      for (int k = 0; k < 3; ++k)
        if ((corner[k].distance > 0) == (positive == 1))
          add_cut(corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3], sides);
  });
  return sides;
}

}  // namespace symsurf
