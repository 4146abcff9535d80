/**
 * @class vtkPointDamage
 * @brief Damages a point set: noise, holes, rotation, uneven density.
 *
 * The output is the input with its points moved or some of them left out, together with the cells
 * that need those. Normals are not passed on.
 */
#ifndef vtkPointDamage_h
#define vtkPointDamage_h

#include "vtkPointDamageParameters.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class VTKSYMSURFFILTERS_EXPORT vtkPointDamage : public vtkPointDamageParameters {
 public:
  static vtkPointDamage* New();
  vtkTypeMacro(vtkPointDamage, vtkPointDamageParameters);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The same seed gives the same damage on every machine.
   */
  vtkSetMacro(Seed, unsigned int);
  vtkGetMacro(Seed, unsigned int);
  ///@}

 protected:
  vtkPointDamage() = default;
  ~vtkPointDamage() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  unsigned int Seed = 0;

 private:
  vtkPointDamage(const vtkPointDamage&) = delete;
  void operator=(const vtkPointDamage&) = delete;
};

#endif
