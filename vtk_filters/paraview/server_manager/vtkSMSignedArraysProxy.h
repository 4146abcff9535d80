/**
 * @class vtkSMSignedArraysProxy
 * @brief A filter's proxy that lets the colours of signed arrays lie evenly about 0.
 *
 * Each point array that a hint of the proxy names, `<SignedArray name="..."/>`, gets a colour map
 * from -m to m, m being the largest size that it has had, whenever the filter has run. ParaView
 * does not rescale it to the data's range by itself; where the user has changed that, or the range,
 * it stays as the user wants it.
 */
#ifndef vtkSMSignedArraysProxy_h
#define vtkSMSignedArraysProxy_h

#include "vtkSMSourceProxy.h"
#include "vtkSymsurfServerManagerModule.h"  // for the export macro

class VTKSYMSURFSERVERMANAGER_EXPORT vtkSMSignedArraysProxy : public vtkSMSourceProxy {
 public:
  static vtkSMSignedArraysProxy* New();
  vtkTypeMacro(vtkSMSignedArraysProxy, vtkSMSourceProxy);

  void PostUpdateData(bool using_cache) override;

 protected:
  vtkSMSignedArraysProxy() = default;
  ~vtkSMSignedArraysProxy() override = default;

 private:
  vtkSMSignedArraysProxy(const vtkSMSignedArraysProxy&) = delete;
  void operator=(const vtkSMSignedArraysProxy&) = delete;

  void CentreColours(const char* array);
};

#endif
