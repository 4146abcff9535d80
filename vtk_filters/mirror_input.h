#ifndef mirror_input_h
#define mirror_input_h

#include <symsurf/mirror.h>

#include <memory>

class vtkPolyData;

/// The mirror that the field data of a mirror detection's output "Mirror" describes.
/// Throws InvalidInput where it describes none.
std::shared_ptr<symsurf::Mirror> mirror_of(vtkPolyData* data);

#endif
