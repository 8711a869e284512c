#include <sys/mman.h>
#include <unistd.h>

#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <array>
#include <cerrno>

#include "api/cad/names.hpp"
#include "api/cad/parts.hpp"

namespace symcell::cad {
namespace {

// IGES is read from a file by its name only: this one lies in memory.
class MemoryFile {
 public:
  MemoryFile(const char* bytes, std::size_t size)
      : descriptor_(memfd_create("model.igs", MFD_CLOEXEC)) {
    while (descriptor_ >= 0 && size > 0) {
      const ssize_t put = ::write(descriptor_, bytes, size);
      if (put < 0 && errno == EINTR) continue;
      if (put <= 0) break;
      bytes += put;
      size -= static_cast<std::size_t>(put);
    }
  }
  ~MemoryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

// The predefined colours 1 to 8 of the standard.
constexpr std::array<std::int32_t, 9> kColours = {-1,       0x000000, 0xff0000, 0x00ff00, 0x0000ff,
                                                  0xffff00, 0xff00ff, 0x00ffff, 0xffffff};

FaceLabel label_of(const Handle(XSControl_TransferReader) & transfer, const TopoDS_Shape& face) {
  FaceLabel label;
  const auto entity =
      Handle(IGESData_IGESEntity)::DownCast(transfer->EntityFromShapeResult(face, -1));
  if (entity.IsNull()) return label;
  if (entity->HasName() && !entity->NameValue().IsNull()) {
    label.name = plain_name(entity->NameValue()->ToCString());
  }
  const Standard_Integer rank = entity->RankColor();
  if (rank > 0 && rank < static_cast<Standard_Integer>(kColours.size())) {
    label.colour = kColours[static_cast<std::size_t>(rank)];
  }
  return label;
}

}  // namespace

FileShapes read_iges(const Request& request) {
  IGESControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESControl_Reader reader;
  const MemoryFile file(request.bytes, request.size);
  if (reader.ReadFile(file.name().c_str()) != IFSelect_RetDone) {
    throw Refusal{Status::kSyntax, "it is not written as IGES is, or is cut off"};
  }
  FileShapes result;
  const auto model = reader.IGESModel();
  if (!model.IsNull() && !model->GlobalSection().UnitName().IsNull()) {
    result.unit = model->GlobalSection().UnitName()->ToCString();
  }
  reader.TransferRoots();
  result.shape = reader.OneShape();
  if (result.shape.IsNull()) {
    throw Refusal{Status::kNoShape, "it holds no solid and no surface that can be read"};
  }
  const Handle(XSControl_TransferReader) transfer = reader.WS()->TransferReader();
  for (TopExp_Explorer e(result.shape, TopAbs_FACE); e.More(); e.Next()) {
    const TopoDS_Shape face = e.Current().Located(TopLoc_Location());
    if (!result.labels.IsBound(face)) result.labels.Bind(face, label_of(transfer, face));
  }
  drop_name_of_all(result.labels);
  return result;
}

}  // namespace symcell::cad
