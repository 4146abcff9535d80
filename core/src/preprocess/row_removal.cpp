#include "preprocess/row_removal.h"

#include <algorithm>
#include <utility>

#include "base/gathered.h"

namespace symsurf {

RowRemoval::RowRemoval(std::vector<Index> own, Index first, const Context& context)
    : own_(std::move(own)), all_(own_) {
  for (Index& i : all_) i += first;
  all_ = concatenated(context, all_);
}

Points RowRemoval::apply(PointsView rows) const {
  Points left(rows.size() - static_cast<Index>(own_.size()), 3);
  Index begin = 0, written = 0;
  const auto copy_up_to = [&](Index end) {
    left.middleRows(written, end - begin) = rows.matrix().middleRows(begin, end - begin);
    written += end - begin;
    begin = end + 1;
  };
  for (const Index removed : own_) copy_up_to(removed);
  copy_up_to(rows.size());
  return left;
}

Triangles RowRemoval::apply(TrianglesView faces, Index points) const {
  std::vector<Index> number(points);
  auto next = own_.begin();
  for (Index i = 0, left = 0; i < points; ++i) {
    const bool removed = next != own_.end() && *next == i;
    number[i] = removed ? -1 : left++;
    if (removed) ++next;
  }
  Triangles left(faces.size(), 3);
  Index row = 0;
  for (Index f = 0; f < faces.size(); ++f) {
    const Index* corner = faces[f];
    left.row(row) << number[corner[0]], number[corner[1]], number[corner[2]];
    row += left.row(row).minCoeff() >= 0;
  }
  left.conservativeResize(row, 3);
  return left;
}

void RowRemoval::map_back(Result& result) const {
  // As many removed points are before a point as have no more others before them than it has.
  const auto numbered = [&](Index other) {
    const auto is_before = [&](const Index& removed) {
      return removed - (&removed - all_.data()) <= other;
    };
    return other + (std::partition_point(all_.begin(), all_.end(), is_before) - all_.begin());
  };
  result.pairs = result.pairs.unaryExpr(numbered).eval();
  const auto unpaired = result.statistics.find("unpaired_points");
  if (unpaired != result.statistics.end()) std::get<Index>(unpaired->second) += count();
}

}  // namespace symsurf
