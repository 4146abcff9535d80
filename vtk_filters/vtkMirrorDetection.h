/**
 * @class vtkMirrorDetection
 * @brief Finds the mirror of a point set: a plane, a sphere or a curved surface.
 *
 * Its input is a shape, see vtkShapeAlgorithm; the input below is the poly data that come of it.
 * Where the input has polygons, samples spread evenly over their surface find the mirror, unless
 * UseFaces is off; score and candidates are then those of the samples, the rest is of the input's
 * points. The outputs are
 *
 * - 0 "Shape": the input. Point data: MirrorPartner (index of the partner, -1 for none),
 *   MirrorResidual (NaN for none) and MirrorSide (the sign of the point's distance from the
 *   mirror). Field data: Kind, Score and Verdict of the mirror, and MirrorResidualP99, which at
 * most a hundredth of the residuals exceeds (NaN without any).
 * - 1 "Mirror": triangles of the mirror over the object's footprint. Field data: Method (the one
 *   that found it), Kind, Score (the share of the shape that it maps as well as the sampling shows,
 *   0 to 1), the mirror's numbers (Normal and Offset of a plane, in input units), the method's
 *   statistics and, where there are other mirrors, the candidates, a row each, best first:
 *   CandidateScores and, of planes, CandidateNormals and CandidateOffsets. No triangles where the
 *   method gives surface points only. Cell data: Rank and Score of the mirror that a triangle
 *   belongs to, 0 the result, from 1 the candidates, which are there where ShowCandidates is on.
 *   The field data stays that of the result.
 * - 2 "Surface Points": a vertex in the middle of each pair, at most half its residual off the
 *   mirror; perpendicular, quadric and fixed_direction project it onto that. Point data: Residual,
 *   the distance from a point's image to its partner.
 *
 * Where several processes share out the input, each has its own part of outputs 0 and 2, the first
 * has the triangles of output 1, and all have its field data. The mirror is that of the whole, and
 * partners are sought in the whole: MirrorPartner counts through the points of all processes, in
 * the order of their ranks. A process may have no points. They use the points only, no polygons.
 *
 * Points are read where they lie when they are contiguous doubles, from one copy otherwise. A
 * cloud without symmetry is no error but a mirror with a low score and the Verdict "none" in the
 * field data. Points that are not finite are left out, with a warning, and have no
 * partners. Too few others, points on one line, an unknown method or a value out of range are
 * errors and leave the outputs empty.
 */
#ifndef vtkMirrorDetection_h
#define vtkMirrorDetection_h

#include "vtkMirrorDetectionParameters.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkMirrorDetection : public vtkMirrorDetectionParameters {
 public:
  static vtkMirrorDetection* New();
  vtkTypeMacro(vtkMirrorDetection, vtkMirrorDetectionParameters);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutputPorts { SHAPE = 0, MIRROR = 1, SURFACE_POINTS = 2 };

  ///@{
  /**
   * Whether the input's point normals are used, as lines: their sign does not count. Otherwise the
   * methods that need normals estimate them.
   */
  vtkSetMacro(UseNormals, bool);
  vtkGetMacro(UseNormals, bool);
  vtkBooleanMacro(UseNormals, bool);
  ///@}

  ///@{
  /**
   * Whether the input's polygons are used: samples of them find the mirror. Otherwise its points
   * alone do. On initially.
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
   * Whether output 1 has the triangles of the candidates too, behind those of the result. Off
   * initially.
   */
  vtkSetMacro(ShowCandidates, bool);
  vtkGetMacro(ShowCandidates, bool);
  vtkBooleanMacro(ShowCandidates, bool);
  ///@}

  ///@{
  /**
   * Seed of the methods that draw at random.
   */
  vtkSetMacro(Seed, unsigned int);
  vtkGetMacro(Seed, unsigned int);
  ///@}

 protected:
  vtkMirrorDetection();
  ~vtkMirrorDetection() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  bool UseNormals = false;
  bool UseFaces = true;
  bool RefuseNonfinite = false;
  bool ShowCandidates = false;
  unsigned int Seed = 0;

 private:
  vtkMirrorDetection(const vtkMirrorDetection&) = delete;
  void operator=(const vtkMirrorDetection&) = delete;
};

#endif
