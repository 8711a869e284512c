// A model's picture as an answer: binary glTF of its surface, with what was found or is wrong.
#pragma once

#include <filesystem>

#include "api/formats/model_format.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell::server {

struct Call;
struct ServiceContext;

inline constexpr std::size_t kMaxInspectBytes = 64UL << 20;
inline constexpr double kMaxInspectSeconds = 30;

// Whether the client would rather have a picture than a JSON document.
[[nodiscard]] bool wants_picture(const Call& call);

// Answers the call. Takes a place among the inspections, as the work is that of one.
void respond_picture(Call& call,
                     ServiceContext& context,
                     const std::filesystem::path& model,
                     ModelFormat format,
                     MeshOptions options);

}  // namespace symcell::server
