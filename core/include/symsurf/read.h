#pragma once

#include <symsurf/types.h>

#include <filesystem>

namespace symsurf {

/// What a file holds, in its own units and order.
struct Shape {
  Points points;
  Triangles faces;  ///< no rows for a bare cloud; polygons come as fans of triangles
  Points normals;   ///< no rows where the file has none
};

/// Reads PLY, OBJ, OFF, STL, XYZ, CSV or TXT, told apart by suffix. Coordinates keep every digit a
/// double holds. Throws InvalidInput naming the file and the reason: unknown suffix, not readable,
/// broken, truncated, no points.
Shape read(const std::filesystem::path& path);

}  // namespace symsurf
