#include "draw.h"
#include "result.h"

namespace symsurf {
namespace {

// Whatever a mirror does with points, it does with those of any cloud.
void fuzz(Source& source) {
  const std::shared_ptr<Mirror> mirror = drawn_mirror(source);
  expect_finite(*mirror);
  expect(runs([&] { make_mirror(mirror->kind(), mirror->numbers()); }),
         "a mirror's numbers make it again");
  const Points points = cloud(source);
  show_rows("points", points);
  expect(mirror->reflect(points).rows() == points.rows(), "an image a point");
  expect(mirror->signed_distance(points).size() == points.rows(), "a distance a point");
  const int resolution = source.ConsumeIntegralInRange(-1, 8);
  runs([&] { expect(mirror->mesh(points, resolution).vertices.allFinite(), "a mesh is finite"); });
  runs([&] {
    const ReflectionPoints found = reflection_points(*mirror, points, vector(source));
    expect(found.positions.allFinite() && found.path_lengths.allFinite(),
           "a path of finite length");
    expect(!(found.irradiance.array() < 0).any(), "light is not negative");
  });
  RandomCloud random(source.ConsumeIntegral<std::uint8_t>());
  expect_finite(*mirror->transformed(number(source), random.rotation(), vector(source)));
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::runs([&] { symsurf::fuzz(source); });
  return 0;
}
