// What the thesis's methods and the mirror sphere cost on one thread, in processor time: Algorithms
// 1 to 3 in units (see unit.h) of the same cloud and run, Algorithm 1 also as a power of the number
// of points, `sphere` in seconds. The bar each is held to stands beside it.

#include <symsurf/detect.h>
#include <symsurf/synthetic.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "bumpy_object.h"
#include "unit.h"

namespace symsurf::benchmarks {

namespace {

double detection_seconds(PointsView points, const std::string& method) {
  Options options;
  options.method = method;
  const std::clock_t start = std::clock();
  detect(points, options, Context(nullptr, 1));
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// Of as many runs as fit in about two seconds, five at the most: the least that others disturbed.
template <typename Run>
double least_seconds(const Run& run) {
  double least = run(), spent = least;
  for (int k = 1; k < 5 && spent < 2; ++k) {
    const double seconds = run();
    least = std::min(least, seconds);
    spent += seconds;
  }
  return least;
}

Points in_random_order(const Points& points) {
  std::mt19937_64 random(1);
  std::vector<Index> rows(points.rows());
  for (Index i = 0; i < points.rows(); ++i) rows[i] = i;
  std::shuffle(rows.begin(), rows.end(), random);
  return points(rows, Eigen::indexing::all);
}

// f5 on a grid and its images over f1: what Algorithm 1 is made for.
Points two_sheets(Index count) {
  const auto side = static_cast<Index>(std::sqrt(static_cast<double>(count) / 2));
  return mirror_fixed(sampled_surface(surface("f5"), 2, side), surface("f1"), 4).points;
}

// The points at a constant distance to either side of f1: what Algorithms 2 and 3 are made for.
Points offset_sheets(Index count) {
  const auto side = static_cast<Index>(std::sqrt(static_cast<double>(count) / 2));
  return mirror_perpendicular(surface("f1"), 2, side, 0.5, 0.5).points;
}

// A closed shape and its images over a sphere.
Points around_sphere(Index count) {
  const Points object = bumpy_object(count / 2);
  return mirror_spherical(object, Sphere(Vector3(2, 1, 0), 4)).points;
}

struct Shape {
  const char* name;
  Points (*make)(Index count);
};

Points shuffled_sheets(Index count) { return in_random_order(two_sheets(count)); }

void report_units(const char* method, const Shape& shape, Index count, double bar) {
  const Points points = shape.make(count);
  const double unit = least_seconds([&] { return unit_seconds(points); });
  const double seconds = least_seconds([&] { return detection_seconds(points, method); });
  std::printf("%-18s %-15s %8td points %9.4f s %7.2f units (bar %g)\n", method, shape.name,
              points.rows(), seconds, seconds / unit, bar);
}

// Least squares of log seconds over log n.
void report_growth(const char* method, const Shape& shape, double bar) {
  std::vector<double> x, y;
  for (Index count = 1000; count <= 1'000'000; count *= 10) {
    const Points points = shape.make(count);
    const double unit = least_seconds([&] { return unit_seconds(points); });
    const double seconds = least_seconds([&] { return detection_seconds(points, method); });
    std::printf("%-18s %-15s %8td points %9.4f s %7.2f units\n", method, shape.name, points.rows(),
                seconds, seconds / unit);
    std::fflush(stdout);
    x.push_back(std::log(static_cast<double>(points.rows())));
    y.push_back(std::log(seconds));
  }
  const double n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    sx += x[k];
    sy += y[k];
    sxx += x[k] * x[k];
    sxy += x[k] * y[k];
  }
  std::printf("%-18s %-15s grows as n^%.3f (bar %g)\n", method, shape.name,
              (n * sxy - sx * sy) / (n * sxx - sx * sx), bar);
}

void report_seconds(const char* method, const Shape& shape, Index count, double bar) {
  const Points points = shape.make(count);
  const double seconds = least_seconds([&] { return detection_seconds(points, method); });
  std::printf("%-18s %-15s %8td points %9.4f s (bar %g)\n", method, shape.name, points.rows(),
              seconds, bar);
}

void report_all() {
  const Shape sheets{"two sheets", two_sheets}, shuffled{"shuffled sheets", shuffled_sheets},
      offset{"offset sheets", offset_sheets},
      object{"bumpy object", [](Index n) { return bumpy_object(n); }},
      sphere{"around a sphere", around_sphere};
  constexpr Index count = 100'000;
  for (const Shape& shape : {sheets, shuffled, object})
    report_units("separation", shape, count, 30);
  for (const Shape& shape : {sheets, object}) report_growth("separation", shape, 1.2);
  for (const Shape& shape : {offset, object}) {
    report_units("separation_normals", shape, count, 150);
    report_units("normals_only", shape, count, 30);
  }
  for (const Shape& shape : {sphere, offset, object}) report_seconds("sphere", shape, 10'000, 0.3);
}

}  // namespace

}  // namespace symsurf::benchmarks

int main() { symsurf::benchmarks::report_all(); }
