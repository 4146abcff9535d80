// asymmetry FILE: finds the mirror plane of a shape and measures how its sides differ.
#include <symsurf/symsurf.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 2) throw symsurf::InvalidInput("one file is needed");
  const symsurf::Shape shape = symsurf::read(argv[1]);
  const symsurf::Result found =
      symsurf::detect(shape.points, {.method = "plane", .faces = shape.faces});
  std::cout << found.verdict() << ": " << found.reason() << "\n";
  if (!found.mirror) return 1;
  for (const auto& [name, value] : found.mirror->numbers())
    std::cout << name << " " << symsurf::to_string(value) << "\n";

  const symsurf::OperationResult asymmetry =
      symsurf::operate("asymmetry", {shape.points, shape.faces}, *found.mirror);
  for (const char* name : {"rms", "p95", "maximum"})
    std::cout << name << " " << symsurf::to_string(asymmetry.statistics.at(name)) << "\n";
  const Eigen::MatrixXd& distances = asymmetry.arrays.at("distance");  // one row a point
  std::cout << distances.rows() << " distances\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
