#pragma once

#include <symsurf/mirror.h>

#include <memory>

#include "methods/free_form/free_form_refinement.h"

namespace symsurf::perpendicular {

/// A kind of mirror with few numbers, fitted to pairs of points by its analytic derivatives.
class Model {
 public:
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  virtual ~Model() = default;
  virtual std::unique_ptr<Model> copy() const = 0;
  virtual std::unique_ptr<Mirror> mirror() const = 0;
  virtual int size() const = 0;
  /// The image of x and its derivatives by the steps of the numbers; false without an image.
  virtual bool image(const Vector3& x, Vector3& image, Jacobian& derivatives) const = 0;
  virtual void step(const Eigen::VectorXd& by) = 0;
};

/// A general quadric by its ten coefficients, one of which is the scale.
std::unique_ptr<Model> quadric_model(const GrownSurface& surface);

/// The mirror of the model's kind nearest to a surface, matched to the cloud and fitted to its
/// pairs again and again (Levenberg-Marquardt, Tukey's weights). The surface gets its pairs and
/// share; null when the surface has too few points or nothing fits.
std::unique_ptr<Mirror> fit(const SearchCloud& cloud, std::unique_ptr<Model> model,
                            GrownSurface& surface);

}  // namespace symsurf::perpendicular
