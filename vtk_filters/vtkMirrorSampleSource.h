/**
 * @class vtkMirrorSampleSource
 * @brief Makes points whose mirror is known.
 *
 * An optional input gives the points that the generators "fixed" and "spherical" mirror; without
 * one they sample a surface. The outputs are
 *
 * - 0 "Sample": the points, then their images, a vertex each. Point data: MirrorPartner, the index
 *   of the image or of the point it is the image of (-1 for none).
 * - 1 "Mirror": triangles of the true mirror. Field data: Kind and the numbers that define it.
 */
#ifndef vtkMirrorSampleSource_h
#define vtkMirrorSampleSource_h

#include "vtkMirrorSampleSourceParameters.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkMirrorSampleSource : public vtkMirrorSampleSourceParameters {
 public:
  static vtkMirrorSampleSource* New();
  vtkTypeMacro(vtkMirrorSampleSource, vtkMirrorSampleSourceParameters);

  enum OutputPorts { SAMPLE = 0, MIRROR = 1 };

 protected:
  vtkMirrorSampleSource();
  ~vtkMirrorSampleSource() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  vtkMirrorSampleSource(const vtkMirrorSampleSource&) = delete;
  void operator=(const vtkMirrorSampleSource&) = delete;
};

#endif
