#pragma once

#include <symsurf/io.h>

#include <string_view>

// The formats, one source each. All take a file's content and throw InvalidInput with the reason,
// and the line where there are lines; read() adds the file's name and drops normals that some
// points lack.

namespace symsurf {

/// Turk's Polygon File Format 1.0: ascii, binary_little_endian, binary_big_endian. Elements but
/// vertex, those with polygons and tristrips, and properties but x y z nx ny nz and vertex_indices
/// (vertex_index), are skipped.
Shape read_ply(std::string_view content);

/// Wavefront OBJ: v, vn and f. A vertex's normal is the one that its faces' corners name (their
/// mean where they differ); without any in the faces, the normals are the vertices' in order if
/// there are as many.
Shape read_obj(std::string_view content);

/// Geomview's OFF, COFF, NOFF, CNOFF, with or without texture coordinates (ST); ascii, the keyword
/// missing or glued to the first number as well.
Shape read_off(std::string_view content);

/// Stereolithography, ascii in any case or binary. Equal corners of the triangles are one point.
Shape read_stl(std::string_view content);

/// XYZ, CSV, TXT and FCSV: rows of numbers, as read() describes them.
Shape read_columns(std::string_view content);

}  // namespace symsurf
