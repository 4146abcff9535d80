#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "described.h"

// generate CLASS OUTPUT: the output's suffix says what is made of the class's description: a VTK
// header (.h), a VTK source (.cxx), or a server-manager XML (.xml) from the template that a third
// argument names.

using namespace symsurf::front_ends;

namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::invalid_argument(path + " cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string made(const Described& d, const std::string& output, const char* xml_template) {
  const std::string suffix = output.substr(output.rfind('.') + 1);
  if (suffix == "h") return d.operation ? operation_header(d) : parameters_header(d);
  if (suffix == "cxx") return d.operation ? operation_source(d) : parameters_source(d);
  if (suffix == "xml" && xml_template) return server_manager_xml(d, content_of(xml_template));
  throw std::invalid_argument("cannot make " + output);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) throw std::invalid_argument("usage: generate CLASS OUTPUT [TEMPLATE]");
  const std::string text = made(described(argv[1]), argv[2], argc > 3 ? argv[3] : nullptr);
  std::ofstream file(argv[2]);
  file << text << std::flush;
  if (!file) throw std::runtime_error(std::string("cannot write ") + argv[2]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "generate: " << error.what() << "\n";
  return 1;
}
