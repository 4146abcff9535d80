/**
 * @class vtkMirrorOperation
 * @brief What the filters that do something with a mirror have in common.
 *
 * Input 0 is the shape, see vtkShapeAlgorithm. Input 1, optional, is its mirror: output 1 of
 * vtkMirrorDetection, whose field data (Kind and numbers) says everything, in the unit and pose of
 * the shape. Without it the mirror is found first, by Method; where its verdict is "none", it is
 * used with a warning that says why, unless RequireFound is on.
 *
 * Input 2, optional, is the second of two shapes of a pair, such as a right bone, in a pose of its
 * own: in place of a mirror, for the asymmetry, the correspondences and the completion of the
 * first, with which the reflection of the second is compared. Both are meshes, or both bare clouds.
 *
 * Input 3, optional, with homologous pairing, has landmarks: points of which each two that follow
 * each other are to mirror each other. Their point array "Deviation", or else 0, is the standard
 * deviation of placing the two, input units.
 *
 * Output 0 has the points and cells of the input in their order, the points moved where the
 * operation moves them, with their data. Points and polygons that an operation adds come behind
 * those of the input, with the data of the points and cells that they are made from. Active
 * vectors, normals and tensors of points, and those named by Kinds, go along by the local Jacobian
 * J of what moves the points or makes images of them: vectors J v, normals J^-T n at their length,
 * tensors J T J'. Normals of points that are moved each by itself (symmetrization) and of cells are
 * not passed on. What the operation gives each point are point arrays that begin with the filter's
 * name without "vtk", one of them the active scalars. Figures about the whole are field data.
 * Polygons of more than three corners, and strips, are divided into triangles for the operation
 * alone.
 *
 * Points that are not finite, less than half of the points with an image over the mirror, an
 * unknown method or a value out of range are errors and leave the outputs empty. Where several
 * processes share out the input, one of them must have all of it; that they do not is an error of
 * all.
 */
#ifndef vtkMirrorOperation_h
#define vtkMirrorOperation_h

#include <string>  // for the members

#include "vtkSharedShapeAlgorithm.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkMirrorOperation : public vtkSharedShapeAlgorithm {
 public:
  vtkTypeMacro(vtkMirrorOperation, vtkSharedShapeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Connects the mirror, input 1.
   */
  void SetMirrorConnection(vtkAlgorithmOutput* mirror) { this->SetInputConnection(1, mirror); }

  /**
   * Leaves input 1 without a connection: the mirror is found first.
   */
  void RemoveMirror() { this->SetInputConnection(1, nullptr); }

  /**
   * Connects the second of two shapes, input 2, or leaves it without a connection.
   */
  void SetOtherConnection(vtkAlgorithmOutput* other) { this->SetInputConnection(2, other); }
  void RemoveOther() { this->SetInputConnection(2, nullptr); }

  /**
   * Connects the landmarks, input 3, or leaves it without a connection.
   */
  void SetLandmarksConnection(vtkAlgorithmOutput* landmarks) {
    this->SetInputConnection(3, landmarks);
  }
  void RemoveLandmarks() { this->SetInputConnection(3, nullptr); }

  ///@{
  /**
   * How the mirror is found where none is connected: a method of vtkMirrorDetection, with the
   * parameters that are there initially.
   */
  vtkSetStdStringFromCharMacro(Method);
  vtkGetCharFromStdStringMacro(Method);
  ///@}

  ///@{
  /**
   * Whether a mirror that is found first with the verdict "none" is an error. Off initially.
   */
  vtkSetMacro(RequireFound, bool);
  vtkGetMacro(RequireFound, bool);
  vtkBooleanMacro(RequireFound, bool);
  ///@}

  ///@{
  /**
   * What further point arrays are, as "wind=vector,stress=tensor": vector, normal, tensor, or
   * scalar for one that stays as it is. Empty initially: the active ones alone have directions.
   */
  vtkSetStdStringFromCharMacro(Kinds);
  vtkGetCharFromStdStringMacro(Kinds);
  ///@}

 protected:
  vtkMirrorOperation();
  ~vtkMirrorOperation() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override = 0;

  std::string Method, Kinds;
  bool RequireFound = false;

 private:
  vtkMirrorOperation(const vtkMirrorOperation&) = delete;
  void operator=(const vtkMirrorOperation&) = delete;
};

#endif
