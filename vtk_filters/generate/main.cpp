#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "described.h"

// generate CLASS OUTPUT: the output's suffix says what is made of the class's description: a VTK
// header (.h), a VTK source (.cxx), or a server-manager XML (.xml) from the template that a third
// argument names, in which the line with @PARAMETERS@ gives way to the properties.

using namespace symsurf::front_ends;

namespace {

std::string filled_template(const std::string& path, const std::string& properties) {
  std::ifstream file(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t mark = text.find("@PARAMETERS@");
  if (mark == std::string::npos)
    throw std::invalid_argument(path + " cannot be read or has no @PARAMETERS@");
  const std::size_t begin = text.rfind('\n', mark) + 1, end = text.find('\n', mark) + 1;
  return text.substr(0, begin) + properties + text.substr(end);
}

std::string made(const Described& d, const std::string& output, const char* xml_template) {
  const std::string suffix = output.substr(output.rfind('.') + 1);
  if (suffix == "h") return parameters_header(d);
  if (suffix == "cxx") return parameters_source(d);
  if (suffix == "xml" && xml_template)
    return filled_template(xml_template, server_manager_properties(d));
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
