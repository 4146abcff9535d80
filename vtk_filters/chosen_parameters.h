#ifndef chosen_parameters_h
#define chosen_parameters_h

#include <symsurf/parameter.h>

class vtkMirrorDetectionParameters;
class vtkMirrorSampleSourceParameters;
class vtkPointDamageParameters;
class vtkSymmetryAnalysisParameters;

/// The parameters of what the filter is set to do, by the core's names.
symsurf::Values chosen_parameters(vtkMirrorDetectionParameters* filter);
symsurf::Values chosen_parameters(vtkMirrorSampleSourceParameters* filter);
symsurf::Values chosen_parameters(vtkPointDamageParameters* filter);
symsurf::Values chosen_parameters(vtkSymmetryAnalysisParameters* filter);

#endif
