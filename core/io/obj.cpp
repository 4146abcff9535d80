#include <string>
#include <vector>

#include "formats.h"
#include "text_scanner.h"

namespace symsurf {

namespace {

// References to one of the file's lists. They may stand before what they name, so the farthest one
// is kept and checked at the end.
class References {
 public:
  explicit References(const char* what) : what_(what) {}

  bool any() const { return line_ > 0; }

  // The index for a number from 1 on, or from -1 backwards from the last of the `size` so far.
  Index resolve(const TextScanner& text, std::string_view word, Index size) {
    Index number = 0;
    if (!parse(word, number) || number == 0 || number < -size)
      text.fail("a corner names " + what_ + " " + in_quotes(word) + "; there are " +
                std::to_string(size) + " so far, counted from 1");
    const Index index = number > 0 ? number - 1 : size + number;
    if (index > farthest_) {
      farthest_ = index;
      line_ = text.line_number();
    }
    return index;
  }

  void require_below(Index size) const {
    if (farthest_ >= size)
      TextScanner::fail("a corner names " + what_ + " " + std::to_string(farthest_ + 1) +
                            "; there are " + std::to_string(size) + ", counted from 1",
                        line_);
  }

 private:
  std::string what_;
  Index farthest_ = -1, line_ = 0;
};

struct Corner {
  Index point, normal;
};

// The normals of the points, from those that the corners of the faces name.
class CornerNormals {
 public:
  CornerNormals(Index points, const std::vector<Vector3>& normals)
      : normals_(normals), first_(points, -1), sum_(points, Vector3::Zero()), differ_(points) {}

  void add(const Corner& corner) {
    Index& first = first_[corner.point];
    if (first < 0) first = corner.normal;
    differ_[corner.point] = differ_[corner.point] || first != corner.normal;
    sum_[corner.point] += normals_[corner.normal];
  }

  // Zero where no corner names one; as written, digit for digit, where all name the same.
  Vector3 of(Index point) const {
    if (first_[point] < 0) return Vector3::Zero();
    return differ_[point] && !sum_[point].isZero() ? sum_[point].normalized()
                                                   : normals_[first_[point]];
  }

 private:
  const std::vector<Vector3>& normals_;
  std::vector<Index> first_;
  std::vector<Vector3> sum_;
  std::vector<bool> differ_;
};

}  // namespace

Shape read_obj(std::string_view content) {
  TextScanner text(content);
  text.cut_at('#');
  text.join_at('\\');
  ShapeBuilder shape;
  std::vector<Vector3> normals;
  std::vector<Corner> corners;
  References to_points("vertex"), to_normals("normal");
  std::vector<Index> face;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "v") {
      shape.add_point(text.vector("a coordinate"));
      shape.add_colour(text.colour());
    } else if (keyword == "vn") {
      normals.push_back(text.vector("a coordinate of the normal"));
    } else if (keyword == "f") {
      face.clear();
      while (!text.line_ends()) {
        // vertex, vertex/texture, vertex//normal or vertex/texture/normal
        const std::string_view word = text.word();
        const std::size_t end = std::min(word.find('/'), word.size());
        const std::size_t last = word.rfind('/');
        face.push_back(to_points.resolve(text, word.substr(0, end), shape.points()));
        if (last != word.npos && last > end && last + 1 < word.size())
          corners.push_back({face.back(), to_normals.resolve(text, word.substr(last + 1),
                                                             static_cast<Index>(normals.size()))});
      }
      shape.add_polygon(face);
    }
  }
  to_points.require_below(shape.points());
  to_normals.require_below(static_cast<Index>(normals.size()));

  if (to_normals.any()) {
    CornerNormals of_corners(shape.points(), normals);
    for (const Corner& corner : corners) of_corners.add(corner);
    for (Index p = 0; p < shape.points(); ++p) shape.add_normal(of_corners.of(p));
  } else if (static_cast<Index>(normals.size()) == shape.points()) {
    for (const Vector3& normal : normals) shape.add_normal(normal);
  }
  return shape.build();
}

}  // namespace symsurf
