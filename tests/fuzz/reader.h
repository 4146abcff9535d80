#pragma once

#include <cstdint>
#include <string_view>

#include "expect.h"
#include "io/formats.h"

namespace symsurf {

/// What every reader promises of every content: faces between points that are there.
inline void fuzz_reader(Shape (*read)(std::string_view), const std::uint8_t* data,
                        std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  runs([&] {
    const Shape shape = read(content);
    const Index points = shape.points.rows();
    for (const Index corner : shape.faces.reshaped())
      expect(corner >= 0 && corner < points, "a face's corner is a point");
  });
}

}  // namespace symsurf
