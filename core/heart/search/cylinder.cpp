#include <symsurf/mirrors.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "search/auto.h"
#include "search/parametric.h"

namespace symsurf {

namespace {

// As far as it lies across u.
Vector3 axis_across(const Vector3& u, const Vector3& axis) {
  const Vector3 across = axis - axis.dot(u) * u;
  return across.norm() > single_rounding ? across.normalized() : u.unitOrthogonal();
}

struct CylinderKind {
  using Shape = UnitCylinder;
  static constexpr const char* name = "cylinder";
  static constexpr double widest = 6;  // wider ones hardly differ from planes

  static double radius(const UnitCylinder& cylinder) { return cylinder.radius; }

  // A pair fixes a point and the normal of the cylinder there; curvature and direction of the axis
  // are scanned.
  static constexpr auto through = [](const Vector3& middle, const Vector3& u, double most,
                                     const auto& add) {
    constexpr int axes = 6;  // directions over the half circle, the first along the cloud
    // To both sides of the pair. In units of the inverse diagonal.
    constexpr std::array curvatures{0.3, 0.6, 1.0, 1.5, 2.2, 3.2, 4.6, 6.5, 9.0};
    const Vector3 first = axis_across(u, Vector3::UnitX()), second = u.cross(first);
    for (int k = 0; k < axes; ++k) {
      const double angle = std::numbers::pi * k / axes;
      const Vector3 axis = std::cos(angle) * first + std::sin(angle) * second;
      for (const double curvature : curvatures)
        for (const double side : {-1.0, 1.0})
          if (curvature <= most)
            add(UnitCylinder{middle + side / curvature * u, axis, 1 / curvature});
    }
  };

  CylinderKind(const Cloud&, const NearestPoints&, const Refinement& refinement, const Context&)
      : refinement_(refinement) {}

  Candidate<UnitCylinder> fitted(const Candidate<UnitCylinder>& start) const {
    return refinement_.fitted(start, of_each);
  }
  Candidate<UnitCylinder> closely(const Candidate<UnitCylinder>& start) const {
    return polished(start, of_best, refinement_);
  }
  static std::vector<Candidate<UnitCylinder>> taken_planes(const Surfels&, const SurfelMap&,
                                                           std::vector<Candidate<UnitCylinder>>&) {
    return {};
  }
  std::optional<Points> rest(const Candidate<UnitCylinder>&) const { return std::nullopt; }
  void drop_planes(const MirrorScore&, std::vector<Candidate<UnitCylinder>>&) const {}

 private:
  const Refinement& refinement_;
};

std::shared_ptr<Mirror> bent_cylinder(const PlaneBend& bend, const Refinement& refinement,
                                      const PrincipalFrame& frame) {
  return mirror_of(refinement.fitted(bend.cylinder(), of_best), frame);
}

}  // namespace

MethodImplementation cylinder_method() {
  MethodImplementation method;
  method.name = "cylinder";
  method.title = "Mirror cylinder";
  method.summary =
      "Finds the circular cylinder that mirrors the shape along its radius: a plane of symmetry "
      "bent about an axis.";
  method.parameters = {
      surfels_searched(700, "the cylinder"),
      max_candidates(5, 7, "cylinders"),
      pair_distance(),
  };
  method.minimum_points = 12;
  method.automatic = true;
  method.distance_from = distance_from_cylinder;
  method.bent_from = bent_cylinder;
  method.run = searched<CylinderKind>;
  return method;
}

}  // namespace symsurf
