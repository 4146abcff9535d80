#ifndef chosen_parameters_h
#define chosen_parameters_h

#include <symsurf/value.h>

class vtkMirrorDetectionParameters;

/// The parameters of what the filter is set to do, by the core's names.
symsurf::Values chosen_parameters(vtkMirrorDetectionParameters* filter);

#endif
