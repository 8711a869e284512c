// A model with options as any of the accepted request forms brings it: JSON, form, or raw body.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "api/formats/model_format.hpp"
#include "core/model/mesh_options.hpp"
#include "server/http/body_reader.hpp"

namespace symcell::server {

struct Call;
struct ServiceContext;

struct ModelRequest {
  ArrivedFile model;
  ModelFormat format = ModelFormat::kPslgJson;
  std::string model_name;  // of the uploaded file, may be empty
  MeshOptions options;
};

// Reads the body and parses model and options, so that whatever is malformed is reported at once.
// Answers the call itself and returns nullopt where the request is not acceptable.
[[nodiscard]] std::optional<ModelRequest> receive_model_request(Call& call,
                                                                ServiceContext& context,
                                                                std::size_t max_body_bytes);

}  // namespace symcell::server
