#pragma once

#include <fuzzer/FuzzedDataProvider.h>
#include <symsurf/symsurf.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/random_cloud.h"
#include "show.h"

// Input that is hard on purpose, drawn from what libFuzzer gives.

namespace symsurf {

using Source = FuzzedDataProvider;

constexpr double infinity = std::numeric_limits<double>::infinity();

inline bool one_in(Source& source, int many) {
  return source.ConsumeIntegralInRange(1, many) == many;
}

template <typename Values>
const auto& one_of(const Values& values, Source& source) {
  return values[source.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1)];
}

/// Zeros, ends and neighbours of ends of what doubles hold, and what the library has limits at.
inline double extreme(Source& source) {
  return source.PickValueInArray({0.0, -0.0, 1.0, -1.0, 1e-50, 1e50, 1e-60, 1e60, 5e-324, 1e-160,
                                  1e160, 1.7976931348623157e308, -1.7976931348623157e308, infinity,
                                  -infinity, std::nan("")});
}

/// Of two digits, so that many are equal; one in 16 extreme.
inline double number(Source& source) {
  if (one_in(source, 16)) return extreme(source);
  return source.ConsumeIntegralInRange(-20, 20) / 10.0;
}

inline Vector3 vector(Source& source) {
  const double x = number(source), y = number(source), z = number(source);
  return {x, y, z};
}

inline Eigen::MatrixXd table(Source& source, Index rows, Index columns) {
  Eigen::MatrixXd numbers(rows, columns);
  for (double& each : numbers.reshaped()) each = number(source);
  return numbers;
}

/// Corners of unit cells, each once.
inline Points grid(Index nx, Index ny, Index nz) {
  Points points(nx * ny * nz, 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) << i % nx, i / nx % ny, i / (nx * ny);
  return points;
}

/// Points of a cloud: most for calls that look at each of them, and for those that search.
constexpr Index most_points = 400, most_for_searches = 60;

inline Points simple_cloud(Source& source, Index most) {
  const auto count = source.ConsumeIntegralInRange<Index>(0, std::min<Index>(most, 60));
  const Index longest = most < 216 ? 4 : 6;
  const auto side = [&] { return source.ConsumeIntegralInRange<Index>(1, longest); };
  RandomCloud random(source.ConsumeIntegral<std::uint8_t>());
  switch (source.ConsumeIntegralInRange(0, 4)) {
    case 0:
      return random.box(count);
    case 1:
      return random.sphere(count);
    case 2:
      return random.lattice(count, 3);
    case 3: {
      const Index nx = side(), ny = side(), nz = side();
      return grid(nx, ny, nz);
    }
    default: {
      Points points(count, 3);
      for (double& each : points.reshaped()) each = source.ConsumeIntegralInRange(-20, 20) / 10.0;
      return points;
    }
  }
}

inline Points stacked(const Points& upper, const Points& lower) {
  Points points(upper.rows() + lower.rows(), 3);
  points << upper, lower;
  return points;
}

/// One of what makes clouds hard, done to a cloud that has points.
inline Points harder(Points points, Source& source, Index most) {
  const Index row = source.ConsumeIntegralInRange<Index>(0, points.rows() - 1);
  const int axis = source.ConsumeIntegralInRange(0, 2);
  switch (source.ConsumeIntegralInRange(0, 9)) {
    case 0: {  // copies of all
      const Index copies = source.ConsumeIntegralInRange<Index>(1, 8);
      return points.replicate(std::min(copies, 1 + most / points.rows()), 1);
    }
    case 1:  // a copy of one
      return stacked(points, points.row(row));
    case 2: {  // mirror images
      Points images = points;
      images.col(axis) = number(source) - points.col(axis).array();
      return points.rows() < most ? stacked(points, images) : points;
    }
    case 3:  // a point that lies off the others, maybe far
      return stacked(points, source.ConsumeIntegralInRange(1, 1000) * vector(source).transpose());
    case 4:  // coplanar; twice, collinear
      points.col(axis).setConstant(number(source));
      return points;
    case 5:  // bent
      points.col(axis) += points.col((axis + 1) % 3).cwiseAbs2() * number(source);
      return points;
    case 6:  // turned: coordinates get rounded
      return points * RandomCloud(source.ConsumeIntegral<std::uint8_t>()).rotation();
    case 7:
      return points * std::pow(10.0, source.ConsumeIntegralInRange(-60, 60));
    case 8:  // as the digits of a double or those of a float end
      points.col(axis).array() += std::pow(10.0, source.ConsumeIntegralInRange(0, 17));
      return points;
    default:
      points(row, axis) = extreme(source);
      return points;
  }
}

/// A small cloud, of about `most` points at the most, up to four times made harder.
inline Points cloud(Source& source, Index most = most_points) {
  Points points = simple_cloud(source, most);
  for (int steps = source.ConsumeIntegralInRange(0, 4); steps > 0 && points.rows() > 0; --steps)
    points = harder(std::move(points), source, most);
  return points;
}

/// Any triangles; now and then with corners that are no points.
inline Triangles faces(Source& source, Index points) {
  Triangles triangles(source.ConsumeIntegralInRange<Index>(0, 40), 3);
  const Index beyond = one_in(source, 8) ? 1 : 0;
  for (Index& corner : triangles.reshaped())
    corner = source.ConsumeIntegralInRange<Index>(-beyond, std::max<Index>(points - 1, 0) + beyond);
  return triangles;
}

/// One a point, or now and then another number of them, or not finite or zero.
inline Points normals(Source& source, Index points) {
  RandomCloud random(source.ConsumeIntegral<std::uint8_t>());
  Points directions = random.sphere(one_in(source, 8) ? points + 1 : points);
  if (directions.rows() > 0 && one_in(source, 4)) directions.row(0) = vector(source).transpose();
  return directions;
}

inline Value any_value(Source& source) {
  switch (source.ConsumeIntegralInRange(0, 5)) {
    case 0:
      return source.ConsumeBool();
    case 1:
      return source.ConsumeIntegral<Index>();
    case 2:
      return extreme(source);
    case 3:
      return source.ConsumeRandomLengthString(8);
    case 4:
      return vector(source);
    default: {
      const auto rows = source.ConsumeIntegralInRange<Index>(0, 4);
      const auto columns = source.ConsumeIntegralInRange<Index>(0, 4);
      return table(source, rows, columns);
    }
  }
}

/// Mostly near the least that is allowed or the default: the greatest that is allowed costs hours
/// in some methods, and no more code.
inline Value value_of(const Parameter& parameter, Source& source) {
  if (one_in(source, 8)) return any_value(source);
  switch (parameter.type) {
    case ParameterType::Boolean:
      return source.ConsumeBool();
    case ParameterType::Integer:
      return static_cast<Index>(parameter.minimum) + source.ConsumeIntegralInRange<Index>(-1, 15);
    case ParameterType::Real:
      return source.ConsumeBool() ? parameter.minimum + std::abs(number(source)) : number(source);
    case ParameterType::Choice:
      return one_of(parameter.choices, source);
    default:
      return vector(source);
  }
}

/// Of a method or an operation: each as it is, in its range, or out of it.
inline Values parameters(Source& source, const std::vector<Parameter>& described) {
  Values given;
  for (const Parameter& parameter : described)
    if (one_in(source, 3)) given[parameter.name] = value_of(parameter, source);
  if (one_in(source, 64)) given[source.ConsumeRandomLengthString(8)] = any_value(source);
  return given;
}

constexpr std::array mirror_kinds{"plane",     "sphere",       "cylinder", "quadric",
                                  "free-form", "height field", "surface"};

/// The numbers of a mirror of the kind, most of them allowed.
inline Values mirror_numbers(std::string_view kind, Source& source) {
  RandomCloud random(source.ConsumeIntegral<std::uint8_t>());
  Values numbers;
  if (kind == "plane") {
    numbers = {{"normal", vector(source)}, {"offset", number(source)}};
  } else if (kind == "sphere") {
    numbers = {{"centre", vector(source)}, {"radius", number(source)}};
  } else if (kind == "cylinder") {
    numbers = {{"point", vector(source)}, {"axis", vector(source)}, {"radius", number(source)}};
  } else if (kind == "quadric") {
    numbers = {
        {"matrix", table(source, 3, 3)}, {"linear", vector(source)}, {"constant", number(source)}};
    if (source.ConsumeBool())
      numbers.insert(
          {{"origin", vector(source)}, {"gradient", vector(source)}, {"value", number(source)}});
  } else if (kind == "free-form") {
    const auto count = source.ConsumeIntegralInRange<Index>(0, 4);
    Eigen::MatrixXd tangents(count, 3), normals(count, 3);
    for (Index i = 0; i < count; ++i) {
      const Matrix3 frame = random.rotation();
      tangents.row(i) = frame.row(0);
      normals.row(i) = frame.row(2);
    }
    numbers = {{"centres", table(source, count, 3)},
               {"tangents", tangents},
               {"normals", normals},
               {"heights", table(source, count, 6)},
               {"radii", table(source, count, 1)}};
  } else if (kind == "height field") {
    const auto nodes = source.ConsumeIntegralInRange<Index>(0, 30);
    numbers = {{"direction", vector(source)}, {"nodes", table(source, nodes, 3)}};
  } else {
    numbers = {{"surface", one_of(surfaces(), source).name},
               {"mapping", std::string(source.ConsumeBool() ? "fixed" : "perpendicular")},
               {"scale", number(source)},
               {"rotation", Eigen::MatrixXd(random.rotation())},
               {"translation", vector(source)}};
  }
  if (one_in(source, 16)) numbers.begin()->second = any_value(source);
  if (one_in(source, 32)) numbers.erase(numbers.begin());
  return numbers;
}

/// A mirror made by hand. Throws as make_mirror does.
inline std::shared_ptr<Mirror> drawn_mirror(Source& source, const std::string& kind) {
  const Values numbers = mirror_numbers(kind, source);
  show("kind", '"' + kind + '"');
  show("numbers", numbers);
  return make_mirror(kind, numbers);
}

inline std::shared_ptr<Mirror> drawn_mirror(Source& source) {
  return drawn_mirror(source, one_of(mirror_kinds, source));
}

}  // namespace symsurf
