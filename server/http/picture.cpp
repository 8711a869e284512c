#include "server/http/picture.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include "server/base/files.hpp"
#include "server/http/body_reader.hpp"
#include "server/http/call.hpp"
#include "server/http/header_values.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

constexpr const char* kMediaType = "model/gltf-binary";

}  // namespace

bool wants_picture(const Call& call) {
  const std::string accept = call.header("Accept");
  return accept.find(kMediaType) != std::string::npos && accepts_media_type(accept, kMediaType);
}

void respond_picture(Call& call,
                     ServiceContext& context,
                     const std::filesystem::path& model,
                     ModelFormat format,
                     MeshOptions options) {
  const Slots::Slot place = context.inspections.try_take();
  if (!place) {
    respond_problem(call, ServiceProblem::kTooManyStreams,
                    "too many inspections at once; try again shortly");
    return;
  }
  ExecutionContext execution;
  options.time_limit_s = std::min(kMaxInspectSeconds, options.time_limit_s);
  execution.set_time_limit(options.time_limit_s);
  // Gone when the answer is sent: the file stays open until then.
  const ArrivedFile picture(context.jobs.files().incoming());
  const auto drawn = context.jobs.engine().draw(model, format, options, picture.path(), execution);
  if (!drawn) {
    respond_error(call, drawn.error(), "/model");
    return;
  }
  call.response.set_header("Cache-Control", "no-store");
  const auto file = std::make_shared<FileReader>(picture.path(), Links::kRefuse);
  call.response.set_content_provider(std::filesystem::file_size(picture.path()), kMediaType,
                                     [file](std::size_t, std::size_t, httplib::DataSink& sink) {
                                       const std::string_view piece = file->next();
                                       return !piece.empty() &&
                                              sink.write(piece.data(), piece.size());
                                     });
}

}  // namespace symcell::server
