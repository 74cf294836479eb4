/// Catches the errors that VTK prints instead of throwing. Only io/vtk/*.cpp include this header.
#pragma once

#include <string>

#include <vtkLogger.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace aeroloom::io {

/// While an object exists, VTK prints nothing in this process, and the first error is kept.
class VtkErrors {
public:
  VtkErrors();
  ~VtkErrors();
  VtkErrors(const VtkErrors&) = delete;
  VtkErrors& operator=(const VtkErrors&) = delete;

  bool any() const { return !first().empty(); }
  /// The first error on one line, without the place in VTK's source; empty if there was none.
  std::string first() const;

private:
  vtkSmartPointer<vtkOutputWindow> _before, _here;
  vtkLogger::Verbosity _verbosity;
};

}  // namespace aeroloom::io
