// GET /v1/jobs/{id}/cell, /full, /statistics, /model: streamed, never whole in memory.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "api/formats/mesh_writer.hpp"
#include "api/schema/options.hpp"
#include "api/version.hpp"
#include "server/base/files.hpp"
#include "server/base/identifiers.hpp"
#include "server/http/call.hpp"
#include "server/http/gzip.hpp"
#include "server/http/header_values.hpp"
#include "server/http/picture.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"
#include "server/jobs/stored_files.hpp"

namespace symcell::server {
namespace {

// Writers come in small pieces; each chunk on the wire costs a system call.
constexpr std::size_t kChunkBytes = 64UL * 1024;

// Produces a body: writes pieces to the sink until done; false: failed or the sink stopped.
using Producer = std::function<bool(const PieceSink&)>;

// What is about to be sent.
struct Representation {
  std::string media_type;
  std::string file_name;
  std::string etag_base;  // identifies the bytes before compression
  Producer produce;
  bool ranged = false;  // the bytes are always the same, and quick to make once more
  std::optional<std::uint64_t> bytes = {};  // if known already
};

class ChunkBuffer {
 public:
  explicit ChunkBuffer(PieceSink sink) : sink_(std::move(sink)) { buffer_.reserve(kChunkBytes); }

  bool write(std::string_view piece) {
    if (buffer_.size() + piece.size() > kChunkBytes && !flush()) return false;
    if (piece.size() >= kChunkBytes) return sink_(piece);
    buffer_.append(piece);
    return true;
  }

  bool flush() {
    if (buffer_.empty()) return true;
    const bool taken = sink_(buffer_);
    buffer_.clear();
    return taken;
  }

 private:
  PieceSink sink_;
  std::string buffer_;
};

// Runs the producer against the client's pace: the sink's write waits while the socket is full.
bool send(const Producer& produce, bool gzip, httplib::DataSink& data) {
  ChunkBuffer chunks(
      [&](std::string_view piece) { return data.write(piece.data(), piece.size()); });
  bool sent = false;
  if (gzip) {
    GzipDeflater deflater([&](std::string_view piece) { return chunks.write(piece); });
    sent =
        produce([&](std::string_view piece) { return deflater.write(piece); }) && deflater.finish();
  } else {
    sent = produce([&](std::string_view piece) { return chunks.write(piece); });
  }
  if (!sent || !chunks.flush()) return false;
  // Of a body whose length is known the end needs no word.
  if (data.done) data.done();
  return true;
}

std::uint64_t count_bytes(const Producer& produce) {
  std::uint64_t bytes = 0;
  static_cast<void>(produce([&](std::string_view piece) {
    bytes += piece.size();
    return true;
  }));
  return bytes;
}

// Passes on what lies within the range, and ends the producer behind it.
Producer cut_out(Producer produce, ByteRange range) {
  return [produce = std::move(produce), range](const PieceSink& sink) {
    std::uint64_t at = 0;
    bool taken = true;
    const bool made = produce([&](std::string_view piece) {
      const std::uint64_t begin = at;
      at += piece.size();
      if (at <= range.first) return true;
      const std::uint64_t skip = range.first > begin ? range.first - begin : 0;
      const std::uint64_t end = std::min(at, range.last + 1);
      taken = sink(piece.substr(skip, end - begin - skip));
      return taken && at <= range.last;
    });
    return taken && (made || at > range.last);
  };
}

// With its length, and in part if the request asks for a part.
void respond_ranged(Call& call, Representation& representation, const std::string& etag) {
  const std::uint64_t bytes =
      representation.bytes ? *representation.bytes : count_bytes(representation.produce);
  call.response.headers.erase("Accept-Ranges");
  call.response.set_header("Accept-Ranges", "bytes");
  const std::string if_range = call.header("If-Range");
  const auto range = if_range.empty() || if_range == etag
                         ? parse_byte_range(call.exchange.range, bytes)
                         : RangeRequest{};
  if (range.unsatisfiable) {
    call.response.set_header("Content-Range", "bytes */" + std::to_string(bytes));
    respond_problem(call, ServiceProblem::kRangeNotSatisfiable,
                    "there are " + std::to_string(bytes) + " bytes");
    return;
  }
  std::uint64_t length = bytes;
  Producer produce = std::move(representation.produce);
  if (range.range) {
    const ByteRange sent = *range.range;
    length = sent.last - sent.first + 1;
    call.response.status = 206;
    call.response.set_header("Content-Range", "bytes " + std::to_string(sent.first) + "-" +
                                                  std::to_string(sent.last) + "/" +
                                                  std::to_string(bytes));
    produce = cut_out(std::move(produce), sent);
  }
  if (length == 0) {
    call.response.set_content("", representation.media_type.c_str());
    return;
  }
  call.response.set_content_provider(
      length, representation.media_type,
      [produce = std::move(produce)](std::size_t, std::size_t, httplib::DataSink& data) {
        return send(produce, false, data);
      });
}

void respond_representation(Call& call, Representation representation) {
  // A part of what is compressed is of no use to anybody.
  const bool part = representation.ranged && !call.exchange.range.empty();
  const bool gzip = !part && accepts_gzip(call.exchange.accept_encoding);
  const std::string etag = "\"" + representation.etag_base + (gzip ? "-gzip\"" : "\"");
  call.response.set_header("ETag", etag);
  call.response.set_header("Vary", "Accept, Accept-Encoding");
  call.response.set_header("Cache-Control", "private, no-cache");
  if (etag_matches(call.header("If-None-Match"), etag)) {
    call.response.status = 304;
    return;
  }
  if (gzip) call.response.set_header("Content-Encoding", "gzip");
  call.response.set_header("Content-Disposition",
                           "attachment; filename=\"" + representation.file_name + "\"");
  if (representation.ranged && !gzip) return respond_ranged(call, representation, etag);
  const auto provider = [produce = std::move(representation.produce), gzip](
                            std::size_t, httplib::DataSink& data) {
    return send(produce, gzip, data);
  };
  if (call.request.version == "HTTP/1.0") {
    // No chunks there: the end of the connection is the end of the body.
    call.exchange.close = true;
    call.response.set_content_provider(representation.media_type, provider);
  } else {
    call.response.set_chunked_content_provider(representation.media_type, provider);
  }
}

// The succeeded job of the call, or an answer.
std::optional<Job> succeeded_job(Call& call, ServiceContext& context) {
  auto job = context.jobs.find(call.id);
  if (!job) {
    respond_problem(call, ServiceProblem::kNotFound, "there is no such job; it may have expired");
    return std::nullopt;
  }
  if (job->state == JobState::kSucceeded) return job;
  const std::string state(job_state_name(job->state));
  if (is_finished(job->state)) {
    respond_problem(call, ServiceProblem::kNoResult, "the job is " + state + " and has no result");
  } else {
    call.response.set_header("Retry-After", "1");
    respond_problem(call, ServiceProblem::kNotFinished, "the job is " + state + "; see its events");
  }
  return std::nullopt;
}

// By ?format=, else by Accept.
std::optional<MeshFormat> mesh_format_of(Call& call, std::int32_t dimension) {
  if (call.has_parameter("format")) {
    const auto format = mesh_format_from_name(call.parameter("format"));
    if (!format) {
      respond_problem(call, ServiceProblem::kBadRequest, "format is one of " + mesh_format_list());
      return std::nullopt;
    }
    const auto fits = check_mesh_format(*format, dimension);
    if (!fits) {
      respond_problem(call, ServiceProblem::kNotAcceptable, fits.error().message);
      return std::nullopt;
    }
    return format;
  }
  const auto format = mesh_format_from_accept(call.header("Accept"), dimension);
  if (!format) {
    respond_problem(call, ServiceProblem::kNotAcceptable,
                    "meshes come as application/vnd.vtk.vtu+xml, application/json, model/x-gmsh, "
                    "model/gltf-binary, "
                    "planar ones as image/svg+xml, solids as model/stl; or choose by ?format=" +
                        mesh_format_list());
  }
  return format;
}

std::optional<WriteOptions> write_options_of(Call& call) {
  WriteOptions options;
  if (const std::string name = call.parameter("encoding"); !name.empty()) {
    const auto encoding = vtu_encoding_from_name(name);
    if (!encoding) {
      respond_problem(call, ServiceProblem::kBadRequest,
                      "encoding (of vtu and vtp; ascii also of stl) is one of raw, zlib, ascii");
      return std::nullopt;
    }
    options.vtu_encoding = *encoding;
  }
  if (call.has_parameter("packed")) {
    const auto packed = packed_reals_from_name(call.parameter("packed"));
    if (!packed) {
      respond_problem(call, ServiceProblem::kBadRequest,
                      "packed (of json) is one of true, exact, false");
      return std::nullopt;
    }
    options.packed = *packed;
  }
  for (const DeckOptionInfo& info : deck_option_table()) {
    const std::string name(info.name);
    if (!call.has_parameter(name)) continue;
    const auto set = set_deck_option(options.deck, name, call.parameter(name.c_str()));
    if (!set) {
      respond_error(call, set.error(), "");
      return std::nullopt;
    }
  }
  return options;
}

// Tells representations of one format apart: how it is encoded, what a deck holds.
std::string variant_of(Call& call, MeshFormat format) {
  if (format == MeshFormat::kVtu || format == MeshFormat::kVtp || format == MeshFormat::kStl) {
    return call.parameter("encoding");
  }
  if (format == MeshFormat::kJson) return call.parameter("packed");
  std::string texts;
  for (const DeckOptionInfo& info : deck_option_table()) {
    const std::string name(info.name);
    if (call.has_parameter(name)) {
      texts += name + "=" + call.parameter(name.c_str()) + "\n";
    }
  }
  if (texts.empty()) return "";
  Sha256 digest;
  digest.append(texts);
  return "-" + digest.finish();
}

void send_mesh(Call& call, ServiceContext& context, MeshPart part) {
  const auto job = succeeded_job(call, context);
  if (!job) return;
  const auto format = mesh_format_of(call, read_cell_dimension(*job, context.jobs.files()));
  if (!format) return;
  const auto options = write_options_of(call);
  if (!options) return;
  const std::string part_name = part == MeshPart::kCell ? "cell" : "full";
  const std::string format_name(mesh_format_name(*format));
  const bool head = call.request.method == "HEAD";
  std::shared_ptr<const SymmetryCellMesh> cell;
  // Raw binary files cost little more than copying, so that they are made once more to be measured.
  const bool ranged =
      (*format == MeshFormat::kVtu && options->vtu_encoding == VtuEncoding::kAppendedRaw) ||
      (*format == MeshFormat::kStl && options->vtu_encoding != VtuEncoding::kAscii);
  // Read before the answer begins, so that a damaged archive is an error and no broken download.
  if (!head || ranged || takes_deck_options(*format)) {
    cell = std::make_shared<const SymmetryCellMesh>(read_cell(*job, context.jobs.files()));
  }
  const auto fits = cell ? check_mesh_output(*cell, part, *format, *options)
                         : check_write_options(*format, *options);
  if (!fits) {
    respond_error(call, fits.error(), "");
    return;
  }

  Representation mesh;
  mesh.media_type = mesh_format_media_type(*format);
  mesh.file_name = part_name + "." + format_name;
  // The bytes follow from the job, the form and the program's version.
  mesh.etag_base = job->id + "-" + part_name + "-" + format_name + variant_of(call, *format) + "-" +
                   std::string(version());
  mesh.ranged = ranged;
  if (head && !ranged) {
    mesh.produce = [](const PieceSink&) { return true; };
  } else {
    mesh.produce = [cell, part, format = *format, options = *options](const PieceSink& sink) {
      return write_mesh(*cell, part, format, options, sink).has_value();
    };
  }
  respond_representation(call, std::move(mesh));
}

Producer file_producer(const std::filesystem::path& path) {
  // Opened now: the job may be deleted while its file is on its way. Read once: its size is known.
  auto file = std::make_shared<FileReader>(path, Links::kRefuse);
  return [file = std::move(file)](const PieceSink& sink) {
    for (std::string_view piece = file->next(); !piece.empty(); piece = file->next()) {
      if (!sink(piece)) return false;
    }
    return true;
  };
}

bool check_accepts(Call& call, std::string_view media_type) {
  if (accepts_media_type(call.header("Accept"), media_type)) return true;
  respond_problem(call, ServiceProblem::kNotAcceptable,
                  "this comes as " + std::string(media_type) + " only");
  return false;
}

void send_statistics(Call& call, ServiceContext& context) {
  const auto job = succeeded_job(call, context);
  if (!job || !check_accepts(call, "application/json")) return;
  const auto produce = [text = read_statistics(*job, context.jobs.files())](const PieceSink& sink) {
    return sink(text);
  };
  respond_representation(
      call, {"application/json", "statistics.json", job->id + "-statistics", produce, true});
}

void respond_model_gone(Call& call) {
  respond_problem(call, ServiceProblem::kModelGone,
                  "models of jobs without a result are kept for a day");
}

void send_model(Call& call, ServiceContext& context) {
  const auto job = context.jobs.find(call.id);
  if (!job) {
    respond_problem(call, ServiceProblem::kNotFound, "there is no such job; it may have expired");
    return;
  }
  const ModelFormatInfo& format = model_format_info(job->model_format);
  if (!check_accepts(call, format.media_type)) return;
  if (!job->model_kept) return respond_model_gone(call);
  check_model(*job, context.jobs.files());
  std::string media_type(format.media_type);
  if (media_type == "text/plain") media_type += "; charset=utf-8";
  respond_representation(call,
                         {media_type, "model" + std::string(format.ending), job->id + "-model",
                          file_producer(context.jobs.files().model(job->id)), true,
                          static_cast<std::uint64_t>(job->model_bytes)});
}

// The model as a picture, whatever became of the job.
void send_surface(Call& call, ServiceContext& context) {
  const auto job = context.jobs.find(call.id);
  if (!job) {
    respond_problem(call, ServiceProblem::kNotFound, "there is no such job; it may have expired");
    return;
  }
  if (!check_accepts(call, "model/gltf-binary")) return;
  if (!job->model_kept) return respond_model_gone(call);
  if (static_cast<std::size_t>(job->model_bytes) > kMaxInspectBytes) {
    respond_problem(call, ServiceProblem::kBodyTooLarge,
                    "models above 64 MiB are not drawn; fetch the cell or the model");
    return;
  }
  check_model(*job, context.jobs.files());
  const auto options = options_from_json(nlohmann::json::parse(job->options_json));
  respond_picture(call, context, context.jobs.files().model(job->id), job->model_format,
                  options ? *options : MeshOptions{});
}

}  // namespace

void add_result_routes(Router& router, ServiceContext& context) {
  router.add("GET", "/v1/jobs/{id}/cell",
             [&context](Call& call) { send_mesh(call, context, MeshPart::kCell); });
  router.add("GET", "/v1/jobs/{id}/full",
             [&context](Call& call) { send_mesh(call, context, MeshPart::kFull); });
  router.add("GET", "/v1/jobs/{id}/statistics",
             [&context](Call& call) { send_statistics(call, context); });
  router.add("GET", "/v1/jobs/{id}/surface",
             [&context](Call& call) { send_surface(call, context); });
  router.add("GET", "/v1/jobs/{id}/model", [&context](Call& call) { send_model(call, context); });
}

}  // namespace symcell::server
