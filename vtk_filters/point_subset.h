#ifndef point_subset_h
#define point_subset_h

#include <symsurf/points.h>

#include <vector>

class vtkPolyData;

/// Makes the output the rows `kept` (rising) of the input, moved to `points`, with their data and
/// with the cells that need no other rows. All rows: the cells as they are.
void set_subset(vtkPolyData* output, vtkPolyData* input, const symsurf::Points& points,
                const std::vector<symsurf::Index>& kept);

#endif
