#include <algorithm>
#include <limits>

#include "draw.h"
#include "impatient.h"
#include "result.h"

namespace symsurf {
namespace {

void expect_patch(const std::vector<Index>& patch, Index points) {
  for (std::size_t i = 0; i < patch.size(); ++i) {
    expect(patch[i] >= 0 && patch[i] < points, "a patch is of points");
    expect(i == 0 || patch[i - 1] < patch[i], "a patch is ascending");
  }
}

// What a description promises of every result.
void expect_as_described(const AnalysisResult& result, const Analysis& analysis, Index points) {
  for (const auto& [name, array] : result.arrays) {
    const auto described = std::find_if(analysis.arrays.begin(), analysis.arrays.end(),
                                        [&](const PointArray& each) { return each.name == name; });
    expect(described != analysis.arrays.end(), "arrays are described");
    expect(array.rows() == points && array.cols() == described->components,
           "arrays have a row a point");
    if (!described->names_points) continue;
    for (const double index : array.reshaped())
      expect(index >= -1 && index < static_cast<double>(points), "what names points names one");
  }
  for (const Plane& plane : result.planes) expect_finite(plane);
  for (const SymmetryAxis& axis : result.axes)
    expect(axis.point.allFinite() && axis.direction.allFinite() && axis.order >= 0,
           "axes are finite");
  for (const Transformation& each : result.transformations) {
    expect(each.matrix.allFinite(), "transformations are finite");
    expect(each.score >= 0 && each.score <= 1, "a score is in [0, 1]");
    expect(each.from.empty() == each.onto.empty(), "a patch is mapped onto a patch");
    expect_patch(each.from, points);
    expect_patch(each.onto, points);
  }
  for (const auto& [name, value] : result.statistics)
    expect(is_finite(value), "statistics are finite");
}

void fuzz(Source& source) {
  const Analysis& analysis = one_of(analyses(), source);
  Points points = cloud(source, most_for_searches);
  if (points.rows() > 0 && one_in(source, 8))
    points(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const Triangles triangles = one_in(source, 2) ? faces(source, points.rows()) : Triangles(0, 3);
  AnalysisOptions options;
  options.parameters = parameters(source, analysis.parameters);
  options.faces = triangles;
  options.refuse_nonfinite = one_in(source, 2);
  const Points other = analysis.takes_other ? cloud(source, most_for_searches) : Points(0, 3);
  options.other = other;
  show("analysis", '"' + analysis.name + '"');
  show("parameters", options.parameters);
  show_rows("points", points);
  show_rows("faces", triangles);
  show_rows("other", other);
  expect_as_described(analyse(analysis.name, points, options, impatient(source)), analysis,
                      points.rows());
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::runs([&] { symsurf::fuzz(source); });
  return 0;
}
