/**
 * @class vtkSharedShapeAlgorithm
 * @brief A filter whose shape may be shared out among processes, and which uses several threads.
 *
 * What a process cannot use of its part is an error of all, in the same words.
 */
#ifndef vtkSharedShapeAlgorithm_h
#define vtkSharedShapeAlgorithm_h

#include "vtkShapeAlgorithm.h"
#include "vtkSymsurfFiltersModule.h"  // for the export macro

class vtkMultiProcessController;

class VTKSYMSURFFILTERS_EXPORT vtkSharedShapeAlgorithm : public vtkShapeAlgorithm {
 public:
  vtkTypeMacro(vtkSharedShapeAlgorithm, vtkShapeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Threads to use; 0: as many as the machine has. The results are the same for any number.
   */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The processes that share out the input; null, or one process: all of it is here. Initially the
   * global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

 protected:
  vtkSharedShapeAlgorithm();
  ~vtkSharedShapeAlgorithm() override;

  int NumberOfThreads = 0;
  vtkMultiProcessController* Controller = nullptr;

 private:
  vtkSharedShapeAlgorithm(const vtkSharedShapeAlgorithm&) = delete;
  void operator=(const vtkSharedShapeAlgorithm&) = delete;
};

#endif
