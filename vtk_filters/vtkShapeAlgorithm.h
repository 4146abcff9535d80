/**
 * @class vtkShapeAlgorithm
 * @brief A filter whose input 0 is a shape, in whichever kind of data set.
 *
 * - vtkPolyData: as it is.
 * - Other point sets (vtkUnstructuredGrid, vtkStructuredGrid): the surface of their cells, as
 *   vtkGeometryFilter gives it; without cells, their points.
 * - Images (vtkImageData, vtkRectilinearGrid): a vertex at each point whose scalar is greater than
 *   ImageThreshold. The scalars are the active ones of the points, or the array that
 *   SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name) names.
 * - Composites (vtkMultiBlockDataSet, vtkPartitionedDataSet): all their blocks as one shape, with
 *   the arrays that all blocks have.
 *
 * Where an output is said to be the input, it is the vtkPolyData that comes of this. Another kind
 * of data, a mirror (data with the field data array Kind, such as output 1 of vtkMirrorDetection),
 * an image without scalars and a cell that names a point that is not there are errors.
 */
#ifndef vtkShapeAlgorithm_h
#define vtkShapeAlgorithm_h

#include "vtkPolyDataAlgorithm.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkShapeAlgorithm : public vtkPolyDataAlgorithm {
 public:
  vtkTypeMacro(vtkShapeAlgorithm, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Of an image: the points whose scalar is greater are the shape. In the unit of the scalars; 0.5
   * initially, for masks of 0 and 1.
   */
  vtkSetMacro(ImageThreshold, double);
  vtkGetMacro(ImageThreshold, double);
  ///@}

 protected:
  vtkShapeAlgorithm() = default;
  ~vtkShapeAlgorithm() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;

  double ImageThreshold = 0.5;

 private:
  vtkShapeAlgorithm(const vtkShapeAlgorithm&) = delete;
  void operator=(const vtkShapeAlgorithm&) = delete;
};

#endif
