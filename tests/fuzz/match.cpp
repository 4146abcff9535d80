#include "draw.h"
#include "result.h"

namespace symsurf {
namespace {

void fuzz(Source& source) {
  const std::shared_ptr<Mirror> mirror = drawn_mirror(source);
  const Points points = cloud(source);
  const double pair_distance = number(source);
  const bool refuse_nonfinite = one_in(source, 8);
  show_rows("points", points);
  show("pair_distance", to_string(Value(pair_distance)));
  expect_sound(match(points, *mirror, pair_distance, Context({}, 1), refuse_nonfinite),
               points.rows());
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::runs([&] { symsurf::fuzz(source); });
  return 0;
}
