#include <string_view>

#include "draw.h"
#include "impatient.h"
#include "result.h"

namespace symsurf {
namespace {

// Under sanitizers these take seconds for a cloud on which the others take milliseconds.
bool is_slow(const Method& method) {
  return method.name == "auto" || method.name == "sphere" || method.name == "cylinder";
}

const Method& drawn_method(Source& source) {
  const Method& method = one_of(methods(), source);
  return is_slow(method) && !one_in(source, 16) ? symsurf::method("plane") : method;
}

// Mostly as few as hold what a cloud can have: the time of a search grows with their square.
Index most_of_a_cloud(Source& source) {
  constexpr Index few = 30;
  return one_in(source, 16) ? most_for_searches : few;
}

// What a mirror refuses where it is made is no fault of the points.
bool is_of_a_mirror(const InvalidInput& error) {
  return std::string_view(error.what()).find(" needs ") != std::string_view::npos;
}

void fuzz(Source& source) {
  const Method& method = drawn_method(source);
  const Points points = cloud(source, most_of_a_cloud(source));
  const bool has_faces = one_in(source, 4), has_normals = one_in(source, 4);
  Options options{.method = method.name, .parameters = parameters(source, method.parameters)};
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
  const Context context = impatient(source);
  runs([&] {
    try {
      expect_sound(detect(points, options, context), points.rows());
    } catch (const InvalidInput& error) {
      expect(!is_of_a_mirror(error), error.what());
      throw;
    }
  });
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::fuzz(source);
  return 0;
}
