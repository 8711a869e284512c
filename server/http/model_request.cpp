#include "server/http/model_request.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "api/formats/model_format.hpp"
#include "api/schema/options.hpp"
#include "server/base/files.hpp"
#include "server/http/call.hpp"
#include "server/http/header_values.hpp"
#include "server/http/json_envelope.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

enum class BodyForm { kEnvelope, kForm, kRaw, kUnsupported };

// What a body is taken for. curl's --data-binary says form-urlencoded unless told otherwise, and
// plain clients say nothing at all: both mean the raw model.
BodyForm body_form_of(const std::string& media_type) {
  if (media_type == "application/json") return BodyForm::kEnvelope;
  if (media_type == "multipart/form-data") return BodyForm::kForm;
  constexpr std::array<std::string_view, 7> kRaw{"",
                                                 "text/plain",
                                                 "application/octet-stream",
                                                 "application/x-www-form-urlencoded",
                                                 "application/sla",
                                                 "application/vnd.ms-pki.stl",
                                                 "application/x-poly"};
  if (std::ranges::find(kRaw, media_type) != kRaw.end() || media_type.starts_with("model/") ||
      model_format_from_media_type(media_type)) {
    return BodyForm::kRaw;
  }
  return BodyForm::kUnsupported;
}

Result<MeshOptions> parse_options_text(std::string_view text) {
  // Options are small and flat; nothing needs to be deeper than a list of coordinates.
  constexpr int kMaxDepth = 4;
  bool too_deep = false;
  std::set<std::string> seen;
  std::string repeated;  // the first name that comes again; the parser would keep its last value
  const auto callback = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
    too_deep = too_deep || depth > kMaxDepth;
    if (depth == 1 && event == nlohmann::json::parse_event_t::key) {
      const auto& name = value.get_ref<const std::string&>();
      if (!seen.insert(name).second && repeated.empty()) repeated = name;
    }
    return !too_deep;
  };
  const auto json = nlohmann::json::parse(text, callback, false);
  if (too_deep) return fail(ErrorCode::kBadOption, "the options are nested", {}, "/options");
  if (json.is_discarded()) {
    return fail(ErrorCode::kJsonSyntax, "the options are not well-formed JSON", {}, "/options");
  }
  if (!json.is_object()) {
    return fail(ErrorCode::kWrongType, "the options must be a JSON object", {}, "/options");
  }
  auto options = options_from_json(json);
  // Names that there are not have been refused.
  if (options && !repeated.empty()) {
    return fail(ErrorCode::kBadOption, repeated + " is given twice; give it once", {},
                "/options/" + repeated);
  }
  return options;
}

// "options[max_area]", as clients write an object in a query (style deepObject), is max_area.
std::string option_name(const std::string& parameter) {
  constexpr std::string_view kObject = "options[";
  if (!parameter.starts_with(kObject) || !parameter.ends_with(']')) return parameter;
  return parameter.substr(kObject.size(), parameter.size() - kObject.size() - 1);
}

// From the document, if it has options, else from the query; both at once would leave open which
// one wins.
Result<MeshOptions> parse_options(const Call& call, std::optional<std::string_view> document) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& [name, text] : call.query) {
    texts.emplace_back(option_name(name), text);
  }
  if (!document) return options_from_texts(texts);
  if (!texts.empty()) {
    return fail(ErrorCode::kBadOption,
                "options are given in the body and in the query; use one place", {}, "/options");
  }
  return parse_options_text(*document);
}

std::string safe_name(const std::string& file_name) {
  std::string name = file_name.substr(file_name.find_last_of("/\\") + 1);
  std::erase_if(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  return name.substr(0, 200);
}

// Everything the three forms have in common once model and options are apart.
struct Parts {
  ArrivedFile model;
  std::optional<ModelFormat> format;
  std::string name;
  std::optional<std::string> options;  // JSON text
  std::string pointer_prefix;
};

std::optional<ModelRequest> parse_parts(Call& call, ServiceContext& context, Parts parts) {
  const auto options = parse_options(call, parts.options);
  if (!options) {
    respond_error(call, options.error(), "");
    return std::nullopt;
  }
  ExecutionContext execution;
  const auto format = context.jobs.engine().recognise(parts.model.path(), parts.format, execution);
  if (!format) {
    respond_error(call, format.error(), parts.pointer_prefix);
    return std::nullopt;
  }
  const auto fitting = options_for(model_format_info(*format).kind, *options);
  if (!fitting) {
    respond_error(call, fitting.error(), "");
    return std::nullopt;
  }
  return ModelRequest{std::move(parts.model), *format, safe_name(parts.name), *fitting};
}

std::optional<Parts> receive_envelope(Call& call, const JobFiles& files, std::size_t max_bytes) {
  auto body = receive_bytes(call, files.incoming(), max_bytes);
  if (!body) return std::nullopt;
  const auto envelope = split_envelope(body->bytes());
  if (!envelope) {
    respond_error(call, envelope.error(), "");
    return std::nullopt;
  }
  if (envelope->bare && body->file()) {
    return Parts{std::move(*body->file()), ModelFormat::kPslgJson, {}, std::nullopt, ""};
  }
  const auto destination = files.incoming();
  FileWriter model(destination);
  model.write(envelope->model);
  model.keep();
  if (envelope->bare) {
    return Parts{ArrivedFile(destination), ModelFormat::kPslgJson, {}, std::nullopt, ""};
  }
  std::optional<std::string> options;
  if (!envelope->options.empty()) options = std::string(envelope->options);
  return Parts{ArrivedFile(destination), ModelFormat::kPslgJson, {}, std::move(options), "/model"};
}

std::optional<Parts> receive_parts_of_form(Call& call,
                                           const JobFiles& files,
                                           std::size_t max_bytes) {
  auto form = receive_form(call, files.incoming(), max_bytes);
  if (!form) return std::nullopt;
  auto format = model_format_from_name(form->model_name);
  if (!format) format = model_format_from_media_type(media_type_of(form->model_media_type));
  return Parts{std::move(form->model), format, std::move(form->model_name),
               std::move(form->options), "/model"};
}

std::optional<Parts> receive_raw(Call& call,
                                 const JobFiles& files,
                                 std::size_t max_bytes,
                                 const std::string& media_type) {
  auto body = receive_body(call, files.incoming(), max_bytes);
  if (!body) return std::nullopt;
  // text/plain may be anything: leave it to the content.
  const auto format =
      media_type == "text/plain" ? std::nullopt : model_format_from_media_type(media_type);
  return Parts{std::move(*body), format, {}, std::nullopt, ""};
}

}  // namespace

std::optional<ModelRequest> receive_model_request(Call& call,
                                                  ServiceContext& context,
                                                  std::size_t max_body_bytes) {
  const JobFiles& files = context.jobs.files();
  const std::string media_type = media_type_of(call.header("Content-Type"));
  std::optional<Parts> parts;
  switch (body_form_of(media_type)) {
    case BodyForm::kEnvelope: parts = receive_envelope(call, files, max_body_bytes); break;
    case BodyForm::kForm: parts = receive_parts_of_form(call, files, max_body_bytes); break;
    case BodyForm::kRaw: parts = receive_raw(call, files, max_body_bytes, media_type); break;
    case BodyForm::kUnsupported:
      call.response.set_header("Accept-Post",
                               "application/json, multipart/form-data, text/plain, model/*, "
                               "application/octet-stream");
      respond_problem(call, ServiceProblem::kUnsupportedMediaType,
                      "a model comes as application/json, multipart/form-data, text/plain, "
                      "application/octet-stream or model/*, not as " +
                          media_type);
      return std::nullopt;
  }
  if (!parts) return std::nullopt;
  return parse_parts(call, context, std::move(*parts));
}

}  // namespace symcell::server
