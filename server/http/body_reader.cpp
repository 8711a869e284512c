#include "server/http/body_reader.hpp"

#include <system_error>

#include "server/http/call.hpp"
#include "server/http/gzip.hpp"
#include "server/http/header_values.hpp"
#include "server/http/inflating_file.hpp"
#include "server/http/problem_response.hpp"

namespace symcell::server {
namespace {

constexpr std::size_t kMaxOptionsBytes = 64UL * 1024;
// Up to here a body is held in memory; the lobby may have held as much of it already.
constexpr std::size_t kHeldBytes = 64UL * 1024;

enum class Coding { kIdentity, kGzip, kUnknown };

Coding coding_of(const Exchange& exchange) {
  const std::string coding = media_type_of(exchange.content_encoding);
  if (coding.empty() || coding == "identity") return Coding::kIdentity;
  if (coding == "gzip" || coding == "x-gzip") return Coding::kGzip;
  return Coding::kUnknown;
}

void refuse_size(Call& call, std::size_t max_bytes) {
  respond_problem(
      call, ServiceProblem::kBodyTooLarge,
      "the body may have " + std::to_string(max_bytes) + " bytes at most, after decompression too");
}

// True if the declared length is acceptable; chunked bodies declare none.
bool check_declared_length(Call& call, std::size_t max_bytes) {
  if (call.exchange.declared_bytes <= max_bytes) return true;
  refuse_size(call, max_bytes);
  return false;
}

bool check_transfer_encoding(Call& call) {
  const std::string coding = media_type_of(call.header("Transfer-Encoding"));
  if (coding.empty() || coding == "chunked") return true;
  respond_problem(call, ServiceProblem::kNotImplemented,
                  "no transfer coding but chunked is supported");
  return false;
}

// httplib sets a status of its own when reading stops; ours replaces it.
void refuse_broken(Call& call, const char* detail) {
  respond_problem(call, ServiceProblem::kBadRequest, detail);
}

void refuse_file(Call& call, InflatingFile::Fault fault, std::size_t max_bytes) {
  if (fault == InflatingFile::Fault::kRefused) return;  // whoever gave the guard tells
  if (fault == InflatingFile::Fault::kTooLarge) {
    refuse_size(call, max_bytes);
  } else if (fault == InflatingFile::Fault::kTooDense) {
    respond_problem(call, ServiceProblem::kBodyTooLarge,
                    "the model is more than 20 times as large as what was sent of it; send it "
                    "without compression");
  } else {
    refuse_broken(call, "the model is a gzip file that is damaged or cut off");
  }
}

}  // namespace

void ArrivedFile::remove() noexcept {
  if (path_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

namespace {

// False: the call is answered.
bool receive_into(Call& call, InflatingFile& file, std::size_t max_bytes) {
  const Coding coding = coding_of(call.exchange);
  if (coding == Coding::kUnknown) {
    respond_problem(call, ServiceProblem::kUnsupportedMediaType,
                    "the body's Content-Encoding must be gzip or none");
    return false;
  }
  if (!check_transfer_encoding(call) || !check_declared_length(call, max_bytes)) {
    return false;
  }
  GzipInflater inflater([&](std::string_view piece) { return file.add(piece); });
  bool inflates = true;
  // Without an announced body httplib would read until the connection ends.
  const bool read =
      !call.exchange.body_expected || (*call.body)([&](const char* data, std::size_t size) {
        if (coding == Coding::kIdentity) return file.add({data, size});
        file.came(size);
        inflates = inflater.write({data, size});
        return inflates;
      });
  if (file.fault() != InflatingFile::Fault::kNone) {
    refuse_file(call, file.fault(), max_bytes);
    return false;
  }
  if (!inflates) {
    refuse_broken(call, "the body is not valid gzip, though Content-Encoding says so");
    return false;
  }
  if (!read) {
    refuse_broken(call, "the body ended early, came too slowly, or is wrongly chunked");
    return false;
  }
  call.exchange.body_consumed = true;
  if (coding == Coding::kGzip && call.exchange.body_expected && !inflater.complete()) {
    refuse_broken(call, "the gzip stream in the body is cut off");
    return false;
  }
  if (!file.finish()) {
    refuse_file(call, file.fault(), max_bytes);
    return false;
  }
  return true;
}

}  // namespace

std::optional<ArrivedFile> receive_body(Call& call,
                                        const std::filesystem::path& destination,
                                        std::size_t max_bytes) {
  InflatingFile file(destination, max_bytes);
  if (!receive_into(call, file, max_bytes)) return std::nullopt;
  return ArrivedFile(destination);
}

std::optional<ArrivedBytes> receive_bytes(Call& call,
                                          const std::filesystem::path& destination,
                                          std::size_t max_bytes) {
  InflatingFile file(destination, max_bytes, kHeldBytes);
  JsonGuard guard;
  file.guard_by(guard);
  if (!receive_into(call, file, max_bytes)) {
    if (file.fault() == InflatingFile::Fault::kRefused) respond_error(call, guard.error(), "");
    return std::nullopt;
  }
  if (file.is_held()) return ArrivedBytes(std::move(file.held()));
  return ArrivedBytes(ArrivedFile(destination));
}

bool receive_nothing(Call& call) {
  if (!call.exchange.body_expected) return true;
  refuse_broken(call, "this call takes no body");
  return false;
}

namespace {

// The parts of a form as they arrive.
class FormCollector {
 public:
  FormCollector(const std::filesystem::path& destination, std::size_t max_bytes)
      : file(destination, max_bytes) {}

  bool begin_part(const httplib::MultipartFormData& part) {
    part_ = part.name == "model"     ? Part::kModel
            : part.name == "options" ? Part::kOptions
                                     : Part::kUnknown;
    if (part_ == Part::kUnknown)
      return refuse("the form has an unknown part \"" + part.name +
                    "\"; there are model and options");
    bool& seen = part_ == Part::kModel ? has_model : has_options;
    if (seen) return refuse("the form has the part \"" + part.name + "\" twice");
    seen = true;
    if (part_ == Part::kModel) {
      model_name = part.filename;
      model_media_type = part.content_type;
    }
    return true;
  }

  bool add(std::string_view piece) {
    if (part_ == Part::kModel) {
      return file.add(piece);
    }
    if (options.size() + piece.size() > kMaxOptionsBytes) {
      return refuse("the form's options are longer than any options can be");
    }
    options.append(piece);
    return true;
  }

  InflatingFile file;
  bool has_model = false;
  bool has_options = false;
  std::string fault;
  std::string model_name;
  std::string model_media_type;
  std::string options;

 private:
  enum class Part { kModel, kOptions, kUnknown };

  bool refuse(std::string what) {
    fault = std::move(what);
    return false;
  }

  Part part_ = Part::kUnknown;
};

}  // namespace

std::optional<ArrivedForm> receive_form(Call& call,
                                        const std::filesystem::path& destination,
                                        std::size_t max_bytes) {
  if (coding_of(call.exchange) != Coding::kIdentity) {
    respond_problem(call, ServiceProblem::kUnsupportedMediaType,
                    "a form must not be compressed; send the model itself with gzip");
    return std::nullopt;
  }
  // Boundaries, part headers and options come on top of the model.
  constexpr std::size_t kFormOverhead = 2 * kMaxOptionsBytes;
  if (!check_transfer_encoding(call) || !check_declared_length(call, max_bytes + kFormOverhead)) {
    return std::nullopt;
  }
  FormCollector form(destination, max_bytes);
  const bool read =
      call.exchange.body_expected &&
      (*call.body)([&](const httplib::MultipartFormData& part) { return form.begin_part(part); },
                   [&](const char* data, std::size_t size) {
                     return form.add({data, size});
                   });
  if (form.file.fault() != InflatingFile::Fault::kNone) {
    refuse_file(call, form.file.fault(), max_bytes);
    return std::nullopt;
  }
  if (!form.fault.empty() || !read) {
    const char* detail = "the form is malformed or ended early";
    refuse_broken(call, form.fault.empty() ? detail : form.fault.c_str());
    return std::nullopt;
  }
  call.exchange.body_consumed = true;
  if (!form.has_model) {
    respond_error(call, Error{ErrorCode::kMissingField, "the form has no part \"model\"", {}, ""},
                  "/model");
    return std::nullopt;
  }
  if (!form.file.finish()) {
    refuse_file(call, form.file.fault(), max_bytes);
    return std::nullopt;
  }
  ArrivedForm arrived{ArrivedFile(destination), form.model_name, form.model_media_type, {}};
  if (form.has_options) arrived.options = std::move(form.options);
  return arrived;
}

}  // namespace symcell::server
