/**
 * @class vtkMirrorReflection
 * @brief Reflects a shape over a mirror that vtkMirrorDetection found.
 *
 * Input 0 is what is reflected, input 1 the mirror: output 1 of vtkMirrorDetection, whose field
 * data (Kind and numbers) says everything; its triangles, of candidates or not, are not looked at,
 * so one saved and read again will do. Cells are turned over, so that the outside stays the
 * outside; active vectors, normals and tensors of points are reflected by the local Jacobian,
 * normals of cells are not passed on. Points that have no image over the mirror (beyond a sphere's
 * centre) are left out, together with the cells that need them.
 */
#ifndef vtkMirrorReflection_h
#define vtkMirrorReflection_h

#include "vtkShapeAlgorithm.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkMirrorReflection : public vtkShapeAlgorithm {
 public:
  static vtkMirrorReflection* New();
  vtkTypeMacro(vtkMirrorReflection, vtkShapeAlgorithm);

  /**
   * Connects the mirror, input 1.
   */
  void SetMirrorConnection(vtkAlgorithmOutput* mirror) { this->SetInputConnection(1, mirror); }

 protected:
  vtkMirrorReflection();
  ~vtkMirrorReflection() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  vtkMirrorReflection(const vtkMirrorReflection&) = delete;
  void operator=(const vtkMirrorReflection&) = delete;
};

#endif
