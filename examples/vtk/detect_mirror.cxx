// detect_mirror SHAPE.obj MIRROR.vtp: finds the mirror plane of a shape.
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkMirrorDetection.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

int main(int, char* argv[]) {
  vtkNew<vtkOBJReader> reader;
  reader->SetFileName(argv[1]);
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputConnection(reader->GetOutputPort());
  detection->SetMethod("plane");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(detection->GetOutputPort(vtkMirrorDetection::MIRROR));
  writer->SetFileName(argv[2]);
  if (!writer->Write()) return EXIT_FAILURE;
  const double* normal = detection->GetOutput()->GetFieldData()->GetArray("Normal")->GetTuple3(0);
  std::cout << "Normal " << normal[0] << " " << normal[1] << " " << normal[2] << std::endl;
}
