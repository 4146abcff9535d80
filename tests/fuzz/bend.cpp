#include <string>

#include "draw.h"
#include "result.h"

namespace symsurf {
namespace {

// To lay out a surface takes some ten thousand searches for its closest point.
std::string kind(Source& source) {
  const std::string drawn = one_of(mirror_kinds, source);
  return drawn == "surface" && !one_in(source, 64) ? "cylinder" : drawn;
}

void fuzz(Source& source) {
  const std::shared_ptr<Mirror> mirror = drawn_mirror(source, kind(source));
  const Points points = cloud(source, most_for_searches);
  const auto way = source.ConsumeBool() ? Bend::Straighten : Bend::Restore;
  show_rows("points", points);
  if (one_in(source, 2))
    mirror->set_footprint(std::make_shared<Points>(cloud(source, most_for_searches)));
  show_rows("footprint", mirror->footprint().matrix());
  show("way", way == Bend::Straighten ? "straighten" : "restore");
  runs([&] { expect(bend(points, *mirror, way).rows() == points.rows(), "a row a point"); });
  runs([&] { expect_finite(straight_mirror(*mirror, points)); });
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::runs([&] { symsurf::fuzz(source); });
  return 0;
}
