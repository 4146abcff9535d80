#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// m x 3 contiguous indices into a point set that belong to somebody else, read where they lie.
class TrianglesView {
 public:
  TrianglesView() = default;
  TrianglesView(const Index* corners, Index size) : data_(corners), size_(size) {}
  TrianglesView(const Triangles& triangles) : data_(triangles.data()), size_(triangles.rows()) {}

  Index size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Index* data() const { return data_; }

  /// The three corners of a triangle.
  const Index* operator[](Index i) const { return data_ + 3 * i; }

 private:
  const Index* data_ = nullptr;
  Index size_ = 0;
};

}  // namespace symsurf
