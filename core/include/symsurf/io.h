#pragma once

// Reading files.

#include <symsurf/points.h>

#include <cstdint>
#include <filesystem>

namespace symsurf {

/// The bytes of memory that the process may have: the machine's, or less where it is limited.
std::uintmax_t memory_limit();

/// What a file holds, in its own units and order.
struct Shape {
  Points points;    ///< as they stand in the file: some may not be finite
  Triangles faces;  ///< no rows for a bare cloud; polygons come as fans of triangles
  Points normals;   ///< no rows where a finite point has none, or one that is 0 or not finite
  Points colours;   ///< red, green, blue as they stand in the file; no rows where it has none
  /// Of each triangle the number of the polygon that it is a part of; no rows where all polygons
  /// are triangles.
  Eigen::Matrix<Index, Eigen::Dynamic, 1> polygons;
};

/// Reads PLY, OBJ, OFF, STL, XYZ, CSV, TXT or FCSV, distinguished by suffix. Coordinates keep every
/// digit a double holds.
///
/// XYZ, CSV, TXT and FCSV hold rows of numbers, separated by blanks and tabs, by commas or by
/// semicolons, with decimal commas where these do not separate; comments start with # or //. A
/// first row of names, or a comment such as "# columns = id,x,y,z", says which columns are x, y, z
/// and, if it names them, nx, ny, nz (or Points:0, Normals:0, ..., as ParaView writes them);
/// capitals and units in brackets do not count. The first row may be the number of rows. Without
/// names the first three columns are the point, the next three its normal if there are exactly six,
/// unless they are colours: whole numbers from 0 to 255, some above 1. Other columns are ignored.
/// Four or more without names, the first of which counts the rows, are refused.
///
/// Throws InvalidInput naming the file and the reason, in text files with the line:
/// unknown suffix, not readable, empty, larger than half of the memory, broken, truncated, no
/// points.
Shape read(const std::filesystem::path& path);

}  // namespace symsurf
