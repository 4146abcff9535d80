// detect_mirror SHAPE.obj MIRROR.vtp: finds the mirror plane of a shape.
#include <vtkAlgorithmOutput.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkMirrorDetection.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <system_error>

// Whole or not at all: what stood there stays until the new file is complete.
bool write(vtkAlgorithmOutput* data, const std::filesystem::path& file) {
  std::error_code error;
  if (exists(file, error) && !is_regular_file(file, error)) return false;
  std::filesystem::path partial = file;
  partial += ".partial";
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(data);
  writer->SetFileName(partial.c_str());
  if (writer->Write() && writer->GetErrorCode() == 0) {
    rename(partial, file, error);
    if (!error) return true;
  }
  remove(partial, error);
  return false;
}

int main(int argc, char* argv[]) {
  if (argc != 3) {
    std::cerr << "usage: detect_mirror SHAPE.obj MIRROR.vtp" << std::endl;
    return 2;
  }
  vtkNew<vtkOBJReader> reader;
  reader->SetFileName(argv[1]);
  reader->Update();
  if (reader->GetOutput()->GetNumberOfPoints() == 0) {
    std::cerr << argv[1] << ": no points can be read" << std::endl;
    return EXIT_FAILURE;
  }
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputConnection(reader->GetOutputPort());
  detection->SetMethod("plane");
  detection->Update();
  vtkDataArray* normal =
      detection->GetOutput(vtkMirrorDetection::MIRROR)->GetFieldData()->GetArray("Normal");
  if (!normal) {  // an error of the filter, which VTK has said, or a shape without a plane
    std::cerr << argv[1] << ": no mirror plane" << std::endl;
    return EXIT_FAILURE;
  }
  if (!write(detection->GetOutputPort(vtkMirrorDetection::MIRROR), argv[2])) {
    std::cerr << argv[2] << ": the file cannot be written" << std::endl;
    return EXIT_FAILURE;
  }
  const double* n = normal->GetTuple3(0);
  std::cout << "Normal " << n[0] << " " << n[1] << " " << n[2] << std::endl;
}
