#include "cad/model/occ_guard.hpp"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {

void silence_cad_library() {
  static const bool silenced = [] {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
    return true;
  }();
  static_cast<void>(silenced);
}

void throw_cad_error(const std::string& doing, const Standard_Failure& failure) {
  const char* text = failure.GetMessageString();
  throw CadError(fmt::format("{}: the CAD library failed with {}{}{}", doing, failure.DynamicType()->Name(),
                             text && *text ? ": " : "", text ? text : ""));
}

}  // namespace aeroloom::cad
