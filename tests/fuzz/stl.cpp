#include "reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::fuzz_reader(symsurf::read_stl, data, size);
  return 0;
}
