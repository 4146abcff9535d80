#ifndef described_arrays_h
#define described_arrays_h

#include <symsurf/operations.h>

#include <map>
#include <string>
#include <vector>

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

class vtkPolyData;

/// The values of an array that an operation or an analysis gives each point, in VTK's type for it.
vtkSmartPointer<vtkDataArray> array_of(const symsurf::PointArray& described,
                                       const Eigen::MatrixXd& rows);

/// Adds each of the arrays that there is to the output's point data, its name after the prefix, and
/// makes the one to show the active scalars. `shown`: empty for none.
void add_point_arrays(vtkPolyData* output, const std::string& prefix,
                      const std::vector<symsurf::PointArray>& described,
                      const std::map<std::string, Eigen::MatrixXd>& arrays,
                      const std::string& shown);

#endif
