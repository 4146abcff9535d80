#include <symsurf/symsurf.h>

#include <iostream>
#include <string>

int main(int argc, char** argv) try {
  if (argc != 2) throw symsurf::InvalidInput("one file is needed");
  const symsurf::Shape shape = symsurf::read(argv[1]);
  const symsurf::Result result = symsurf::detect(shape.points, {.method = "plane"});
  if (!result.mirror) throw symsurf::InvalidInput(std::string(argv[1]) + ": no mirror plane");
  for (const auto& [name, value] : result.mirror->numbers())
    std::cout << name << " " << symsurf::to_string(value) << "\n";
} catch (const symsurf::InvalidInput& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
