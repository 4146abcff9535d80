/**
 * @class vtkSymmetryAnalysis
 * @brief Finds symmetries of a shape other than one mirror: its point group, its repeated parts.
 *
 * Analysis chooses what is sought; each has its own parameters. Input 1, optional, is the second of
 * two shapes, for match_pair alone. The outputs are
 *
 * - 0 "Shape": the input. Point data: what the analysis gives each point, in arrays that begin with
 *   its title ("PartialSymmetriesTransformation"), one of them the active scalars. Field data:
 * Analysis and its statistics.
 * - 1 "Elements": mirror planes as triangles and axes of rotation as lines over the shape. Cell
 *   data: ElementKind ("plane" or "axis"), ElementIndex (from 0, of each kind) and ElementOrder (of
 *   an axis: a turn by 360 degrees / order maps the shape onto itself, 0: any turn; of a plane 2).
 * - 2 "Transformations": a vertex for each, at the image of the centroid of what it maps. Point
 * data: Kind ("rotation", "reflection", ...), Score, Matrix (16 numbers, row by row), FromPoints
 * and OntoPoints (how many points it maps, and onto how many).
 *
 * Points that are not finite are left out, with a warning; in arrays they have NaN, -1 or 0. Too
 * few others, points on one line, an unknown analysis or a value out of range are errors and leave
 * the outputs empty. A shape without symmetry is no error. Where several processes share out the
 * input, one of them must have all of it; that they do not is an error of all.
 */
#ifndef vtkSymmetryAnalysis_h
#define vtkSymmetryAnalysis_h

#include <string>

#include "vtkSymmetryAnalysisParameters.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkSymmetryAnalysis : public vtkSymmetryAnalysisParameters {
 public:
  static vtkSymmetryAnalysis* New();
  vtkTypeMacro(vtkSymmetryAnalysis, vtkSymmetryAnalysisParameters);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Connects the second of two shapes, input 1.
   */
  void SetOtherConnection(vtkAlgorithmOutput* other) { this->SetInputConnection(1, other); }

  /**
   * Leaves input 1 without a connection.
   */
  void RemoveOther() { this->SetInputConnection(1, nullptr); }

  enum OutputPorts { SHAPE = 0, ELEMENTS = 1, TRANSFORMATIONS = 2 };

  ///@{
  /**
   * Whether the input's polygons are used. Otherwise its points alone are. On initially.
   */
  vtkSetMacro(UseFaces, bool);
  vtkGetMacro(UseFaces, bool);
  vtkBooleanMacro(UseFaces, bool);
  ///@}

  ///@{
  /**
   * Whether a point that is not finite is an error. Otherwise such points are left out.
   */
  vtkSetMacro(RefuseNonfinite, bool);
  vtkGetMacro(RefuseNonfinite, bool);
  vtkBooleanMacro(RefuseNonfinite, bool);
  ///@}

  ///@{
  /**
   * The name of the point array, of any number of components, whose colours SymmetriesTexture
   * compares. Empty, or None: the active scalars.
   */
  vtkSetStdStringFromCharMacro(ColourArray);
  vtkGetCharFromStdStringMacro(ColourArray);
  ///@}

 protected:
  vtkSymmetryAnalysis();
  ~vtkSymmetryAnalysis() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  bool UseFaces = true;
  bool RefuseNonfinite = false;
  std::string ColourArray;

 private:
  vtkSymmetryAnalysis(const vtkSymmetryAnalysis&) = delete;
  void operator=(const vtkSymmetryAnalysis&) = delete;
};

#endif
