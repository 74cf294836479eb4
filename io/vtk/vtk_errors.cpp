#include "io/vtk/vtk_errors.hpp"

#include <algorithm>

#include <vtkObjectFactory.h>

namespace aeroloom::io {

namespace {

class FirstError : public vtkOutputWindow {
public:
  vtkTypeMacro(FirstError, vtkOutputWindow) static FirstError* New();
  void DisplayText(const char*) override {}
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (_text.empty() && text != nullptr) _text = text;
  }
  const std::string& text() const { return _text; }

private:
  std::string _text;
};
vtkStandardNewMacro(FirstError);

}  // namespace

VtkErrors::VtkErrors()
    : _before(vtkOutputWindow::GetInstance()),
      _here(vtkSmartPointer<FirstError>::New()),
      _verbosity(vtkLogger::GetCurrentVerbosityCutoff()) {
  vtkOutputWindow::SetInstance(_here);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
}

VtkErrors::~VtkErrors() {
  vtkOutputWindow::SetInstance(_before);
  vtkLogger::SetStderrVerbosity(_verbosity);
}

std::string VtkErrors::first() const {
  std::string text = static_cast<const FirstError&>(*_here).text();
  const auto place = text.find("): ");
  if (place != std::string::npos) text.erase(0, place + 3);
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  constexpr std::size_t longest = 300;  // characters of a message of ours that quotes it
  return text.size() > longest ? text.substr(0, longest) + " ..." : text;
}

}  // namespace aeroloom::io
