/**
 * @class vtkSMColourRangesProxy
 * @brief A filter's proxy that chooses the colours of its arrays and how its outputs are shown at
 * first.
 *
 * Each hint of the proxy, `<ColourRange array="..." port="..." limit="..." signed="..."
 * title="..."/>`, gives a point array of an output port a colour map from 0 to m, or one from -m to
 * m that is white at 0 where it is signed, whenever the filter has run. m is the value of the field
 * data array that `limit` names, a percentile of the sizes, so that outliers do not take all the
 * colours; the largest size where that is rounding against it, or is not there. Values that are NaN
 * are grey, and the legend in the active view has the title. ParaView does not rescale the map to
 * the data's range by itself; where the user has changed that, or the range, it stays as the user
 * wants it.
 *
 * `<Display port="..." opacity="..." array="..." least_different="..." title="..."/>` makes an
 * output translucent when it is first shown, and colours it by a cell array if that has so many
 * different values, 1 or 2, otherwise blue. `<Summary fields="Kind Score Verdict"/>` names field
 * data of the first output that titles of legends have in front.
 */
#ifndef vtkSMColourRangesProxy_h
#define vtkSMColourRangesProxy_h

#include <string>

#include "vtkSMSourceProxy.h"
#include "vtkSymsurfServerManagerModule.h"  // for the export macro

class vtkPVXMLElement;

class VTKSYMSURFSERVERMANAGER_EXPORT vtkSMColourRangesProxy : public vtkSMSourceProxy {
 public:
  static vtkSMColourRangesProxy* New();
  vtkTypeMacro(vtkSMColourRangesProxy, vtkSMSourceProxy);

  void PostUpdateData(bool using_cache) override;

 protected:
  vtkSMColourRangesProxy() = default;
  ~vtkSMColourRangesProxy() override = default;

 private:
  vtkSMColourRangesProxy(const vtkSMColourRangesProxy&) = delete;
  void operator=(const vtkSMColourRangesProxy&) = delete;

  void SetColours(vtkPVXMLElement* hint);
  void SetDisplay(vtkPVXMLElement* hint, vtkSMProxy* representation);
  void ShowAtFirst(vtkObject* manager, unsigned long event, void* registered);
  std::string Summary();

  bool IsObserving = false;
};

#endif
