#include "draw.h"
#include "result.h"

namespace symsurf {
namespace {

void fuzz(Source& source) {
  const Method& method = one_of(methods(), source);
  const Points points = cloud(source);
  const bool has_faces = one_in(source, 4), has_normals = one_in(source, 4);
  Options options{.method = method.name, .parameters = parameters(source, method)};
  const Triangles triangles = has_faces ? faces(source, points.rows()) : Triangles(0, 3);
  const Points directions = has_normals ? normals(source, points.rows()) : Points(0, 3);
  options.faces = triangles;
  options.normals = directions;
  options.seed = source.ConsumeIntegral<std::uint8_t>();
  options.refuse_nonfinite = one_in(source, 8);
  show("method", '"' + method.name + '"');
  show("parameters", options.parameters);
  show_rows("points", points);
  show_rows("faces", triangles);
  show_rows("normals", directions);
  runs([&] { expect_sound(detect(points, options, Context({}, 1)), points.rows()); });
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::fuzz(source);
  return 0;
}
