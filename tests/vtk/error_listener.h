#pragma once

#include <string>

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"

/// Collects what a filter and its executive report as errors, or warnings, for as long as it lives.
class ErrorListener {
 public:
  explicit ErrorListener(vtkAlgorithm* algorithm, unsigned long event = vtkCommand::ErrorEvent)
      : algorithm_(algorithm) {
    command_->SetClientData(&message_);
    command_->SetCallback([](vtkObject*, unsigned long, void* message, void* text) {
      static_cast<std::string*>(message)->append(static_cast<const char*>(text));
    });
    algorithm_->AddObserver(event, command_);
    algorithm_->GetExecutive()->AddObserver(event, command_);
  }
  ~ErrorListener() {
    algorithm_->RemoveObserver(command_);
    algorithm_->GetExecutive()->RemoveObserver(command_);
  }
  ErrorListener(const ErrorListener&) = delete;
  ErrorListener& operator=(const ErrorListener&) = delete;

  const std::string& message() const { return message_; }

 private:
  vtkAlgorithm* algorithm_;
  vtkNew<vtkCallbackCommand> command_;
  std::string message_;
};
