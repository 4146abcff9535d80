#ifndef mirror_input_h
#define mirror_input_h

#include <symsurf/mirror.h>

#include <memory>

class vtkDataObject;
class vtkPolyData;

/// Whether the data are a mirror: their field data have Kind. The shape of a detection has it too,
/// but beside MirrorResidualP99.
bool is_mirror(vtkDataObject* data);

/// The mirror that the field data of a mirror detection's output "Mirror" describes.
/// Throws InvalidInput where it describes none.
std::shared_ptr<symsurf::Mirror> mirror_of(vtkPolyData* data);

#endif
