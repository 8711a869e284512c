#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Standard_Failure.hxx>
#include <exception>
#include <string>

#include "api/cad/answer.hpp"
#include "api/cad/parts.hpp"

namespace symcell::cad {
namespace {

void refuse(Status status, const std::string& text, Answer& answer) {
  answer.put(status);
  answer.put_text(text);
}

std::string said_by(const Standard_Failure& failure) {
  const char* text = failure.GetMessageString();
  const std::string type = failure.DynamicType()->Name();
  return text != nullptr && *text != '\0' ? type + ": " + text : type;
}

void answer_request(const Request& request, Answer& answer) {
  // Nothing has been written before the tessellation is done, so that a refusal comes first.
  try {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
    const FileShapes shapes =
        request.kind == FileKind::kStep ? read_step(request) : read_iges(request);
    const Bodies bodies = make_bodies(shapes);
    write_tessellation(bodies, shapes.unit, request, answer);
  } catch (const Refusal& refusal) {
    refuse(refusal.status, refusal.text, answer);
  } catch (const Standard_Failure& failure) {
    refuse(Status::kSyntax, "OpenCASCADE gives it up (" + said_by(failure) + ")", answer);
  }
}

}  // namespace
}  // namespace symcell::cad

extern "C" __attribute__((visibility("default"))) bool symcell_read_cad(
    const symcell::cad::Request* request, symcell::cad::Write write, void* sink) {
  if (request->version != symcell::cad::kModuleVersion) return false;
  symcell::cad::Answer answer(write, sink);
  symcell::cad::answer_request(*request, answer);
  return answer.good();
}
