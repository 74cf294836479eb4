/// Complaints of VTK, which it prints instead of throwing. Included by io/vtk/*.cpp alone: it names VTK.
#pragma once

#include <string>

#include <vtkLogger.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

namespace aeroloom::io {

/// While it lives, VTK prints nothing in this process; the first error is kept.
class VtkComplaints {
public:
  VtkComplaints();
  ~VtkComplaints();
  VtkComplaints(const VtkComplaints&) = delete;
  VtkComplaints& operator=(const VtkComplaints&) = delete;

  bool any() const { return !first().empty(); }
  /// On one line, without the place in VTK's source; empty where there was none.
  std::string first() const;

private:
  vtkSmartPointer<vtkOutputWindow> _before, _here;
  vtkLogger::Verbosity _verbosity;
};

}  // namespace aeroloom::io
