#ifndef field_values_h
#define field_values_h

#include <symsurf/parameter.h>

class vtkFieldData;

/// Adds an array a value, named as VTK names things: "point_count" becomes "PointCount".
void add_field_values(vtkFieldData* field, const symsurf::Values& values);

/// The values of all arrays, by the core's names.
symsurf::Values field_values(vtkFieldData* field);

#endif
